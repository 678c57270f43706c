// How the rate of locations falls with distance and speed: a Poisson regression over short windows of the bead's own trajectory.
//
//   λ(d, v) = λ_0 Φ(a − b d − c v),   count in a window of length h ~ Poisson(λ h)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/camera/estimate_parts.hpp"
#include "studies/camera/maximise.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::camera {
namespace {

constexpr double kWindow = 0.02;  // s
constexpr double kGroup = 0.5;    // s: windows farther apart count as independent
constexpr double kNoLoss = 12;    // far beyond what counts can tell
constexpr double kFirstLoss = 2.5;
/// Known beforehand: a bead at rest in the middle is seldom lost. Without that, a camera that loses everywhere alike looks like a slow one.
constexpr double kUsualMargin = 3.5, kMarginDeviation = 1.5, kFixed = 0.1;
constexpr double kTellingError = 0.25;  // relative, of the rate

double normal_share(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

void add_windows(const trajectory::Piece& piece, const std::vector<double>& times, const Middle& middle, std::size_t& group,
                 std::vector<RateWindow>& out) {
  const auto per_window = std::lround(kWindow / piece.step);
  const auto windows_in_group = std::lround(kGroup / kWindow);
  std::size_t made = 0;
  for (std::size_t first = 0; first + per_window < piece.size(); first += per_window, ++made) {
    const double from = piece.start + static_cast<double>(first) * piece.step;
    RateWindow w{kWindow, 0, 0, 0, group + made / windows_in_group};
    w.count = static_cast<double>(std::lower_bound(times.begin(), times.end(), from + kWindow) -
                                  std::lower_bound(times.begin(), times.end(), from));
    for (std::size_t k = first; k < first + per_window; ++k) {
      const double share = 1 / static_cast<double>(per_window);
      w.distance += share * middle.distance(piece.position[0][k], piece.position[1][k], piece.position[2][k]);
      w.speed += share * std::hypot(piece.velocity[0][k], piece.velocity[1][k], piece.velocity[2][k]);
    }
    out.push_back(w);
  }
  group += made / windows_in_group + 1;
}

/// Sum of the Poisson log-likelihoods of each group's windows.
class Counts {
 public:
  Counts(const std::vector<RateWindow>& windows, double distance, double speed, double rate)
      : windows_(windows), distance_(distance), speed_(speed), rate_(rate), groups_(windows.back().group + 1) {}

  double rate_at(const std::vector<double>& p, const RateWindow& w) const {
    const double kept = p.size() > 1 ? normal_share(p[1] - p[2] * w.distance / distance_ - p[3] * w.speed / speed_) : 1.0;
    return rate_ * std::exp(p[0]) * std::max(kept, 1e-12);
  }
  std::vector<double> operator()(const std::vector<double>& p) const {
    std::vector<double> terms(groups_, 0.0);
    for (const RateWindow& w : windows_) {
      const double rate = rate_at(p, w);
      terms[w.group] += w.count * std::log(rate) - rate * w.seconds;
    }
    return terms;
  }

 private:
  const std::vector<RateWindow>& windows_;
  double distance_, speed_, rate_;
  std::size_t groups_;
};

}  // namespace

std::vector<RateWindow> rate_windows(const recording::Recording& recording, const Middle& middle, double pause) {
  std::vector<RateWindow> windows;
  std::size_t group = 0;
  for (const recording::Run& run : recording.runs) {
    trajectory::TrajectoryOptions options;
    options.gap_limit = pause;
    const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, options);
    for (const trajectory::Piece& piece : trajectory.pieces) add_windows(piece, trajectory.location_time, middle, group, windows);
  }
  if (windows.empty()) {
    throw base::UserError(
        fmt::format("{}: no {:.0f} ms without a pause of {:.3g} s; the rate of locations is told from such spans; give a recording whose "
                    "locations do not come in short bursts",
                    recording.file.string(), 1e3 * kWindow, pause));
  }
  return windows;
}

RateModel estimate_rate(const std::vector<RateWindow>& windows) {
  std::vector<double> distances, speeds;
  double count = 0, seconds = 0;
  for (const RateWindow& w : windows) {
    distances.push_back(w.distance);
    speeds.push_back(w.speed);
    count += w.count;
    seconds += w.seconds;
  }
  const double distance = std::max(base::quantile(distances, 0.95), 1e-6), speed = std::max(base::quantile(speeds, 0.95), 1e-6),
               rate = count / seconds;
  const Counts counts(windows, distance, speed, rate);
  const Fit plain = maximise(counts, {{0, -1, 1}});
  const auto fit_with = [&](double deviation) {
    return maximise(counts, {{0.1, -1, 4}, {kFirstLoss, -3, kNoLoss, kUsualMargin, deviation}, {0.5, 0, 20}, {0.5, 0, 20}});
  };
  Fit fit = fit_with(kMarginDeviation);
  // A rate that falls evenly with distance tells the slope but neither the rate nor the loss in the middle: then what is usual holds.
  if (!(fit.error(0) < kTellingError)) fit = fit_with(kFixed);
  RateModel model;
  CameraLosses& loss = model.loss;
  // Three more parameters: χ² of 3 beyond 14.2 happens by chance in 0.3 % (as three standard errors do).
  loss.found = 2 * (fit.log_likelihood - plain.log_likelihood) > 14.2;
  const Fit& used = loss.found ? fit : plain;
  model.rate = {rate * std::exp(used.value[0]), rate * std::exp(used.value[0]) * used.error(0)};
  loss.typical_distance = base::quantile(distances, 0.5);
  if (loss.found) {
    loss.at_rest = {fit.value[1], kCaution * fit.error(1)};
    loss.per_distance = {fit.value[2] / distance, kCaution * fit.error(2) / distance};
    loss.per_speed = {fit.value[3] / speed, kCaution * fit.error(3) / speed};
  }
  std::vector<double> rates;
  for (const RateWindow& w : windows) rates.push_back(counts.rate_at(used.value, w));
  model.lowest_rate = base::quantile(rates, 0.005);
  return model;
}

void express_as_cut(CameraLosses& loss, const recording::Recording& recording, const Middle& middle,
                    const std::vector<RateWindow>& windows) {
  if (!loss.found) return;
  double highest = 0, sum = 0, number = 0, margin = 0, weight = 0;
  for (const recording::Run& run : recording.runs) {
    for (const double u : run.spread) highest = std::max(highest, u);
    for (std::size_t i = 0; i < run.spread.size(); ++i) {
      if (middle.distance(run, i) > 2 * loss.typical_distance) continue;
      sum += run.spread[i];
      number += 1;
    }
  }
  for (const RateWindow& w : windows) {
    if (w.distance > 2 * loss.typical_distance) continue;
    margin += w.count * (loss.at_rest.value - loss.per_distance.value * w.distance - loss.per_speed.value * w.speed);
    weight += w.count;
  }
  margin = weight > 0 ? margin / weight : 0;
  // u_max − u = s (a − b d − c v) on average. Without a column of spreads, or where a bead at rest in the middle would have u < 0 by it
  // (losses that the spread does not decide), s is 1 mm and such a bead has u = 1 mm: what is kept is the same.
  const double scale = (highest - sum / number) / margin;
  const bool known = highest > 0 && sum > 0 && scale > 0 && margin > 0.5 && highest > scale * loss.at_rest.value;
  loss.scatter = known ? scale : 1e-3;
  loss.cut = known ? highest : loss.scatter * std::max(loss.at_rest.value, 0.0) + 1e-3;
  loss.spread = loss.cut - loss.scatter * loss.at_rest.value;
  loss.spread_per_distance = loss.scatter * loss.per_distance.value;
  loss.spread_per_speed = loss.scatter * loss.per_speed.value;
}

}  // namespace millscope::camera
