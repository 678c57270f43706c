// The beads that a simulation followed, with what a camera and a recording need to know of its mill.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kernel/host/registry.hpp"
#include "kernel/output/track_reader.hpp"
#include "millscope/observation.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::camera {

/// The directory of a run with tracks.h5.
class SimulatedBeads {
 public:
  /// Throws base::UserError when the directory is no run, or has no tracks.
  SimulatedBeads(std::filesystem::path run, const host::Registry& registry);

  const std::filesystem::path& directory() const { return run_; }
  const std::vector<output::TrackInfo>& tracks() const { return reader_.tracks(); }
  double analyze_from() const { return analyze_from_; }  ///< s: the charge is steady from here on, says the case
  /// As a recording of this very mill would say it; power by the centre of mass, from summary.json where the run has come to its end.
  const recording::Condition& condition() const { return condition_; }

  /// Path of track i from time `from` on; across a periodic boundary it goes on into the next image.
  output::TrackSamples path(std::size_t i, double from) const;
  /// What the camera may know, with the seed of that bead.
  TrackContext context(std::size_t i, std::uint64_t seed) const;

 private:
  std::filesystem::path run_;
  output::TrackReader reader_;
  recording::Condition condition_;
  TrackContext context_{};
  double analyze_from_ = 0, period_ = 0;
};

}  // namespace millscope::camera
