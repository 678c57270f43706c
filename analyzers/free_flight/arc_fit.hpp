// One arc against a motion with gravity and drag, by its whole path (output error), never by differentiated positions.
//
//   x(t) = x₀ + v₀ t + g t²/2 − k ∫∫ |v| v        g: gravity (3), k: drag coefficient, 1/m
//
// The path is linear in x₀, v₀, g and k once v inside the integral is known. It is taken from a polynomial of degree five that is
// fitted to the arc itself (three where there are few points), which is far closer to the path than the noise. x₀ and v₀ of each arc are
// eliminated (Schur complement: what is left of each column after its weighted projection on 1 and t), so that the equations for g and k of
// all arcs add up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "analyzers/common/solve.hpp"

namespace millscope::analyzers {

struct ArcPoint {
  double time;  ///< s
  std::array<double, 3> position;
  double weight;  ///< 1/variance of each component, 1/m²
};

/// Equations for (g_x, g_y + g₀, g_z, k), and what is left; g₀ is the stated gravity along −y, taken out so that the sums keep their
/// digits.
struct ArcEquations {
  Square<4> normal{};
  std::array<double, 4> right{};
  double square = 0;  ///< of the data after elimination of x₀ and v₀, in units of their variance
  double freedom = 0;
  double length = 0;       ///< of the path, m
  double roughness = 0;    ///< rms of the residuals of the polynomial over the noise
  double first_speed = 0;  ///< m/s
  double last_speed = 0;
};

namespace detail {

/// A polynomial in u = (t − middle)/half, per component.
struct Path {
  static constexpr std::size_t kTerms = 6;
  double middle, half;
  std::array<std::array<double, kTerms>, 3> c{};
  double terms = 0;  ///< that were fitted

  double at(std::size_t axis, double t) const {
    const double u = (t - middle) / half;
    double x = 0;
    for (std::size_t i = kTerms; i-- > 0;) x = x * u + c[axis][i];
    return x;
  }
  std::array<double, 3> velocity(double t) const {
    const double u = (t - middle) / half;
    std::array<double, 3> v{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = kTerms; i-- > 1;) v[axis] = v[axis] * u + static_cast<double>(i) * c[axis][i];
      v[axis] /= half;
    }
    return v;
  }
};

template <std::size_t terms>
std::optional<Path> fit_path(const std::vector<ArcPoint>& points) {
  Path path{0.5 * (points.front().time + points.back().time), 0.5 * (points.back().time - points.front().time), {}, terms};
  Square<terms> normal{};
  std::array<std::array<double, terms>, 3> right{};
  for (const ArcPoint& p : points) {
    std::array<double, terms> basis;
    basis[0] = 1;
    for (std::size_t i = 1; i < terms; ++i) basis[i] = basis[i - 1] * (p.time - path.middle) / path.half;
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) normal[i][j] += p.weight * basis[i] * basis[j];
      for (std::size_t axis = 0; axis < 3; ++axis) right[axis][i] += p.weight * basis[i] * p.position[axis];
    }
  }
  const auto inverted = inverse(normal);
  if (!inverted) return std::nullopt;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto c = product(*inverted, right[axis]);
    std::copy(c.begin(), c.end(), path.c[axis].begin());
  }
  return path;
}

/// Of degree five, or three where there are few points.
inline std::optional<Path> fit_path(const std::vector<ArcPoint>& points) {
  return points.size() < 2 * Path::kTerms ? fit_path<4>(points) : fit_path<6>(points);
}

/// −∫∫ |v| v along a smooth path, at even times from the first point to the last.
struct DragPath {
  static constexpr std::size_t kSteps = 64;
  double start, step, length = 0;
  std::array<std::array<double, 3>, kSteps + 1> path{};

  DragPath(const Path& smooth, double from, double to) : start(from), step((to - from) / kSteps) {
    std::array<double, 3> rate{}, before{};
    double speed_before = 0;
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const std::array<double, 3> v = smooth.velocity(start + static_cast<double>(i) * step);
      const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double force = -speed * v[axis];
        if (i > 0) {  // both integrals of a force that is linear within the step
          path[i][axis] = path[i - 1][axis] + step * (rate[axis] + step * (before[axis] / 3 + force / 6));
          rate[axis] += 0.5 * step * (before[axis] + force);
        }
        before[axis] = force;
      }
      if (i > 0) length += 0.5 * step * (speed + speed_before);
      speed_before = speed;
    }
  }
  double at(std::size_t axis, double t) const {
    const double place = std::fmin(std::fmax((t - start) / step, 0.0), static_cast<double>(kSteps));
    const std::size_t i = std::min(static_cast<std::size_t>(place), kSteps - 1);
    const double part = place - static_cast<double>(i);
    return path[i][axis] + part * (path[i + 1][axis] - path[i][axis]);
  }
};

/// Takes the weighted mean and slope out of a column over the points.
class Eliminator {
 public:
  Eliminator(const std::vector<ArcPoint>& points, double middle) : points_(&points), middle_(middle) {
    Square<2> normal{};
    for (const ArcPoint& p : points) {
      const double t = p.time - middle;
      normal[0][0] += p.weight;
      normal[0][1] += p.weight * t;
      normal[1][1] += p.weight * t * t;
    }
    normal[1][0] = normal[0][1];
    inverse_ = inverse(normal).value_or(Square<2>{});
  }
  void operator()(std::vector<double>& column) const {
    std::array<double, 2> right{};
    for (std::size_t i = 0; i < column.size(); ++i) {
      right[0] += (*points_)[i].weight * column[i];
      right[1] += (*points_)[i].weight * column[i] * ((*points_)[i].time - middle_);
    }
    const auto line = product(inverse_, right);
    for (std::size_t i = 0; i < column.size(); ++i) column[i] -= line[0] + line[1] * ((*points_)[i].time - middle_);
  }

 private:
  const std::vector<ArcPoint>* points_;
  double middle_;
  Square<2> inverse_{};
};

}  // namespace detail

/// At least six points. Nothing when their times do not determine a path.
inline std::optional<ArcEquations> arc_equations(const std::vector<ArcPoint>& points, double stated_gravity) {
  const auto smooth = detail::fit_path(points);
  if (!smooth) return std::nullopt;
  const detail::DragPath drag(*smooth, points.front().time, points.back().time);
  const detail::Eliminator eliminate(points, smooth->middle);
  const std::size_t n = points.size();
  ArcEquations out;
  double rough = 0;
  std::vector<double> fall(n), slow(n), data(n);
  for (std::size_t i = 0; i < n; ++i) fall[i] = 0.5 * std::pow(points[i].time - smooth->middle, 2);
  eliminate(fall);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < n; ++i) {
      slow[i] = drag.at(axis, points[i].time);
      data[i] = points[i].position[axis] - smooth->c[axis][0];
      rough += points[i].weight * std::pow(points[i].position[axis] - smooth->at(axis, points[i].time), 2);
    }
    eliminate(slow);
    eliminate(data);
    if (axis == 1) {
      for (std::size_t i = 0; i < n; ++i) data[i] += stated_gravity * fall[i];
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double w = points[i].weight;
      out.normal[axis][axis] += w * fall[i] * fall[i];
      out.normal[axis][3] += w * fall[i] * slow[i];
      out.normal[3][3] += w * slow[i] * slow[i];
      out.right[axis] += w * fall[i] * data[i];
      out.right[3] += w * slow[i] * data[i];
      out.square += w * data[i] * data[i];
    }
    out.normal[3][axis] = out.normal[axis][3];
  }
  const auto speed = [&](double t) {
    const auto v = smooth->velocity(t);
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  };
  out.freedom = 3 * (static_cast<double>(n) - 2);
  out.length = drag.length;
  out.roughness = std::sqrt(rough / (3 * (static_cast<double>(n) - smooth->terms)));
  out.first_speed = speed(points.front().time);
  out.last_speed = speed(points.back().time);
  return out;
}

}  // namespace millscope::analyzers
