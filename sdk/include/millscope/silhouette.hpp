// The outline of a bed as rings see it: for the analyzer that looks at simulated beads through an end face, and for who reads a picture
// of a real drum, so that both are measured by one rule.
//
//   P(x, y)                    share of the time that beads cover the place, 0 … 1
//   S_k = ⟨P⟩                  over ring k: share of the circle that the bed covers
//   φ_k = arg ⟨P (cos θ, sin θ)⟩  the middle of that arc, from 6 o'clock
//   e_k = ½ ∮ 4 P (1 − P) r dθ    how blurred either end of the arc is, along the circle
//   h(x) = ∫ P dy              height of the bed above the shell; the surface is as steep as the straight line through it over the
//                              middle half of the width
//
// No place of the outline is looked for, so a blurred surface and beads in flight count as much as they are seen.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace millscope {

inline constexpr int kSilhouetteRings = 8;
inline constexpr double kSilhouetteInner = 0.15, kSilhouetteOuter = 0.95;  ///< parts of the radius; the rim itself is left out

/// One ring: between `inner` and `outer`, parts of the radius.
struct SilhouetteRing {
  double inner, outer;
  double share;      ///< 0 … 1
  double direction;  ///< rad, from 6 o'clock, counter-clockwise; see has_middle
  double edge;       ///< part of the radius
  /// Whether the arc is neither nearly nothing nor nearly the whole circle: `least` of it is covered, and as much is free.
  bool has_middle(double least) const { return share > least && share < 1 - least; }
};

struct SilhouetteShape {
  std::vector<SilhouetteRing> rings;
  double area;   ///< covered share of the disc
  double lean;   ///< mean of P x over the disc, part of the radius: to which side the bed leans
  double slope;  ///< rise of the surface over its run along x
};

namespace detail {

/// Slope of the straight line of least squares through the bed's height over the middle half of the width.
inline double silhouette_slope(const double* covered, std::int64_t n) {
  const double cell = 2.0 / static_cast<double>(n);
  double count = 0, x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (std::int64_t i = 0; i < n; ++i) {
    const double x = (static_cast<double>(i) + 0.5) * cell - 1;
    if (std::fabs(x) > 0.5) continue;
    double y = -std::sqrt(1 - x * x);
    for (std::int64_t j = 0; j < n; ++j) {
      const double up = (static_cast<double>(j) + 0.5) * cell - 1;
      if (std::hypot(x, up) < 1) y += covered[j * n + i] * cell;
    }
    count += 1, x_sum += x, y_sum += y, xx += x * x, xy += x * y;
  }
  return (xy - x_sum * y_sum / count) / (xx - x_sum * x_sum / count);
}

}  // namespace detail

/// `covered`: P on n × n cells of the square about the shell, row by row upwards.
inline SilhouetteShape silhouette_shape(const double* covered, std::int64_t n) {
  struct Sum {
    double cells = 0, covered = 0, x = 0, y = 0, edge = 0;
  } ring[kSilhouetteRings], disc;
  const double cell = 2.0 / static_cast<double>(n), width = (kSilhouetteOuter - kSilhouetteInner) / kSilhouetteRings;
  for (std::int64_t j = 0; j < n; ++j) {
    for (std::int64_t i = 0; i < n; ++i) {
      const double x = (static_cast<double>(i) + 0.5) * cell - 1, y = (static_cast<double>(j) + 0.5) * cell - 1;
      const double r = std::hypot(x, y), p = covered[j * n + i], place = (r - kSilhouetteInner) / width;
      if (r < 1) disc.cells += 1, disc.covered += p, disc.x += p * x;
      if (place < 0 || place >= kSilhouetteRings) continue;
      Sum& s = ring[static_cast<int>(place)];
      s.cells += 1, s.covered += p, s.x += p * x / r, s.y += p * y / r, s.edge += 4 * p * (1 - p);
    }
  }
  SilhouetteShape shape{{}, disc.covered / disc.cells, disc.x / disc.cells, detail::silhouette_slope(covered, n)};
  for (int k = 0; k < kSilhouetteRings; ++k) {
    const Sum& s = ring[k];
    const double inner = kSilhouetteInner + k * width, outer = inner + width;
    shape.rings.push_back(
        {inner, outer, s.covered / s.cells, std::atan2(s.x, -s.y), 0.5 * s.edge / s.cells * std::numbers::pi * (inner + outer)});
  }
  return shape;
}

}  // namespace millscope
