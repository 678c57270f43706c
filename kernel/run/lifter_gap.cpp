#include "kernel/run/lifter_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace millscope::run {
namespace {

using Point = std::array<double, 2>;

constexpr int kDirections = 7200;      // 0.05°: 0.13 mm on the shell of a mill of 300 mm
constexpr double kLeastOfMill = 0.01;  // of the radius: what is lower is a mesh's unevenness, no lifter
constexpr double kLeastOfBead = 0.2;   // of a bead's radius: the bead rolls over it as up a slope of 37°, cos⁻¹ (1 − 0.2)
constexpr double kTurn = 2 * std::numbers::pi;

/// Where the plane z cuts a triangle, seen from the axis; false: it does not.
bool cut(const Surface& s, std::uint64_t triangle, const Interior& in, double z, std::array<Point, 2>& ends) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3 && found < 2; ++k) {
    const double* a = s.vertices + 3 * s.triangles[3 * triangle + k];
    const double* b = s.vertices + 3 * s.triangles[3 * triangle + (k + 1) % 3];
    if ((a[2] < z) == (b[2] < z)) continue;
    const double t = (z - a[2]) / (b[2] - a[2]);
    ends[found++] = {a[0] + t * (b[0] - a[0]) - in.axis_point[0], a[1] + t * (b[1] - a[1]) - in.axis_point[1]};
  }
  return found == 2;
}

/// Takes the segment's distance from the axis in every direction in which it is the nearest so far.
void look_at(const std::array<Point, 2>& ends, std::vector<double>& nearest) {
  const double first = std::atan2(ends[0][1], ends[0][0]), sweep = std::remainder(std::atan2(ends[1][1], ends[1][0]) - first, kTurn);
  const double low = std::min(first, first + sweep), high = std::max(first, first + sweep), step = kTurn / kDirections;
  const double moment = ends[0][0] * ends[1][1] - ends[0][1] * ends[1][0];
  for (auto k = static_cast<int>(std::ceil(low / step)); k * step <= high; ++k) {
    const double c = std::cos(k * step), sn = std::sin(k * step);
    const double across = c * (ends[1][1] - ends[0][1]) - sn * (ends[1][0] - ends[0][0]);
    if (across == 0) continue;
    double& r = nearest[static_cast<std::size_t>((k % kDirections + kDirections) % kDirections)];
    r = std::min(r, moment / across);
  }
}

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
  std::vector<double> nearest(kDirections, in.radius);
  std::array<Point, 2> ends{};
  for (std::uint64_t t = 0; t < surface.triangle_count; ++t) {
    if (cut(surface, t, in, middle, ends)) look_at(ends, nearest);
  }
  const double top = *std::min_element(nearest.begin(), nearest.end());
  if (in.radius - top < std::max(kLeastOfMill * in.radius, kLeastOfBead * bead_radius) || !comes_out(nearest)) return {};
  const double level = 0.5 * (in.radius + top);
  const int directions = shortest_gap(nearest, level);
  if (directions == 0) return {};
  return 2 * level * std::sin(std::min(0.5 * kTurn, kTurn * directions / kDirections) / 2);
}

}  // namespace millscope::run
