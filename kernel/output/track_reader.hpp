// Reads tracks.h5 (docs/format.md), also of a run that is still going on or was killed.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <vector>

#include "kernel/output/tracks.hpp"

namespace millscope::output {

/// The samples of one track.
struct TrackSamples {
  std::vector<double> time;                     ///< s, increasing
  std::array<std::vector<double>, 3> position;  ///< m
  std::size_t size() const { return time.size(); }
};

/// Throws base::UserError when the file is missing, of another kind or schema version, damaged, or has no track.
class TrackReader {
 public:
  explicit TrackReader(std::filesystem::path path);
  ~TrackReader();
  TrackReader(TrackReader&&) noexcept;
  TrackReader& operator=(TrackReader&&) noexcept;

  const std::filesystem::path& path() const;
  /// Ordered by bead, then name.
  const std::vector<TrackInfo>& tracks() const;
  /// Samples of track i; those that `t` lists, which are complete.
  std::size_t sample_count(std::size_t track) const;
  TrackSamples read(std::size_t track) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A coordinate along a periodic axis (m), continued: jumps of more than half the period become steps into the next image.
void unwrap(std::vector<double>& coordinate, double period);

/// Whether the file says that it is a tracks.h5; false also for what is no HDF5 file.
bool is_track_file(const std::filesystem::path& path);

}  // namespace millscope::output
