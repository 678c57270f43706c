// tracks.h5: chosen beads at 2 kHz or more; a recording of one real bead, once read, lies in the same layout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace millscope::output {

inline constexpr std::uint32_t kTracksSchema = 1;

/// One bead that is followed.
struct TrackInfo {
  std::string name;        ///< of the group, e.g. "bead_42" or a recording's file name
  std::uint32_t bead = 0;  ///< id; 0 in a recording
  double diameter = 0;     ///< m
  double density = 0;      ///< kg/m³
  std::string source;      ///< "simulation", or the recording's file
};

/// Writes tracks.h5 (docs/format.md): one group per track, datasets t [n] and position [n,3]. Same rules as FrameWriter.
class TrackWriter {
 public:
  static TrackWriter create(const std::filesystem::path& path, std::span<const TrackInfo> tracks);
  /// Drops the samples later than `time` (s).
  static TrackWriter resume(const std::filesystem::path& path, std::span<const TrackInfo> tracks, double time);
  ~TrackWriter();
  TrackWriter(TrackWriter&&) noexcept;
  TrackWriter& operator=(TrackWriter&&) noexcept;

  /// One instant of all tracks; position [tracks,3] m. Buffered: at most the last 1024 samples are lost by kill -9.
  void append(double time, std::span<const double> position);
  /// One sample of one track, for recordings whose beads have their own times; position [3] m.
  void append_one(std::size_t track, double time, std::span<const double, 3> position);
  void flush();
  void close();

 private:
  struct Impl;
  explicit TrackWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace millscope::output
