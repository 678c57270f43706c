// The recording that a user would have made of a truth; for the files of this room.
#pragma once

#include <filesystem>
#include <string>

#include "studies/camera/camera.hpp"
#include "studies/challenge/plan.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::challenge {

/// What the user believes of a condition: the base case with the nuisances at their prior means, those apart as they are in the case. It
/// names no case file.
recording::Condition believed(const diagnose::Question& question, std::size_t condition, const host::Registry& registry);

struct PowerOfRun {
  double value = 0, sem = 0;  ///< W, of the whole charge; without unlike tracers, all beads like the others, where the case sets some apart
};
PowerOfRun power_of(const std::filesystem::path& run, const host::Registry& registry);

struct RecordingOf {
  std::filesystem::path run;     ///< of the truth
  std::filesystem::path folder;  ///< of the set
  std::string name;              ///< "r_speed75": NAME.yaml, NAME_1.a, NAME_2.a, …
  recording::Condition condition;
  std::uint64_t seed = 1;  ///< of the camera
};

/// Passes the run's beads through the camera. Throws base::UserError when it saw none for long enough.
void write_recording(const RecordingOf& what, const camera::Camera& camera, const host::Registry& registry);

}  // namespace millscope::challenge
