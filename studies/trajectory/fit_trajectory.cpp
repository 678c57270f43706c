#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/base/error.hpp"
#include "studies/recording/travel.hpp"
#include "studies/trajectory/pieces.hpp"
#include "studies/trajectory/sample.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::trajectory {
namespace {

using base::UserError;

/// Dwell times: a step for each sample; the ends stand for what the piece covers of theirs.
void weigh(Piece& piece, double first, double last) {
  const std::size_t n = piece.size();
  const double half = piece.step / 2, end = piece.start + static_cast<double>(n - 1) * piece.step;
  piece.weight[0] += std::clamp(piece.start - first, 0.0, half) - half;
  piece.weight[n - 1] += std::clamp(last - end, 0.0, half) - half;
}

bool is_trimmed(const TrajectoryOptions& options) { return options.high > options.low; }

/// Samples first … last − 1 of a piece.
Piece part_of(const Piece& whole, std::size_t first, std::size_t last) {
  const auto cut = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  Piece part;
  part.start = whole.start + static_cast<double>(first) * whole.step;
  part.step = whole.step;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    part.position[axis] = cut(whole.position[axis]);
    part.velocity[axis] = cut(whole.velocity[axis]);
  }
  part.position_variance = cut(whole.position_variance);
  part.velocity_variance = cut(whole.velocity_variance);
  part.weight = cut(whole.weight);
  return part;
}

/// Adds what of a piece lies within low … high, a piece for each stay: a track ends where the bead leaves.
void add_pieces(Piece&& piece, const TrajectoryOptions& options, Trajectory& trajectory) {
  if (!is_trimmed(options)) {
    trajectory.pieces.push_back(std::move(piece));
    return;
  }
  const auto inside = [&](std::size_t k) { return piece.position[2][k] >= options.low && piece.position[2][k] <= options.high; };
  for (std::size_t begin = 0; begin < piece.size();) {
    std::size_t end = begin;
    while (end < piece.size() && inside(end)) ++end;
    if (end > begin) trajectory.pieces.push_back(part_of(piece, begin, end));
    for (; end < piece.size() && !inside(end); ++end) ++trajectory.samples_trimmed;
    begin = end;
  }
}

void move_to_axis(recording::Run& run, const std::array<double, 2>& axis) {
  for (std::size_t k = 0; k < 2; ++k) {
    for (double& value : run.position[k]) value -= axis[k];
  }
}

bool is_known(const Lanes& lanes) {
  return std::all_of(lanes.begin(), lanes.end(), [](double value) { return value > 0; });
}

void set_noise(const recording::Run& run, const TrajectoryOptions& options, Trajectory& trajectory) {
  constexpr double kLeast = 1e-7;  // m; a simulated bead has none, a smoothing spline needs some
  NoiseEstimate noise;
  if (!is_known(options.noise) || !options.noise_correlation) noise = estimate_noise_model(run, options.gap_limit);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (options.noise[axis] > 0) noise.standard_deviation[axis] = options.noise[axis];
  }
  noise.correlation = options.noise_correlation.value_or(noise.correlation);
  for (std::size_t axis = 0; axis < 3; ++axis) trajectory.noise[axis] = std::max(noise.standard_deviation[axis], kLeast);
  trajectory.noise_correlation = noise.correlation;
}

/// To a smoothing spline, which is wider than a few points, noise with a correlation of φ looks like white noise (1 + φ)/(1 − φ) times as
/// strong.
Lanes noise_as_seen(SplineKind kind, const Trajectory& trajectory) {
  const double phi = trajectory.noise_correlation, inflation = kind == SplineKind::smoothing ? std::sqrt((1 + phi) / (1 - phi)) : 1;
  return {trajectory.noise[0] * inflation, trajectory.noise[1] * inflation, trajectory.noise[2] * inflation};
}

/// Spans with enough points; those of the others are counted.
std::vector<Span> usable(const recording::Run& run, const TrajectoryOptions& options, Trajectory& trajectory) {
  std::vector<Span> spans;
  for (const Span& span : options.travel ? unbroken(run, options.gap_limit, *options.travel) : unbroken(run, options.gap_limit)) {
    const bool enough = span.size() >= static_cast<std::size_t>(std::max(options.least_points, 3));
    if (enough) spans.push_back(span);
    if (!enough) trajectory.points_left_out += span.size();
  }
  return spans;
}

/// Fits the splines of one span after another.
class Fitter {
 public:
  Fitter(const recording::Run& run, const std::vector<Span>& spans, const TrajectoryOptions& options, const Trajectory& trajectory)
      : run_(run), kind_(options.kind), correlation_(trajectory.noise_correlation), noise_(noise_as_seen(kind_, trajectory)) {
    if (kind_ == SplineKind::smoothing) roughness_ = likely_roughness(run, spans, {noise_, options.roughness});
  }

  /// The spline of a span; `points()` are its knots.
  const Spline& fit(const Span& span) {
    points_ = points_of(run_, span);
    if (kind_ == SplineKind::smoothing) {
      smooth_adaptively(points_, noise_, roughness_, spline_);
      return spline_;
    }
    averaged_ = average(points_, kClose * median_interval(points_), correlation_);
    points_ = averaged_.points();
    interpolate(averaged_, noise_, spline_);
    return spline_;
  }
  const Points& points() const { return points_; }

 private:
  static constexpr double kClose = 0.5;  // median intervals
  const recording::Run& run_;
  SplineKind kind_;
  double correlation_;
  Lanes noise_, roughness_{};
  Points points_{};
  Averaged averaged_;
  Spline spline_;
};

[[noreturn]] void fail_empty(const recording::Run& run, const TrajectoryOptions& options, const Trajectory& trajectory) {
  throw UserError(fmt::format(
      "{}: no trajectory: none of its {} points lies in a stretch of {} or more without a pause above {:.4g} s ({:.4g} s from first "
      "to last point); raise 'gap_limit', or the recording is too sparse",
      run.source, run.size(), options.least_points, options.gap_limit, trajectory.span));
}

void check(const TrajectoryOptions& options) {
  if (!(options.step > 0))
    throw UserError(fmt::format("the step between even times is {} s; it must be positive, e.g. 0.001 s", options.step));
  if (!(options.gap_limit > 0)) throw UserError(fmt::format("the gap limit is {} s; it must be positive, e.g. 0.05 s", options.gap_limit));
  const double correlation = options.noise_correlation.value_or(0);
  if (!(correlation >= 0 && correlation < 1)) {
    throw UserError(fmt::format("the correlation of the noise is {}; it must be at least 0 and below 1", correlation));
  }
}

}  // namespace

Points points_of(const recording::Run& run, const Span& span) {
  const auto first = [&](const std::vector<double>& values) { return values.data() + span.first; };
  return {first(run.time), {first(run.position[0]), first(run.position[1]), first(run.position[2])}, span.size()};
}

std::vector<Span> unbroken(const recording::Run& run, double gap_limit) {
  return unbroken(run, gap_limit, recording::measure_travel({&run, 1}, gap_limit));
}

std::vector<Span> unbroken(const recording::Run& run, double gap_limit, recording::Travel travel) {
  travel.speed *= 2;  // outliers are gone; what is left over this is a jump, e.g. across a periodic boundary
  std::vector<Span> spans;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i == 0 || run.time[i] - run.time[i - 1] > gap_limit || !travel.possible(run, i - 1, i)) spans.push_back({i, i});
    spans.back().last = i + 1;
  }
  return spans;
}

std::array<double, 3> estimate_roughness(std::span<const recording::Run> runs, const TrajectoryOptions& options) {
  check(options);
  Lanes sum_of_logs{};
  double count = 0;
  for (const recording::Run& run : runs) {
    Trajectory trajectory;
    const std::vector<Span> spans = usable(run, options, trajectory);
    if (spans.empty()) continue;
    set_noise(run, options, trajectory);
    const Lanes found = likely_roughness(run, spans, {noise_as_seen(SplineKind::smoothing, trajectory), options.roughness});
    for (std::size_t axis = 0; axis < 3; ++axis) sum_of_logs[axis] += std::log(found[axis]);
    ++count;
  }
  if (count == 0) return {0, 0, 0};
  return {std::exp(sum_of_logs[0] / count), std::exp(sum_of_logs[1] / count), std::exp(sum_of_logs[2] / count)};
}

Trajectory fit_trajectory(const recording::Run& run, const TrajectoryOptions& options) {
  check(options);
  recording::Run moved = run;
  move_to_axis(moved, options.axis);
  Trajectory trajectory;
  trajectory.name = run.name;
  trajectory.span = run.size() > 0 ? run.time.back() - run.time.front() : 0;
  set_noise(moved, options, trajectory);
  const std::vector<Span> spans = usable(moved, options, trajectory);
  Fitter fitter(moved, spans, options, trajectory);
  for (const Span& span : spans) {
    const Spline& spline = fitter.fit(span);
    const Points& knots = fitter.points();
    const double first = knots.time[0], last = knots.time[knots.count - 1];
    Piece piece = empty_piece(first, last, options.step);
    if (piece.size() == 0 || knots.count < 2) {
      trajectory.points_left_out += span.size();
      continue;
    }
    sample(knots.time, spline, piece);
    weigh(piece, first, last);
    add_pieces(std::move(piece), options, trajectory);
  }
  if (trajectory.pieces.empty() && trajectory.samples_trimmed == 0) fail_empty(run, options, trajectory);
  for (const Piece& piece : trajectory.pieces) trajectory.covered += std::accumulate(piece.weight.begin(), piece.weight.end(), 0.0);
  trajectory.location_time = std::move(moved.time);
  trajectory.location_position = std::move(moved.position);
  return trajectory;
}

}  // namespace millscope::trajectory
