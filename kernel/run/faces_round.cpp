#include "kernel/run/faces_round.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace millscope::run {
namespace {

using Point = std::array<double, 2>;

constexpr double kRadial = 1e-6;    // of a segment's length across the direction: it points to the axis
constexpr double kRounding = 1e-9;  // of a step between directions: an end that two triangles share is seen in both

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

/// Takes the segment in every direction in which it is the nearest so far.
void look_at(const std::array<Point, 2>& ends, std::uint64_t triangle, std::vector<Facing>& nearest) {
  const auto directions = static_cast<int>(nearest.size());
  const double first = std::atan2(ends[0][1], ends[0][0]), sweep = std::remainder(std::atan2(ends[1][1], ends[1][0]) - first, kTurn);
  const double step = kTurn / directions, low = std::min(first, first + sweep) / step, high = std::max(first, first + sweep) / step;
  const double span = std::hypot(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
  const double nearer = std::min(std::hypot(ends[0][0], ends[0][1]), std::hypot(ends[1][0], ends[1][1]));
  const double moment = ends[0][0] * ends[1][1] - ends[0][1] * ends[1][0];
  for (auto k = static_cast<int>(std::ceil(low - kRounding)); k <= high + kRounding; ++k) {
    const double c = std::cos(k * step), sn = std::sin(k * step);
    const double across = c * (ends[1][1] - ends[0][1]) - sn * (ends[1][0] - ends[0][0]);
    // Along the direction itself, as an upright face is, both are but rounding.
    const double distance = std::fabs(across) < kRadial * span ? nearer : moment / across;
    Facing& seen = nearest[static_cast<std::size_t>((k % directions + directions) % directions)];
    if (distance < seen.distance) seen = {distance, triangle};
  }
}

}  // namespace

std::vector<Facing> faces_round(const Surface& surface, const Interior& in, double z, int directions) {
  std::vector<Facing> nearest(static_cast<std::size_t>(directions), {std::numeric_limits<double>::infinity(), kNoTriangle});
  std::array<Point, 2> ends{};
  for (std::uint64_t t = 0; t < surface.triangle_count; ++t) {
    if (cut(surface, t, in, z, ends)) look_at(ends, t, nearest);
  }
  return nearest;
}

}  // namespace millscope::run
