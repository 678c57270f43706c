#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "millscope/random.hpp"
#include "studies/inspect/circles.hpp"

namespace millscope::inspect {
namespace {

constexpr double kOuter = 0.75;  // of the enclosing radius: where windows count as support

double enclosing_radius(const std::vector<double>& x, const std::vector<double>& y, double cx, double cy, std::vector<double>& scratch) {
  scratch.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) scratch[i] = (x[i] - cx) * (x[i] - cx) + (y[i] - cy) * (y[i] - cy);
  return std::sqrt(base::quantile(scratch, 0.99));
}

std::size_t count_support(const std::vector<Parabola>& windows, const Rotation& r, double noise) {
  const double least = kOuter * r.circle.radius;
  std::size_t support = 0;
  for (const Parabola& w : windows) {
    const double dx = w.position[0] - r.circle.x, dy = w.position[1] - r.circle.y, square = dx * dx + dy * dy;
    if (square < least * least) continue;
    const double ex = w.velocity[0] + r.angular_velocity * dy, ey = w.velocity[1] - r.angular_velocity * dx;
    const double turning = std::fabs(r.angular_velocity) * std::sqrt(square), uncertain = 2 * noise * w.velocity_per_noise;
    if (uncertain > 0.2 * turning) continue;  // noise could turn so
    const double tolerance = 0.03 * turning + uncertain;
    support += ex * ex + ey * ey < tolerance * tolerance;
  }
  return support;
}

// v = Ω ẑ × (x − c) through two windows: Ω from the difference, c from the mean.
std::optional<Rotation> through(const Parabola& a, const Parabola& b, double least_distance) {
  const double dx = b.position[0] - a.position[0], dy = b.position[1] - a.position[1], square = dx * dx + dy * dy;
  if (square < least_distance * least_distance) return std::nullopt;
  Rotation r;
  r.angular_velocity = (dx * (b.velocity[1] - a.velocity[1]) - dy * (b.velocity[0] - a.velocity[0])) / square;
  if (!(std::fabs(r.angular_velocity) > 1e-3)) return std::nullopt;
  r.circle.x = 0.5 * (a.position[0] + b.position[0]) - 0.5 * (a.velocity[1] + b.velocity[1]) / r.angular_velocity;
  r.circle.y = 0.5 * (a.position[1] + b.position[1]) + 0.5 * (a.velocity[0] + b.velocity[0]) / r.angular_velocity;
  return r;
}

// Histogram of the distances from a centre.
class Distances {
 public:
  Distances(double bin, std::size_t bins) : bin_(bin), count_(bins) {}

  void fill(const PlanePoints& points, const std::vector<double>& weights, double cx, double cy) {
    std::fill(count_.begin(), count_.end(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double dx = points.x[i] - cx, dy = points.y[i] - cy, r = std::sqrt(dx * dx + dy * dy) / bin_;
      if (r < static_cast<double>(count_.size())) count_[static_cast<std::size_t>(r)] += weights.empty() ? 1 : weights[i];
    }
  }

  // Largest score over radii, and its radius.
  std::pair<double, double> best(double scale) const {
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4 * scale / bin_));
    const auto bins = static_cast<std::ptrdiff_t>(count_.size());
    std::vector<double> gain;  // of a point k bins from the radius, k = −reach … reach
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const double e = static_cast<double>(k) * bin_ / scale, near = std::exp(-0.5 * e * e);
      gain.push_back(near - (k > 0 ? 10 * (1 - near) : 0));
    }
    double beyond_all = 0;  // weight farther than `reach` beyond the radius
    for (std::ptrdiff_t k = reach; k < bins; ++k) beyond_all += count_[k];
    std::pair<double, double> result{-1e300, 0};
    for (std::ptrdiff_t j = 0; j < bins; ++j) {
      if (j + reach < bins) beyond_all -= count_[j + reach];
      double score = -10 * (j + reach + 1 <= bins ? beyond_all : 0);
      for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, j - reach); k <= std::min(bins - 1, j + reach); ++k) {
        score += count_[k] * gain[k - j + reach];
      }
      if (score > result.first) result = {score, (static_cast<double>(j) + 0.5) * bin_};
    }
    return result;
  }

 private:
  double bin_;
  std::vector<double> count_;
};

}  // namespace

std::optional<Rotation> search_rotation(const std::vector<Parabola>& windows, const PlanePoints& points, double noise) {
  if (windows.size() < 20) return std::nullopt;
  std::vector<double> x, y, scratch;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 400);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    x.push_back(points.x[i]);
    y.push_back(points.y[i]);
  }
  std::vector<double> xs = x, ys = y;
  const double extent = std::max(base::quantile(xs, 0.99) - base::quantile(xs, 0.01), base::quantile(ys, 0.99) - base::quantile(ys, 0.01));
  Random random(1);
  std::optional<Rotation> best;
  for (int attempt = 0; attempt < 4000; ++attempt) {
    const auto i = random.below(windows.size()), j = random.below(windows.size());
    std::optional<Rotation> trial = through(windows[i], windows[j], 0.15 * extent);
    if (!trial) continue;
    trial->circle.radius = enclosing_radius(x, y, trial->circle.x, trial->circle.y, scratch);
    if (trial->circle.radius > 2 * extent) continue;
    trial->support = count_support(windows, *trial, noise);
    if (!best || trial->support > best->support) best = trial;
  }
  if (!best || best->support < 10) return std::nullopt;
  return best;
}

Circle touching_circle(const PlanePoints& points, const std::vector<double>& weights, const Circle& guess, double span, double scale) {
  constexpr int kSteps = 8;
  const double bin = scale / 4;
  Distances distances(bin, static_cast<std::size_t>(1.3 * guess.radius / bin));
  double best = -1e300;
  Circle result = guess;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double cx = guess.x + span * i / kSteps, cy = guess.y + span * j / kSteps;
      distances.fill(points, weights, cx, cy);
      const auto [score, radius] = distances.best(scale);
      if (score > best) {
        best = score;
        result = {cx, cy, radius};
      }
    }
  }
  return result;
}

Circle ridge_circle(const PlanePoints& points, const std::vector<double>& weights, const Circle& start, double scale) {
  Circle circle = start;
  for (int pass = 0; pass < 30; ++pass) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double dx = points.x[i] - circle.x, dy = points.y[i] - circle.y, r = std::sqrt(dx * dx + dy * dy), e = r - circle.radius;
      const double weight = (weights.empty() ? 1 : weights[i]) * std::exp(-0.5 * e * e / (scale * scale));
      if (weight == 0 || r == 0) continue;
      const Eigen::Vector3d slope(-dx / r, -dy / r, -1);
      normal += weight * slope * slope.transpose();
      right -= weight * e * slope;
    }
    const Eigen::Vector3d step = normal.ldlt().solve(right).cwiseMax(-scale).cwiseMin(scale);
    circle.x += step[0];
    circle.y += step[1];
    circle.radius += step[2];
    if (step.cwiseAbs().maxCoeff() < 1e-6) break;
  }
  return circle;
}

}  // namespace millscope::inspect
