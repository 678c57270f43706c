// The smoothing spline as the mean of a random motion: dv = √q dW, dx = v dt, seen with white noise. Over a step h the state (x, v) goes by
//   F = [1 h; 0 1],   Q = q M,   M = [h³/3 h²/2; h²/2 h]
// A filter forward and a smoother backward (Rauch, Tung, Striebel 1965) give mean and covariance at the knots in O(n). The three
// coordinates go side by side in one vector of four, whose last lane repeats the third: each lane has the bits that it would have alone.
#include <cmath>

#include "studies/trajectory/pieces.hpp"

namespace millscope::trajectory {
namespace {

constexpr double kFastest = 10;  // m/s, standard deviation of the velocity before anything is seen: wide for any mill

typedef double Four __attribute__((vector_size(4 * sizeof(double))));

Four four(const Lanes& lanes) { return Four{lanes[0], lanes[1], lanes[2], lanes[2]}; }
Four at(const Points& points, std::size_t i) {
  return Four{points.position[0][i], points.position[1][i], points.position[2][i], points.position[2][i]};
}
Lanes lanes(const Four& v) { return {v[0], v[1], v[2]}; }
double sum(const Four& v) { return v[0] + v[1] + v[2]; }

struct State {
  Four x, v, xx, xv, vv;
};

State begin(const Four& y, const Four& variance) {
  const Four zero{};
  return {y, zero, variance, zero, zero + kFastest * kFastest};
}

State predict(const State& s, double h, const Four& q) {
  return {s.x + h * s.v, s.v, s.xx + h * (2.0 * s.xv + h * s.vv) + q * h * h * h / 3.0, s.xv + h * s.vv + q * h * h / 2.0, s.vv + q * h};
}

/// Takes in a point that lies `innovation` from the prediction, with variance `total`.
State update(const State& s, const Four& innovation, const Four& total) {
  const Four weight = 1.0 / total, gain_x = s.xx * weight, gain_v = s.xv * weight;
  return {s.x + gain_x * innovation, s.v + gain_v * innovation, s.xx * (1.0 - gain_x), s.xv * (1.0 - gain_x), s.vv - gain_v * s.xv};
}

Knot knot_of(const State& s) { return {lanes(s.x), lanes(s.v), lanes(s.xx), lanes(s.xv), lanes(s.vv)}; }

/// One step backward, from the smoothed state `after` to the filtered `here`. With λ = (P⁻)⁻¹(x − x⁻) and
/// Λ = (P⁻)⁻¹(P⁻ − P)(P⁻)⁻¹ behind the step the likelihood's slope with respect to q is ½[λᵀMλ − tr(MΛ)].
State step_back(const State& here, const State& after, double h, const Four& q, Between& between, Evidence& evidence) {
  const State ahead = predict(here, h, q);
  const Four inverse = 1.0 / (ahead.xx * ahead.vv - ahead.xv * ahead.xv);
  const Four i00 = ahead.vv * inverse, i01 = -ahead.xv * inverse, i11 = ahead.xx * inverse;  // (P⁻)⁻¹
  const Four dx = after.x - ahead.x, dv = after.v - ahead.v;
  const Four lx = i00 * dx + i01 * dv, lv = i01 * dx + i11 * dv;  // λ
  const Four g00 = ahead.xx - after.xx, g01 = ahead.xv - after.xv, g11 = ahead.vv - after.vv;
  const Four r00 = i00 * g00 + i01 * g01, r01 = i00 * g01 + i01 * g11, r10 = i01 * g00 + i11 * g01, r11 = i01 * g01 + i11 * g11;
  const Four l00 = r00 * i00 + r01 * i01, l01 = r00 * i01 + r01 * i11, l11 = r10 * i01 + r11 * i11;  // Λ
  const double m00 = h * h * h / 3, m01 = h * h / 2;
  evidence = {sum(q * (m00 * lx * lx + 2 * m01 * lx * lv + h * lv * lv)), sum(q * (m00 * l00 + 2 * m01 * l01 + h * l11))};
  const Four a = here.xx + h * here.xv, b = here.xv, c = here.xv + h * here.vv, d = here.vv;  // P Fᵀ
  const Four gain00 = a * i00 + b * i01, gain01 = a * i01 + b * i11, gain10 = c * i00 + d * i01, gain11 = c * i01 + d * i11;
  between = {sum(gain00 * after.xx + gain01 * after.xv), sum(gain00 * after.xv + gain01 * after.vv),
             sum(gain10 * after.xx + gain11 * after.xv), sum(gain10 * after.xv + gain11 * after.vv), sum(q)};
  return {here.x + a * lx + b * lv, here.v + c * lx + d * lv, here.xx - (a * a * l00 + 2.0 * a * b * l01 + b * b * l11),
          here.xv - (a * c * l00 + (a * d + b * c) * l01 + b * d * l11), here.vv - (c * c * l00 + 2.0 * c * d * l01 + d * d * l11)};
}

}  // namespace

Lanes misfit(const Points& points, const Lanes& noise, const Lanes& roughness) {
  const Four sigma = four(noise), variance = sigma * sigma, q = four(roughness);
  State s = begin(at(points, 0), variance);
  Four sum{}, product = sum + 1.0;
  for (std::size_t i = 1; i < points.count; ++i) {
    s = predict(s, points.time[i] - points.time[i - 1], q);
    const Four innovation = at(points, i) - s.x, total = s.xx + variance;
    s = update(s, innovation, total);
    if (i == 1) continue;  // says nothing: the velocity was unknown
    sum += innovation * innovation / total;
    product *= total / variance;
    for (std::size_t k = 0; k < 3; ++k) {
      if (product[k] > 1e200) sum[k] += std::log(product[k]), product[k] = 1;  // one logarithm for many points
    }
  }
  Lanes all;
  for (std::size_t k = 0; k < 3; ++k)
    all[k] = sum[k] + std::log(product[k]) + static_cast<double>(points.count - 2) * 2 * std::log(noise[k]);
  return all;
}

void smooth(const Points& points, const Lanes& noise, const Lanes& roughness, const std::vector<double>& factor, Spline& spline,
            std::vector<Evidence>& evidence) {
  const std::size_t count = points.count;
  const Four sigma = four(noise), variance = sigma * sigma, q = four(roughness);
  spline.knots.resize(count);
  spline.between.resize(count - 1);
  evidence.resize(count - 1);
  thread_local std::vector<State> filtered;
  filtered.resize(count);
  State state = filtered[0] = begin(at(points, 0), variance);
  for (std::size_t i = 1; i < count; ++i) {
    const State ahead = predict(state, points.time[i] - points.time[i - 1], factor[i - 1] * q);
    state = filtered[i] = update(ahead, at(points, i) - ahead.x, ahead.xx + variance);
  }
  spline.knots[count - 1] = knot_of(state);
  for (std::size_t i = count - 1; i-- > 0;) {
    state = step_back(filtered[i], state, points.time[i + 1] - points.time[i], factor[i] * q, spline.between[i], evidence[i]);
    spline.knots[i] = knot_of(state);
  }
}

}  // namespace millscope::trajectory
