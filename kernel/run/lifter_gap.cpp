#include "kernel/run/lifter_gap.hpp"

#include "kernel/run/faces_round.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace millscope::run {
namespace {

constexpr int kDirections = 7200;      // 0.05°: 0.13 mm on the shell of a mill of 300 mm
constexpr double kLeastOfMill = 0.01;  // of the radius: what is lower is a mesh's unevenness, no lifter
constexpr double kLeastOfBead = 0.2;   // of a bead's radius: the bead rolls over it as up a slope of 37°, cos⁻¹ (1 − 0.2)

/// The shortest run of directions in which the surface is farther than `level`, between two in which it is nearer; 0: fewer than two.
int shortest_gap(const std::vector<double>& nearest, double level) {
  const auto start =
      static_cast<std::size_t>(std::find_if(nearest.begin(), nearest.end(), [=](double r) { return r < level; }) - nearest.begin());
  int shortest = kDirections, length = 0, gaps = 0;
  for (std::size_t k = 1; k <= nearest.size(); ++k) {
    if (nearest[(start + k) % nearest.size()] >= level) {
      ++length;
    } else if (length > 0) {
      shortest = std::min(shortest, length);
      length = 0;
      ++gaps;
    }
  }
  return gaps > 1 ? shortest : 0;
}

/// Whether the surface comes out towards the axis anywhere; the facets of a round shell do not. Along a straight line u = 1/r has
/// u(φ−h) + u(φ+h) = 2 cos h u(φ), it is more at an edge that stands away from the axis, and less where a lifter rises from the shell.
bool comes_out(const std::vector<double>& nearest) {
  constexpr double kRounding = 1e-6;  // a mesh's places may have but seven digits
  const double along = 2 * std::cos(kTurn / kDirections);
  for (std::size_t k = 0; k < nearest.size(); ++k) {
    const double before = nearest[(k + nearest.size() - 1) % nearest.size()], after = nearest[(k + 1) % nearest.size()];
    if (nearest[k] * (1 / before + 1 / after) < along - kRounding) return true;
  }
  return false;
}

}  // namespace

std::optional<double> narrowest_lifter_gap(const Surface& surface, const Interior& in, double bead_radius) {
  if (!in.is_bounded || !in.is_cylinder || std::abs(in.axis[2]) < 1 - 1e-9) return {};
  const double middle = in.low[2] + 0.5003 * (in.high[2] - in.low[2]);  // beside the rows of vertices that a mesh may have in the middle
  std::vector<double> nearest;
  for (const Facing& f : faces_round(surface, in, middle, kDirections)) nearest.push_back(std::min(f.distance, in.radius));
  const double top = *std::min_element(nearest.begin(), nearest.end());
  if (in.radius - top < std::max(kLeastOfMill * in.radius, kLeastOfBead * bead_radius) || !comes_out(nearest)) return {};
  const double level = 0.5 * (in.radius + top);
  const int directions = shortest_gap(nearest, level);
  if (directions == 0) return {};
  return 2 * level * std::sin(std::min(0.5 * kTurn, kTurn * directions / kDirections) / 2);
}

}  // namespace millscope::run
