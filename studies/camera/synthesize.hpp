// Simulated beads as a camera would have recorded them: `.a` files and the recording.yaml that goes with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/camera/camera.hpp"
#include "studies/camera/simulated_beads.hpp"

namespace millscope::camera {

struct SynthesisRequest {
  std::filesystem::path file;       ///< what to write: x.a, with several beads x_1.a, x_2.a, …; beside them x.yaml
  std::vector<std::int64_t> beads;  ///< ids; empty: all that the run followed
  std::uint64_t seed = 1;
  std::optional<double> from;  ///< s; default: where the case begins its analysis
  bool overwrite = false;
};

struct Synthesis {
  std::vector<std::filesystem::path> files;
  std::filesystem::path recording;
  std::uint64_t locations = 0;
  double seconds = 0;              ///< of bead's path behind them, all beads together
  std::vector<std::string> notes;  ///< what the user should know
};

/// The files that `synthesize` will write. Throws base::UserError: no such bead.
std::vector<std::filesystem::path> synthesis_targets(const SimulatedBeads& beads, const SynthesisRequest& request);

/// Writes all files or, where one of them exists already, none. Throws base::UserError: no such bead, nothing seen of a bead, a file
/// that exists, a disk that is full.
Synthesis synthesize(const SimulatedBeads& beads, const Camera& camera, const SynthesisRequest& request);

}  // namespace millscope::camera
