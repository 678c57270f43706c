#include "studies/frames/wall_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"

namespace millscope::frames {
namespace {

using base::UserError;

constexpr double kMostOutside = 0.01;    // of the beads of a frame: single ones leak, whole charges do not
constexpr double kNearestToShell = 0.6;  // of the radius: gravity holds a charge against its shell or its lifters
constexpr double kLeastLength = 0.25;    // of the mill: a charge spreads from end to end
constexpr double kAbove = 0.05;          // of the radius: a charge that is flung round hangs on the axis
constexpr double kTouch = 0.2;           // of a bead's radius, from the shell
constexpr std::size_t kFewestRiding = 30, kMostKept = 2'000'000;
constexpr double kAgree = 0.8;  // of those at the shell turn one way

/// "; is the unit mm?", where that brings the beads in.
std::string unit_hint(double ratio, double unit) {
  struct Known {
    const char* name;
    double size;
  };
  constexpr Known kUnits[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}};
  for (const Known& known : kUnits) {
    const double scaled = ratio * known.size / unit;
    if (known.size != unit && scaled > kNearestToShell && scaled < 1.05)
      return fmt::format("is the unit of the files {}? Write 'length_unit: {}'; else ", known.name, known.name);
  }
  return "";
}

}  // namespace

void WallWatch::look(const Beads& beads, const std::vector<double>& radius, const std::string& place) {
  const double shell = 0.5 * mill_.diameter;
  std::vector<double> distance(beads.size());
  std::size_t beyond_shell = 0, beyond_ends = 0;
  double farthest = 0, low = 0, high = 0;
  mean_y_ = 0;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const double x = beads.position[3 * i], y = beads.position[3 * i + 1], z = beads.position[3 * i + 2], r = std::hypot(x, y);
    distance[i] = r;
    mean_y_ += y / static_cast<double>(beads.size());
    beyond_shell += r > shell ? 1 : 0;
    beyond_ends += !mill_.periodic && (z < 0 || z > mill_.length) ? 1 : 0;
    low_ = std::min(low_, z), high_ = std::max(high_, z);
    low = std::min(low, z), high = std::max(high, z - mill_.length), farthest = std::max(farthest, r);
    if (r <= shell) farthest_ = std::max(farthest_, r + radius[i]);
    if (!beads.velocity.empty()) ride(beads.time, {x, y, z}, {beads.velocity[3 * i], beads.velocity[3 * i + 1], 0}, radius[i]);
  }
  outside_ = std::max({outside_, beyond_shell, beyond_ends});
  const double most = kMostOutside * static_cast<double>(beads.size());
  if (static_cast<double>(beyond_shell) > most) {
    throw UserError(
        fmt::format("{}: {} of {} beads have their centres beyond the shell of {:.4g} m radius, up to {:.4g} m from the axis; {}check "
                    "'diameter', 'centre' and 'axis' of {}",
                    place, beyond_shell, beads.size(), shell, farthest,
                    unit_hint(base::quantile(distance, 0.98) / shell, mill_.length_unit), mill_.file));
  }
  if (static_cast<double>(beyond_ends) > most) {
    throw UserError(
        fmt::format("{}: {} of {} beads have their centres beyond the ends of the mill, up to {:.4g} m; check 'ends' and 'axis' of {}, or "
                    "say 'periodic: true' for a slice",
                    place, beyond_ends, beads.size(), std::max(-low, high), mill_.file));
  }
}

void WallWatch::ride(double time, const base::Vector3& place, const base::Vector3& velocity, double radius) {
  const double shell = 0.5 * mill_.diameter, r = std::hypot(place[0], place[1]);
  if (r > shell || r + (1 + kTouch) * radius < shell || turning_.size() >= kMostKept || time < mill_.start) return;
  turning_.push_back((place[0] * velocity[1] - place[1] * velocity[0]) / (r * r));
}

void WallWatch::judge() const {
  const double shell = 0.5 * mill_.diameter;
  if (farthest_ < kNearestToShell * shell) {
    throw UserError(
        fmt::format("{}: no bead comes farther than {:.4g} m from the axis, in a shell of {:.4g} m radius; {}check 'diameter' and 'centre'",
                    mill_.file, farthest_, shell, unit_hint(farthest_ / shell, mill_.length_unit)));
  }
  if (high_ - low_ < kLeastLength * mill_.length && high_ - low_ > 0) {
    throw UserError(
        fmt::format("{}: the beads take {:.4g} m of the {:.4g} m between the ends; 'ends' are in m or say their unit, e.g. [0 mm, 40 mm]",
                    mill_.file, high_ - low_, mill_.length));
  }
  if (mean_y_ > kAbove * shell)
    throw UserError(fmt::format("{}: in the last frame the charge's middle stands {:.4g} m above the axis; check 'gravity' and 'centre'",
                                mill_.file, mean_y_));
}

std::optional<double> WallWatch::turning() const {
  if (turning_.size() < kFewestRiding) return std::nullopt;
  const auto forward = static_cast<double>(std::count_if(turning_.begin(), turning_.end(), [](double w) { return w > 0; }));
  const double share = forward / static_cast<double>(turning_.size());
  if (share < kAgree && share > 1 - kAgree) return std::nullopt;
  std::vector<double> values = turning_;
  return base::quantile(values, 0.5);
}

}  // namespace millscope::frames
