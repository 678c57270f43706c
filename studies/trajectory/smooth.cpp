// The smoothing spline as the mean of a random motion: dv = √q dW, dx = v dt, seen with white noise. Over a step h the state (x, v) goes by
//   F = [1 h; 0 1],   Q = q M,   M = [h³/3 h²/2; h²/2 h]
// A filter forward and a smoother backward (Rauch, Tung, Striebel 1965) give mean and covariance at the knots in O(n). The three
// coordinates go side by side: their chains of divisions do not wait for one another.
#include <cmath>

#include "studies/trajectory/pieces.hpp"

namespace millscope::trajectory {
namespace {

constexpr double kFastest = 10;  // m/s, standard deviation of the velocity before anything is seen: wide for any mill

struct State {
  double x, v, xx, xv, vv;
};

State begin(double y, double variance) { return {y, 0, variance, 0, kFastest * kFastest}; }

State predict(const State& s, double h, double q) {
  return {s.x + h * s.v, s.v, s.xx + h * (2 * s.xv + h * s.vv) + q * h * h * h / 3, s.xv + h * s.vv + q * h * h / 2, s.vv + q * h};
}

/// Takes in a point that lies `innovation` from the prediction, with variance `total`.
State update(const State& s, double innovation, double total) {
  const double weight = 1 / total, gain_x = s.xx * weight, gain_v = s.xv * weight;
  return {s.x + gain_x * innovation, s.v + gain_v * innovation, s.xx * (1 - gain_x), s.xv * (1 - gain_x), s.vv - gain_v * s.xv};
}

State lane(const Knot& knot, std::size_t k) { return {knot.x[k], knot.v[k], knot.xx[k], knot.xv[k], knot.vv[k]}; }

void set_lane(Knot& knot, std::size_t k, const State& s) {
  knot.x[k] = s.x;
  knot.v[k] = s.v;
  knot.xx[k] = s.xx;
  knot.xv[k] = s.xv;
  knot.vv[k] = s.vv;
}

/// One step backward of one coordinate, from the smoothed state `after` to the filtered `here`. With λ = (P⁻)⁻¹(x − x⁻) and
/// Λ = (P⁻)⁻¹(P⁻ − P)(P⁻)⁻¹ behind the step the likelihood's slope with respect to q is ½[λᵀMλ − tr(MΛ)].
State step_back(const State& here, const State& after, double h, double q, Between& between, Evidence& evidence) {
  const State ahead = predict(here, h, q);
  const double inverse = 1 / (ahead.xx * ahead.vv - ahead.xv * ahead.xv);
  const double i00 = ahead.vv * inverse, i01 = -ahead.xv * inverse, i11 = ahead.xx * inverse;  // (P⁻)⁻¹
  const double dx = after.x - ahead.x, dv = after.v - ahead.v;
  const double lx = i00 * dx + i01 * dv, lv = i01 * dx + i11 * dv;  // λ
  const double g00 = ahead.xx - after.xx, g01 = ahead.xv - after.xv, g11 = ahead.vv - after.vv;
  const double r00 = i00 * g00 + i01 * g01, r01 = i00 * g01 + i01 * g11, r10 = i01 * g00 + i11 * g01, r11 = i01 * g01 + i11 * g11;
  const double l00 = r00 * i00 + r01 * i01, l01 = r00 * i01 + r01 * i11, l11 = r10 * i01 + r11 * i11;  // Λ
  const double m00 = h * h * h / 3, m01 = h * h / 2;
  evidence.found += q * (m00 * lx * lx + 2 * m01 * lx * lv + h * lv * lv);
  evidence.expected += q * (m00 * l00 + 2 * m01 * l01 + h * l11);
  const double a = here.xx + h * here.xv, b = here.xv, c = here.xv + h * here.vv, d = here.vv;  // P Fᵀ
  const double gain00 = a * i00 + b * i01, gain01 = a * i01 + b * i11, gain10 = c * i00 + d * i01, gain11 = c * i01 + d * i11;
  between.xx += gain00 * after.xx + gain01 * after.xv;
  between.xv += gain00 * after.xv + gain01 * after.vv;
  between.vx += gain10 * after.xx + gain11 * after.xv;
  between.vv += gain10 * after.xv + gain11 * after.vv;
  between.roughness += q;
  return {here.x + a * lx + b * lv, here.v + c * lx + d * lv, here.xx - (a * a * l00 + 2 * a * b * l01 + b * b * l11),
          here.xv - (a * c * l00 + (a * d + b * c) * l01 + b * d * l11), here.vv - (c * c * l00 + 2 * c * d * l01 + d * d * l11)};
}

}  // namespace

double misfit(const Points& points, std::size_t axis, double noise, double roughness) {
  const double variance = noise * noise;
  const double* y = points.position[axis];
  State s = begin(y[0], variance);
  double sum = 0, product = 1;
  for (std::size_t i = 1; i < points.count; ++i) {
    s = predict(s, points.time[i] - points.time[i - 1], roughness);
    const double innovation = y[i] - s.x, total = s.xx + variance;
    s = update(s, innovation, total);
    if (i == 1) continue;  // says nothing: the velocity was unknown
    sum += innovation * innovation / total;
    product *= total / variance;
    if (product > 1e200) sum += std::log(product), product = 1;  // one logarithm for many points
  }
  return sum + std::log(product) + static_cast<double>(points.count - 2) * 2 * std::log(noise);
}

void smooth(const Points& points, const Lanes& noise, const Lanes& roughness, const std::vector<double>& factor, Spline& spline,
            std::vector<Evidence>& evidence) {
  const std::size_t count = points.count;
  spline.knots.resize(count);
  spline.between.assign(count - 1, {});
  evidence.assign(count - 1, {});
  std::array<State, 3> state;
  for (std::size_t k = 0; k < 3; ++k) set_lane(spline.knots[0], k, state[k] = begin(points.position[k][0], noise[k] * noise[k]));
  for (std::size_t i = 1; i < count; ++i) {
    const double h = points.time[i] - points.time[i - 1], f = factor[i - 1];
    for (std::size_t k = 0; k < 3; ++k) {
      const State ahead = predict(state[k], h, f * roughness[k]);
      state[k] = update(ahead, points.position[k][i] - ahead.x, ahead.xx + noise[k] * noise[k]);
      set_lane(spline.knots[i], k, state[k]);
    }
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    const double h = points.time[i + 1] - points.time[i];
    for (std::size_t k = 0; k < 3; ++k) {
      state[k] = step_back(lane(spline.knots[i], k), state[k], h, factor[i] * roughness[k], spline.between[i], evidence[i]);
      set_lane(spline.knots[i], k, state[k]);
    }
  }
}

}  // namespace millscope::trajectory
