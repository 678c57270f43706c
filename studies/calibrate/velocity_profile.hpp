// A measured velocity profile in the place of a recording: where no track was kept, but the velocity against depth was published.
//
//   # drum.yaml
//   profile:
//     file: points.csv                              # a line of names, then numbers
//     position: {column: y, unit: mm}               # from the mill's axis along the bed's normal, below 0 in the bed
//     velocity: {column: v, unit: m/s}              # along the free surface, above 0 with the shell beneath the bed
//     position_error: 1 mm                          # standard errors of each point by itself
//     velocity_error: 0.01 m/s
//     origin_error: 1 mm                            # of all positions together: where the axis lies in the figure; default: 0
//     from: -110 mm                                 # what is used of it; default: all
//     to: -40 mm
//     z: [0 mm, 360 mm]                             # part of the mill's length that the profile is of; default: all
//   condition: {speed: 11.6 rpm, mill_diameter: 240 mm}
//
// Simulations are compared by the analyzer `bed_profile` over all their beads, without a camera.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "studies/calibrate/recorded.hpp"

namespace millscope::calibrate {

/// Points by position, SI.
struct VelocityProfile {
  std::filesystem::path points;  ///< the file of numbers
  recording::Condition condition;
  std::vector<double> position, velocity;
  double position_error = 0, velocity_error = 0, origin_error = 0;
  std::optional<double> z_low, z_high;
};

/// The profile that a recording.yaml tells of; nothing where it tells of tracks. Throws base::UserError with file:line.
std::optional<VelocityProfile> read_profile(const std::filesystem::path& recording);

/// Neighbouring points together, at most twelve values. Throws base::UserError where the case's mill is too small for them.
RecordedCondition look_at_profile(const VelocityProfile& profile, std::size_t condition, const Processing& how);

/// What a finished run shows of it.
analysis::ResultSet profile_of_run(const std::filesystem::path& run, const RecordedCondition& recorded, const Processing& how);

}  // namespace millscope::calibrate
