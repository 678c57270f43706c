// White and correlated noise and their growth with distance, by restricted maximum likelihood over short stretches of locations.
//
// The shape of the noise (correlated against white part, correlation time) comes from stretches in which the bead rides with the bed; its
// strength and growth come from all, because where a bead is jostled its motion hides slow noise but no fast one.
#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/camera/maximise.hpp"
#include "studies/camera/stretches.hpp"

namespace millscope::camera {
namespace {

constexpr double kLengthScale = 0.1;    // m, makes the growth a number of order one
constexpr double kWhiteScale = 5e-4;    // m
constexpr double kNoCorrelation = -20;  // ln of correlated/white
/// Slow noise that raises the likelihood's logarithm by less explains nothing. By chance alone a quarter of the recordings without any gain
/// more; they then show a little, with an error as large, which does less harm than a whole that is too small.
constexpr double kNothing = 0.25;
/// Locations share events with their neighbours only: known beforehand is a correlation time of one and a half intervals (the scale is
/// two), within a factor of two. A longer memory is told from the bead's own wandering by the data alone.
constexpr double kUsualTime = -0.2877, kTimeDeviation = 0.7;

/// Logarithms of numbers over their scales; growth times kLengthScale.
struct NoisePoint {
  std::array<double, 3> white{0, 0, 0};
  double ratio = -0.5;  ///< correlated/white
  double time = 0;      ///< correlation time
  double growth = 0.4;
  double memory = 0.5;  ///< of the bead's wandering
};

/// What a fit is to tell: its errors cost half as much again.
enum class Errors { none, wanted };

struct Estimator {
  std::vector<Stretch> all, quiet;
  double time_scale;  ///< s
  NoisePoint point;
  Fit shape;  ///< of white (all axes), ratio, time
  Fit size;   ///< of white x, y, z, growth, memory

  /// Of each stretch, with weights of the ladder learnt from all. Were these the likeliest, the errors from the stretches' gradients and
  /// the curvature of the sum would be those of a fit of weights and parameters together; they nearly are.
  std::vector<double> likelihoods(const std::vector<Stretch>& stretches, const NoisePoint& p) const {
    std::array<NoiseStrength, 3> noise;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double white = kWhiteScale * std::exp(p.white[axis]);
      noise[axis] = {white, white * std::exp(p.ratio)};
    }
    std::vector<Rungs> rungs;
    for (const Stretch& s : stretches) {
      const Steps steps(s, time_scale * std::exp(p.time), time_scale * std::exp(p.memory), p.growth / kLengthScale);
      for (const Rungs& axis : rung_likelihoods(s, steps, noise)) rungs.push_back(axis);
    }
    const std::vector<double> each = averaged_over_ladder(rungs);
    std::vector<double> sums;
    for (std::size_t i = 0; i < each.size(); i += 3) sums.push_back(each[i] + each[i + 1] + each[i + 2]);
    return sums;
  }

  /// Maximum over the numbers that `place` writes into the point; the others stay as they are.
  template <class Place>
  Fit fit(const std::vector<Stretch>& stretches, const Place& place, const std::vector<FitParameter>& parameters, Errors errors) {
    const LogLikelihood groups = [&](const std::vector<double>& x) {
      NoisePoint p = point;
      place(x, p);
      return likelihoods(stretches, p);
    };
    Fit found = errors == Errors::wanted ? maximise(groups, parameters) : likeliest(groups, parameters);
    place(found.value, point);
    return found;
  }

  void fit_shape(Errors errors) {
    const auto place_white = [](const std::vector<double>& x, NoisePoint& q) { q.white = {x[0], x[0], x[0]}; };
    const auto place_all = [](const std::vector<double>& x, NoisePoint& q) {
      q.white = {x[0], x[0], x[0]};
      q.ratio = x[1];
      q.time = x[2];
    };
    const NoisePoint before = point;
    point.ratio = kNoCorrelation;
    const Fit plain = fit(quiet, place_white, {{before.white[0], -6, 4}}, Errors::none);
    point = before;
    point.ratio = std::max(point.ratio, -1.0);
    const FitParameter time{point.time, std::log(0.1), std::log(4), kUsualTime, kTimeDeviation};
    shape = fit(quiet, place_all, {{point.white[0], -6, 4}, {point.ratio, -4, 2}, time}, errors);
    // Left out only where it explains nothing at all, or fades before the next location comes, which makes it white: leaving a weak one
    // out would make the whole too small. The scale of time is two intervals.
    const double lasts = std::exp(-0.5 / std::exp(point.time));
    if (shape.log_likelihood - plain.log_likelihood < kNothing || lasts < 0.05) point.ratio = kNoCorrelation;
  }

  void fit_size(Errors errors) {
    size = fit(
        all,
        [](const std::vector<double>& x, NoisePoint& q) {
          q.white = {x[0], x[1], x[2]};
          q.growth = x[3];
          q.memory = x[4];
        },
        {{point.white[0], -6, 4},
         {point.white[1], -6, 4},
         {point.white[2], -6, 4},
         {point.growth, 0, 50},
         {point.memory, std::log(0.1), std::log(20)}},
        errors);
  }
};

Estimated of_logarithm(double scale, double logarithm, double variance) {
  const double value = scale * std::exp(logarithm);
  return {value, kCaution * value * std::sqrt(variance)};
}

/// Deviation of both parts, mean square over the axes, at distance d.
Estimated total_at(double d, const Estimator& e) {
  const NoisePoint& p = e.point;
  double square = 0;
  for (const double w : p.white) square += std::exp(2 * w) / 3;
  const double ratio = std::exp(2 * p.ratio), factor = 1 + p.growth / kLengthScale * d;
  const double value = kWhiteScale * std::sqrt(square * (1 + ratio)) * factor;
  // Relative derivatives: to ln white of each axis, to growth, to ln ratio.
  std::array<double, 4> slope{};
  for (std::size_t axis = 0; axis < 3; ++axis) slope[axis] = std::exp(2 * p.white[axis]) / (3 * square);
  slope[3] = d / kLengthScale / factor;
  double variance = p.ratio > kNoCorrelation ? std::pow(ratio / (1 + ratio), 2) * e.shape.covariance[1][1] : 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) variance += slope[i] * e.size.covariance[i][j] * slope[j];
  }
  return {value, kCaution * value * std::sqrt(variance)};
}

CameraNoise result_of(const Estimator& e) {
  CameraNoise r;
  const NoisePoint& p = e.point;
  const bool correlated = p.ratio > kNoCorrelation;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double variance = e.size.covariance[axis][axis];
    r.white[axis] = of_logarithm(kWhiteScale, p.white[axis], variance);
    if (correlated) r.correlated[axis] = of_logarithm(kWhiteScale, p.white[axis] + p.ratio, variance + e.shape.covariance[1][1]);
  }
  if (correlated) r.correlation_time = of_logarithm(e.time_scale, p.time, e.shape.covariance[2][2]);
  r.growth = {p.growth / kLengthScale, kCaution * e.size.error(3) / kLengthScale};
  std::vector<double> distances;
  for (const Stretch& s : e.all) distances.insert(distances.end(), s.distance.begin(), s.distance.end());
  r.near = base::quantile(distances, 0.05);
  r.far = base::quantile(distances, 0.95);
  r.total_near = total_at(r.near, e);
  r.total_far = total_at(r.far, e);
  r.stretches = e.all.size();
  return r;
}

}  // namespace

CameraNoise estimate_camera_noise(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most_stretches) {
  Estimator e{
      stretches_over(recording, middle, pause, most_stretches), quiet_stretches(recording, middle, pause, most_stretches), 0, {}, {}, {}};
  const std::vector<double>& times = e.all[e.all.size() / 2].time;
  e.time_scale = 2 * times.back() / static_cast<double>(times.size());
  for (const Errors errors : {Errors::none, Errors::wanted}) {  // the shape needs the growth, the growth the shape
    e.fit_shape(errors);
    e.fit_size(errors);
  }
  return result_of(e);
}

}  // namespace millscope::camera
