#include <fmt/format.h>

#include <cmath>

#include "kernel/config/error.hpp"
#include "studies/recording/noise.hpp"
#include "studies/trajectory/pieces.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::studies {
namespace {

using config::UserError;

/// The variance of c·s for the states s = (x0, v0, x1, v1) at both ends of an interval.
double quadratic(const std::array<double, 4>& c, const StateVariance& p, const StateVariance& r, const CrossVariance& m) {
  return c[0] * (c[0] * p.position + 2 * c[1] * p.mixed) + c[1] * c[1] * p.velocity + c[2] * (c[2] * r.position + 2 * c[3] * r.mixed) +
         c[3] * c[3] * r.velocity +
         2 * (c[0] * (c[2] * m.position_position + c[3] * m.position_velocity) +
              c[1] * (c[2] * m.velocity_position + c[3] * m.velocity_velocity));
}

double apply(const std::array<double, 4>& c, const AxisSpline& s, std::size_t i) {
  return c[0] * s.position[i] + c[1] * s.velocity[i] + c[2] * s.position[i + 1] + c[3] * s.velocity[i + 1];
}

/// Hermite's weights of (x0, v0, x1, v1) at u within an interval of length h, and those of the derivatives.
struct Hermite {
  std::array<double, 4> value, slope, bend;
  Hermite(double u, double h) {
    const double s = u / h, r = 1 - s;
    value = {(1 + 2 * s) * r * r, u * r * r, s * s * (3 - 2 * s), -s * s * r * h};
    slope = {-6 * s * r / h, r * (1 - 3 * s), 6 * s * r / h, s * (3 * s - 2)};
    bend = {(12 * s - 6) / (h * h), (6 * s - 4) / h, (6 - 12 * s) / (h * h), (6 * s - 2) / h};
  }
};

/// Samples at even times of one unbroken stretch.
void sample(const Run& run, const Span& span, const std::array<AxisSpline, 3>& splines, Piece& piece) {
  const auto count = piece.size();
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = piece.start + static_cast<double>(k) * piece.step;
    while (i + 2 < span.size() && run.time[span.first + i + 1] <= t) ++i;
    const double h = run.time[span.first + i + 1] - run.time[span.first + i], u = std::min(std::max(t - run.time[span.first + i], 0.0), h),
                 w = h - u;
    const Hermite hermite(u, h);
    double position = 0, velocity = 0, acceleration = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisSpline& s = splines[axis];
      piece.position[axis][k] = apply(hermite.value, s, i);
      piece.velocity[axis][k] = apply(hermite.slope, s, i);
      piece.acceleration[axis][k] = apply(hermite.bend, s, i);
      // What the random motion does between two known ends (covariance of a clamped beam).
      position += quadratic(hermite.value, s.variance[i], s.variance[i + 1], s.cross[i]) + s.roughness * std::pow(u * w / h, 3) / 3;
      velocity += quadratic(hermite.slope, s.variance[i], s.variance[i + 1], s.cross[i]) +
                  s.roughness * u * w * (u * u - u * w + w * w) / (h * h * h);
      acceleration += quadratic(hermite.bend, s.variance[i], s.variance[i + 1], s.cross[i]);
    }
    piece.position_variance[k] = position / 3;
    piece.velocity_variance[k] = velocity / 3;
    piece.acceleration_variance[k] = acceleration / 3;
  }
}

/// Even times are whole multiples of the step, so that they do not depend on where a piece begins.
Piece empty_piece(double first, double last, double step) {
  Piece piece;
  const double begin = std::ceil(first / step - 1e-9), end = std::floor(last / step + 1e-9);
  const auto count = end >= begin ? static_cast<std::size_t>(end - begin) + 1 : 0;
  piece.start = begin * step;
  piece.step = step;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    piece.position[axis].resize(count);
    piece.velocity[axis].resize(count);
    piece.acceleration[axis].resize(count);
  }
  piece.position_variance.resize(count);
  piece.velocity_variance.resize(count);
  piece.acceleration_variance.resize(count);
  piece.weight.assign(count, step);
  return piece;
}

/// Dwell times: a step for each sample; the ends stand for what the piece covers of theirs; none outside low … high.
void weigh(Piece& piece, double first, double last, const TrajectoryOptions& options, Trajectory& trajectory) {
  const std::size_t n = piece.size();
  const double half = piece.step / 2;
  piece.weight[0] -= half - std::min(half, piece.start - first);
  piece.weight[n - 1] -= half - std::min(half, last - (piece.start + static_cast<double>(n - 1) * piece.step));
  if (!(options.high > options.low)) return;
  for (std::size_t k = 0; k < n; ++k) {
    const double z = piece.position[2][k];
    if (z >= options.low && z <= options.high) continue;
    piece.weight[k] = 0;
    ++trajectory.samples_trimmed;
  }
}

Run in_mill_frame(const Run& run, const TrajectoryOptions& options) {
  Run moved = run;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (double& value : moved.position[axis]) value -= options.axis[axis];
  }
  return moved;
}

}  // namespace

std::vector<Span> unbroken(const Run& run, double gap_limit) {
  std::vector<Span> spans;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i == 0 || run.time[i] - run.time[i - 1] > gap_limit) spans.push_back({i, i});
    spans.back().last = i + 1;
  }
  return spans;
}

std::array<double, 3> estimate_noise(const Run& run, double gap_limit) { return difference_noise(run, gap_limit); }

Trajectory fit_trajectory(const Run& run, const TrajectoryOptions& options) {
  const Run moved = in_mill_frame(run, options);
  Trajectory trajectory;
  trajectory.name = run.name;
  trajectory.location_time = moved.time;
  trajectory.location_position = moved.position;
  trajectory.span = run.size() > 0 ? run.time.back() - run.time.front() : 0;
  const auto estimated = estimate_noise(run, options.gap_limit);
  std::vector<Span> spans;
  for (const Span& span : unbroken(run, options.gap_limit)) {
    if (span.size() >= static_cast<std::size_t>(std::max(options.least_points, 2))) {
      spans.push_back(span);
    } else {
      trajectory.points_left_out += span.size();
    }
  }
  std::array<double, 3> roughness{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    trajectory.noise[axis] = options.noise[axis] > 0 ? options.noise[axis] : estimated[axis];
    trajectory.noise[axis] = std::max(trajectory.noise[axis], 1e-9);
    if (options.kind == SplineKind::smoothing) roughness[axis] = likely_roughness(moved, axis, spans, trajectory.noise[axis]);
  }
  std::array<AxisSpline, 3> splines;
  for (const Span& span : spans) {
    const double first = moved.time[span.first], last = moved.time[span.last - 1];
    Piece piece = empty_piece(first, last, options.step);
    if (piece.size() == 0) {
      trajectory.points_left_out += span.size();
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* time = moved.time.data() + span.first;
      const double* value = moved.position[axis].data() + span.first;
      if (options.kind == SplineKind::cubic) {
        interpolate(time, value, span.size(), trajectory.noise[axis], splines[axis]);
      } else {
        smooth(time, value, span.size(), trajectory.noise[axis], roughness[axis], splines[axis]);
      }
    }
    sample(moved, span, splines, piece);
    weigh(piece, first, last, options, trajectory);
    trajectory.covered += last - first;
    trajectory.pieces.push_back(std::move(piece));
  }
  if (trajectory.pieces.empty()) {
    throw UserError(
        fmt::format("{}: no stretch of {} points without a pause longer than {} s; the recording is too sparse for a trajectory, "
                    "or raise gap_limit",
                    run.source, options.least_points, options.gap_limit));
  }
  return trajectory;
}

}  // namespace millscope::studies
