// Centre of circulation (the eye): where the mean flow stands still and the charge turns about it.
//
//   v(x) ≈ c + B (x − x₀)        least squares over the cells, weight = time · exp(−|x − x₀|²/(2 h²))
//   x₀ ← x₀ − B⁻¹ c              until it rests; h shrinks from 0.4 R to 0.15 R
//
// The search starts at the centre of mass of the charge. A centre is accepted where det B > 0 and the flow turns about it in the mill's
// sense, inside the shell, with at least 0.1 % of the charge's time within h.
#pragma once

#include <cmath>
#include <iterator>
#include <optional>

#include "analyzers/common/grid.hpp"
#include "analyzers/common/solve.hpp"

namespace millscope::analyzers {

/// Mean flow in cells of x and y. Cell (ix, iy) begins at data[stride (iy n + ix)] with time (s), time × v_x and time × v_y (m).
struct FlowMap {
  Bins cells;
  const double* data;
  std::int64_t stride;
  double radius;  ///< of the shell, m
  double sense;   ///< of turning, ±1
};

struct Centre {
  double x, y;      ///< m
  double rotation;  ///< of the flow about it, in the turning sense: half of the curl, rad/s
};

/// A local linear field c + B (x − x₀), the kernel's share of all time.
struct LinearFlow {
  double c[2], b[2][2];
  double share;
};

template <class Visit>
void for_each_cell(const FlowMap& map, Visit&& visit) {
  for (std::int64_t iy = 0; iy < map.cells.count; ++iy) {
    for (std::int64_t ix = 0; ix < map.cells.count; ++ix) {
      const double* cell = map.data + map.stride * (iy * map.cells.count + ix);
      if (cell[0] > 0) visit(map.cells.centre(ix), map.cells.centre(iy), cell);
    }
  }
}

inline std::optional<LinearFlow> fit_flow(const FlowMap& map, double x0, double y0, double h) {
  Square<3> normal{};
  std::array<double, 3> right[2]{};
  double near = 0, all = 0;
  for_each_cell(map, [&](double x, double y, const double* cell) {
    const double dx = x - x0, dy = y - y0, kernel = std::exp(-0.5 * (dx * dx + dy * dy) / (h * h));
    const double basis[3] = {1, dx, dy};
    near += kernel * cell[0];
    all += cell[0];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) normal[i][j] += kernel * cell[0] * basis[i] * basis[j];
      right[0][i] += kernel * cell[1] * basis[i];
      right[1][i] += kernel * cell[2] * basis[i];
    }
  });
  const auto inverted = inverse(normal);
  if (!inverted) return std::nullopt;
  const auto u = product(*inverted, right[0]), v = product(*inverted, right[1]);
  return LinearFlow{{u[0], v[0]}, {{u[1], u[2]}, {v[1], v[2]}}, near / all};
}

/// Nothing where there is no such place.
inline std::optional<Centre> find_centre(const FlowMap& map) {
  double time = 0, x = 0, y = 0;
  for_each_cell(map, [&](double cx, double cy, const double* cell) {
    time += cell[0];
    x += cell[0] * cx;
    y += cell[0] * cy;
  });
  if (!(time > 0)) return std::nullopt;
  x /= time;
  y /= time;
  constexpr double kWidths[] = {0.4, 0.4, 0.3, 0.3, 0.25, 0.2, 0.2, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15, 0.15};
  constexpr double kLargestStep = 0.1, kRest = 0.01, kLeastShare = 1e-3;
  for (std::size_t i = 0; i < std::size(kWidths); ++i) {
    const auto flow = fit_flow(map, x, y, kWidths[i] * map.radius);
    if (!flow) return std::nullopt;
    const double determinant = flow->b[0][0] * flow->b[1][1] - flow->b[0][1] * flow->b[1][0];
    if (determinant == 0) return std::nullopt;
    const double dx = -(flow->b[1][1] * flow->c[0] - flow->b[0][1] * flow->c[1]) / determinant;
    const double dy = -(flow->b[0][0] * flow->c[1] - flow->b[1][0] * flow->c[0]) / determinant;
    const double step = std::hypot(dx, dy), shorten = step > 0 ? std::fmin(1, kLargestStep * map.radius / step) : 1;
    x += dx * shorten;
    y += dy * shorten;
    if (i + 1 < std::size(kWidths)) continue;
    const double rotation = 0.5 * map.sense * (flow->b[1][0] - flow->b[0][1]);
    if (step < kRest * map.radius && determinant > 0 && rotation > 0 && flow->share > kLeastShare && std::hypot(x, y) < map.radius) {
      return Centre{x, y, rotation};
    }
  }
  return std::nullopt;
}

}  // namespace millscope::analyzers
