// The smoothing spline as the mean of a random motion: dv = √q dW, dx = v dt, seen with white noise. Over a step h the state (x, v) goes by
//   F = [1 h; 0 1],   Q = q [h³/3 h²/2; h²/2 h]
// A filter forward and a smoother backward (Rauch, Tung, Striebel 1965) give mean and covariance at the knots in O(n).
#include <algorithm>
#include <cmath>

#include "studies/trajectory/pieces.hpp"

namespace millscope::studies {
namespace {

constexpr double kFastest = 10;  // m/s, standard deviation of the velocity before anything is seen: wide for any mill

struct State {
  double x, v;
  StateVariance p;
};

State predict(const State& s, double h, double q) {
  State next{s.x + h * s.v, s.v, s.p};
  next.p.position += h * (2 * s.p.mixed + h * s.p.velocity) + q * h * h * h / 3;
  next.p.mixed += h * s.p.velocity + q * h * h / 2;
  next.p.velocity += q * h;
  return next;
}

State begin(double y, double noise) { return {y, 0, {noise * noise, 0, kFastest * kFastest}}; }

/// Takes in the point y; `square` = innovation²/S and `spread` = S feed the likelihood.
State update(const State& s, double y, double noise, double& square, double& spread) {
  const double total = s.p.position + noise * noise, innovation = y - s.x;
  const double gain_x = s.p.position / total, gain_v = s.p.mixed / total;
  square = innovation * innovation / total;
  spread = total;
  return {s.x + gain_x * innovation,
          s.v + gain_v * innovation,
          {s.p.position * (1 - gain_x), s.p.mixed * (1 - gain_x), s.p.velocity - gain_v * s.p.mixed}};
}

/// −2 log likelihood of some stretches, without constants.
double misfit(const Run& run, std::size_t axis, const std::vector<Span>& spans, double noise, double q) {
  double sum = 0;
  for (const Span& span : spans) {
    State s = begin(run.position[axis][span.first], noise);
    for (std::size_t i = span.first + 1; i < span.last; ++i) {
      double square, spread;
      s = update(predict(s, run.time[i] - run.time[i - 1], q), run.position[axis][i], noise, square, spread);
      if (i > span.first + 1) sum += square + std::log(spread);
    }
  }
  return sum;
}

/// Some stretches spread evenly over the run.
std::vector<Span> sample_of(const std::vector<Span>& spans) {
  constexpr std::size_t kLongest = 500, kPoints = 20000;
  std::vector<Span> cut;
  std::size_t total = 0;
  for (const Span& span : spans) {
    for (std::size_t first = span.first; first + 6 <= span.last; first += kLongest) {
      cut.push_back({first, std::min(first + kLongest, span.last)});
      total += cut.back().size();
    }
  }
  const std::size_t stride = total / kPoints + 1;
  std::vector<Span> chosen;
  for (std::size_t k = 0; k < cut.size(); k += stride) chosen.push_back(cut[k]);
  return chosen;
}

}  // namespace

double likely_roughness(const Run& run, std::size_t axis, const std::vector<Span>& spans, double noise) {
  const std::vector<Span> sample = sample_of(spans);
  // Golden section over log q; from motion that stands still to a full reversal at 10 m/s in every millisecond.
  double low = std::log(1e-8), high = std::log(1e5);
  constexpr double kGolden = 0.6180339887498949;
  const auto cost = [&](double log_q) { return misfit(run, axis, sample, noise, std::exp(log_q)); };
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low), cost_a = cost(a), cost_b = cost(b);
  while (high - low > 0.02) {
    const bool left = cost_a < cost_b;
    (left ? high : low) = left ? b : a;
    if (left) {
      b = a, cost_b = cost_a;
      a = high - kGolden * (high - low), cost_a = cost(a);
    } else {
      a = b, cost_a = cost_b;
      b = low + kGolden * (high - low), cost_b = cost(b);
    }
  }
  return std::exp((low + high) / 2);
}

void smooth(const double* time, const double* value, std::size_t count, double noise, double roughness, AxisSpline& spline) {
  spline.position.resize(count);
  spline.velocity.resize(count);
  spline.variance.resize(count);
  spline.cross.resize(count - 1);
  spline.roughness = roughness;
  State s = begin(value[0], noise);
  for (std::size_t i = 0;; ++i) {
    double square, spread;
    if (i > 0) s = update(predict(s, time[i] - time[i - 1], roughness), value[i], noise, square, spread);
    spline.position[i] = s.x, spline.velocity[i] = s.v, spline.variance[i] = s.p;
    if (i + 1 == count) break;
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    const State here{spline.position[i], spline.velocity[i], spline.variance[i]};
    const double h = time[i + 1] - time[i];
    const State ahead = predict(here, h, roughness);
    const double det = ahead.p.position * ahead.p.velocity - ahead.p.mixed * ahead.p.mixed;
    // Gain G = P Fᵀ (P⁻)⁻¹.
    const double a = here.p.position + h * here.p.mixed, b = here.p.mixed, c = here.p.mixed + h * here.p.velocity, d = here.p.velocity;
    const double g00 = (a * ahead.p.velocity - b * ahead.p.mixed) / det, g01 = (b * ahead.p.position - a * ahead.p.mixed) / det;
    const double g10 = (c * ahead.p.velocity - d * ahead.p.mixed) / det, g11 = (d * ahead.p.position - c * ahead.p.mixed) / det;
    const StateVariance& after = spline.variance[i + 1];
    const double dx = spline.position[i + 1] - ahead.x, dv = spline.velocity[i + 1] - ahead.v;
    spline.position[i] = here.x + g00 * dx + g01 * dv;
    spline.velocity[i] = here.v + g10 * dx + g11 * dv;
    const StateVariance change{after.position - ahead.p.position, after.mixed - ahead.p.mixed, after.velocity - ahead.p.velocity};
    spline.variance[i] = {here.p.position + g00 * g00 * change.position + 2 * g00 * g01 * change.mixed + g01 * g01 * change.velocity,
                          here.p.mixed + g00 * g10 * change.position + (g00 * g11 + g01 * g10) * change.mixed + g01 * g11 * change.velocity,
                          here.p.velocity + g10 * g10 * change.position + 2 * g10 * g11 * change.mixed + g11 * g11 * change.velocity};
    spline.cross[i] = {g00 * after.position + g01 * after.mixed, g00 * after.mixed + g01 * after.velocity,
                       g10 * after.position + g11 * after.mixed, g10 * after.mixed + g11 * after.velocity};
  }
}

}  // namespace millscope::studies
