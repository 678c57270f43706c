#include "studies/frames/motion_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"

namespace millscope::frames {
namespace {

using base::UserError;
using base::Vector3;

// Where a step is shorter than a bead, a bead goes its mean velocity, but for impacts within the step. Of the story's mill
// (configs/story, beads of 10 mm, frames 1 to 10 ms apart) the median is 0.0005 to 0.033, so that 0.4 is ten times more than what frames
// bring with them. Times or speeds that are wrong by a factor of 1.7, and beads that change their numbers, are beyond.
constexpr double kMostOff = 0.4;
constexpr double kStill = 0.01;  // of a radius: shorter ways are rounding, or a bed at rest that trembles
constexpr std::size_t kFewestSteps = 30, kMostSteps = 2'000'000;
constexpr double kTiny = 1e-9;  // of a radius, in the place of no way at all

double length_of(const Vector3& v) { return std::hypot(v[0], v[1], v[2]); }

Vector3 triple(const std::vector<double>& values, std::size_t row) { return {values[3 * row], values[3 * row + 1], values[3 * row + 2]}; }

}  // namespace

std::vector<MotionWatch::Step> MotionWatch::steps_to(const Beads& beads) const {
  std::unordered_map<std::uint32_t, std::size_t> at;
  for (std::size_t i = 0; i < before_.size(); ++i) at.emplace(before_.id[i], i);
  std::vector<Step> steps;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const auto found = at.find(beads.id[i]);
    if (found == at.end()) continue;
    const Vector3 to = triple(beads.position, i), from = triple(before_.position, found->second);
    Step step{i, found->second, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}};
    if (mill_.periodic) step.way[2] -= mill_.length * std::round(step.way[2] / mill_.length);
    steps.push_back(step);
  }
  return steps;
}

void MotionWatch::look(const Beads& beads, const std::vector<double>& radius, WallWatch& walls) {
  const std::vector<Step> steps = before_.size() > 0 ? steps_to(beads) : std::vector<Step>{};
  if (!steps.empty() && !beads.velocity.empty()) compare(steps, beads, radius);
  if (!steps.empty() && beads.velocity.empty()) {
    std::vector<double> ways;
    for (const Step& step : steps) ways.push_back(length_of(step.way));
    strides_.push_back(base::quantile(ways, 0.99));
    std::vector<double> radii = radius;
    const double span = beads.time - before_.time;
    for (const Step& step : strides_.back() < base::quantile(radii, 0.5) ? steps : std::vector<Step>{}) {
      const Vector3 from = triple(before_.position, step.before), &way = step.way;
      const Vector3 middle{from[0] + 0.5 * way[0], from[1] + 0.5 * way[1], from[2] + 0.5 * way[2]};
      walls.ride(before_.time, middle, {way[0] / span, way[1] / span, way[2] / span}, radius[step.now]);
    }
  }
  before_ = beads;
}

void MotionWatch::compare(const std::vector<Step>& steps, const Beads& beads, const std::vector<double>& radius) {
  const double span = beads.time - before_.time;
  std::vector<double> ways, said, off;
  for (const Step& step : steps) {
    const Vector3 now = triple(beads.velocity, step.now), before = triple(before_.velocity, step.before);
    Vector3 way{}, rest{};
    for (std::size_t k = 0; k < 3; ++k) way[k] = 0.5 * span * (now[k] + before[k]), rest[k] = step.way[k] - way[k];
    ways.push_back(length_of(step.way)), said.push_back(length_of(way)), off.push_back(length_of(rest));
  }
  std::vector<double> radii = radius, gone = ways, meant = said;
  const double middle = base::quantile(radii, 0.5);
  // Of longer steps a straight line says nothing. Where one of the two is short, they are wrong, or the step is short.
  if (base::quantile(gone, 0.5) > middle && base::quantile(meant, 0.5) > middle) return;
  for (std::size_t i = 0; i < steps.size() && off_.size() < kMostSteps; ++i) {
    const double r = radius[steps[i].now];
    if (std::max(ways[i], said[i]) < kStill * r) continue;
    off_.push_back(off[i] / std::max(said[i], kTiny * r));
    part_.push_back(ways[i] / std::max(said[i], kTiny * r));
  }
}

void MotionWatch::judge(bool numbered) const {
  if (off_.size() < kFewestSteps) return;
  std::vector<double> off = off_, part = part_;
  if (base::quantile(off, 0.5) <= kMostOff) return;
  throw UserError(
      fmt::format("{}: from frame to frame beads go {:.3g} times as far as their velocities say (in the median; they miss the place by "
                  "{:.3g} times that way, and true frames by less than {}); check 'time' and 'velocity_unit', {}",
                  mill_.file, base::quantile(part, 0.5), base::quantile(off, 0.5), kMostOff,
                  numbered ? "and that each bead keeps its number" : "and write the id of the beads: their order may change"));
}

double MotionWatch::stride() const {
  std::vector<double> strides = strides_;
  return strides.empty() ? 0 : base::quantile(strides, 0.5);
}

}  // namespace millscope::frames
