// What a run says of its mill, in numbers that do not depend on who played it.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "kernel/output/frame_reader.hpp"

namespace millscope::crosscheck {

/// A number of a run: a mean over its analysis window.
struct Quantity {
  std::string name;  ///< "power by torque", "shoulder angle"
  std::string unit;
  double value = 0;  ///< SI; NaN where the run does not tell it
};

inline constexpr const char* kPowerByTorque = "power by torque";
inline constexpr const char* kPowerByCentre = "power by centre of mass";
inline constexpr const char* kCentre[] = {"centre of mass x", "centre of mass y"};
inline constexpr const char* kTranslation = "translational energy";

/// From summary.json, frames.h5 and, where it applies, the analyzer charge_features of a run's folder. Throws base::UserError.
std::vector<Quantity> measure(const std::filesystem::path& run, const host::Registry& registry);

/// Beads that a bead touches, on average. `place`: [N, 3], m; `period`: along z, m; 0: none.
double contacts_per_bead(std::span<const float> place, const output::FrameBeads& beads, double period);

/// Leaves of each run the quantities that all of them tell, in the order of the first; returns the names of the others.
std::vector<std::string> keep_common(std::vector<std::vector<Quantity>>& runs);

}  // namespace millscope::crosscheck
