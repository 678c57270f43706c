#include "studies/frames/turning.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/config/case.hpp"

namespace millscope::frames {
namespace {

using base::UserError;

constexpr double kFaster = 1.1;  // than the shell: what rides along cannot be, but scatter can
constexpr double kSlower = 0.8;  // beads slip; below this the speed may as well be another
constexpr double kSure = 0.2;    // of the stated speed: less is a charge that lies still

const char* sense_text(double omega) { return omega > 0 ? "counter-clockwise" : "clockwise"; }

std::optional<double> stated_speed(const MillFile& mill, const Census& census) {
  if (!mill.of_critical) return mill.speed;
  double largest = 0;
  for (const BeadKind& bead : census.beads()) largest = std::max(largest, 2 * bead.radius);
  if (!(largest < mill.diameter))
    throw UserError(fmt::format("{}: the largest bead, {:.4g} m, is not smaller than the mill; check 'length_unit' and 'diameter'",
                                mill.file, largest));
  return *mill.of_critical * config::critical_speed(mill.diameter, largest);
}

void check_sense(const MillFile& mill, double speed, double found) {
  if (!mill.sense || *mill.sense * found > 0 || std::fabs(found) < kSure * speed) return;
  throw UserError(fmt::format(
      "{}: 'direction' says {}, but the beads at the shell move {} (at {:.4g} rad/s, seen against 'axis'); correct 'direction' or 'axis'",
      mill.file, sense_text(*mill.sense), sense_text(found), std::fabs(found)));
}

void check_speed(const MillFile& mill, double speed, double found, std::vector<std::string>& notes) {
  const double part = std::fabs(found) / speed;
  if (part > kFaster)
    throw UserError(
        fmt::format("{}: the beads at the shell turn at {:.4g} rad/s, faster than the mill is stated to, {:.4g} rad/s; check 'speed' and "
                    "its unit, and 'velocity_unit'",
                    mill.file, std::fabs(found), speed));
  if (part < kSlower)
    notes.push_back(fmt::format(
        "the beads at the shell turn at {:.4g} rad/s, the mill is stated to turn at {:.4g} rad/s: they slip, or the speed is another",
        std::fabs(found), speed));
}

}  // namespace

Turning turning_of(const MillFile& mill, const Gather& gathered, std::vector<std::string>& notes) {
  const std::optional<double> found = gathered.walls().turning(), stated = stated_speed(mill, gathered.census());
  if (stated && *stated == 0) return {0, mill.start};
  const std::string why = gathered.has_velocity() || gathered.walls().riding() > 0
                              ? "too few beads ride along the shell, or not the same way"
                              : "the files hold no velocities";
  if (!found) {
    if (!stated || !mill.sense)
      throw UserError(fmt::format("{}: the {} of the mill is not stated and not to be found ({}); add '{}' to 'mill'", mill.file,
                                  stated ? "sense" : "speed", why,
                                  stated ? "direction: clockwise (or counter_clockwise)" : "speed: 40 rpm"));
    notes.push_back(fmt::format("speed and sense of the mill are taken as stated ({})", why));
    return {*mill.sense * *stated, mill.start};
  }
  const double speed = stated.value_or(std::fabs(*found));
  check_sense(mill, speed, *found);
  if (stated) check_speed(mill, speed, *found, notes);
  if (!stated)
    notes.push_back(
        fmt::format("the speed of the mill is not stated: {:.4g} rad/s is taken, the median of {} beads at its shell; where they slip the "
                    "mill turns faster",
                    speed, gathered.walls().riding()));
  if (!mill.sense) notes.push_back(fmt::format("the mill was found to turn {}, seen against its axis", sense_text(*found)));
  const int sense = mill.sense ? *mill.sense : *found > 0 ? 1 : -1;
  return {sense * speed, mill.start};
}

}  // namespace millscope::frames
