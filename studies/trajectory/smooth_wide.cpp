// The smoothing spline as the mean of a random motion: dv = √q dW, dx = v dt, seen with white noise. Over a step h the state (x, v) goes by
//   F = [1 h; 0 1],   Q = q M,   M = [h³/3 h²/2; h²/2 h]
// A filter forward and a smoother backward (Rauch, Tung, Striebel 1965) give mean and covariance at the knots in O(n). The three
// coordinates go side by side in one vector of four, whose last lane repeats the third: each lane has the bits that it would have alone.
//
// Built once per instruction set: plain data in and out, so that no function that others share is compiled for a machine that is not there.
#include <cmath>

#include "studies/trajectory/smooth_wide.hpp"

namespace millscope::trajectory::MILLSCOPE_WIDE {
namespace {

constexpr double kFastest = 10;  // m/s, standard deviation of the velocity before anything is seen: wide for any mill

typedef double Four __attribute__((vector_size(4 * sizeof(double))));

Four four(const double* lanes) { return Four{lanes[0], lanes[1], lanes[2], lanes[2]}; }
Four at(const PointView& points, std::size_t i) { return Four{points.x[i], points.y[i], points.z[i], points.z[i]}; }
double sum(const Four& v) { return v[0] + v[1] + v[2]; }

struct State {
  Four x, v, xx, xv, vv;
};

State begin(const Four& y, const Four& variance) {
  const Four zero{};
  return {y, zero, variance, zero, zero + kFastest * kFastest};
}

State predict(const State& s, double h, const Four& q) {
  const double m01 = 0.5 * h * h, m00 = h * h * h * (1.0 / 3);
  const Four xv = s.xv + h * s.vv;
  return {s.x + h * s.v, s.v, s.xx + h * (s.xv + xv) + m00 * q, xv + m01 * q, s.vv + h * q};
}

/// A point, as seen from the prediction: how far off, the variance of that, and the inverse of the variance.
struct Innovation {
  Four value, variance, weight;
};
Innovation innovate(const State& ahead, const Four& y, const Four& variance) {
  const Four total = ahead.xx + variance;
  return {y - ahead.x, total, 1.0 / total};
}

/// Takes in that point, whose noise has the variance `noise`.
State update(const State& s, const Innovation& seen, const Four& noise) {
  const Four gain_x = s.xx * seen.weight, gain_v = s.xv * seen.weight;
  return {s.x + gain_x * seen.value, s.v + gain_v * seen.value, gain_x * noise, s.xv * (noise * seen.weight), s.vv - gain_v * s.xv};
}

/// Row by row: a copy of the whole goes by words, and waits until they are written.
void keep(const State& s, State& to) { to.x = s.x, to.v = s.v, to.xx = s.xx, to.xv = s.xv, to.vv = s.vv; }

void set_knot(const State& s, double* knot) {
  const Four* rows[5] = {&s.x, &s.v, &s.xx, &s.xv, &s.vv};
  for (int r = 0; r < 5; ++r) {
    for (int k = 0; k < 3; ++k) knot[3 * r + k] = (*rows[r])[k];
  }
}

/// What a point leaves, and the prediction of the next.
struct Filtered {
  State here, ahead;
};
static_assert(sizeof(Filtered) == kFilteredBytes);

/// One step backward, from the smoothed state `after` to the filtered one. With λ = (P⁻)⁻¹(x − x⁻) and
/// Λ = (P⁻)⁻¹(P⁻ − P)(P⁻)⁻¹ behind the step the likelihood's slope with respect to q is ½[λᵀMλ − tr(MΛ)].
State step_back(const Filtered& from, const State& after, double h, const Four& q, double* between, double* evidence) {
  const State &here = from.here, &ahead = from.ahead;
  const Four inverse = 1.0 / (ahead.xx * ahead.vv - ahead.xv * ahead.xv);
  const Four i00 = ahead.vv * inverse, i01 = -ahead.xv * inverse, i11 = ahead.xx * inverse;  // (P⁻)⁻¹
  const Four dx = after.x - ahead.x, dv = after.v - ahead.v;
  const Four lx = i00 * dx + i01 * dv, lv = i01 * dx + i11 * dv;  // λ
  const Four g00 = ahead.xx - after.xx, g01 = ahead.xv - after.xv, g11 = ahead.vv - after.vv;
  const Four r00 = i00 * g00 + i01 * g01, r01 = i00 * g01 + i01 * g11, r10 = i01 * g00 + i11 * g01, r11 = i01 * g01 + i11 * g11;
  const Four l00 = r00 * i00 + r01 * i01, l01 = r00 * i01 + r01 * i11, l11 = r10 * i01 + r11 * i11;  // Λ
  const double m00 = h * h * h * (1.0 / 3), m01 = 0.5 * h * h;
  if (evidence) {
    evidence[0] = sum(q * (m00 * lx * lx + 2 * m01 * lx * lv + h * lv * lv));
    evidence[1] = sum(q * (m00 * l00 + 2 * m01 * l01 + h * l11));
  }
  const Four a = here.xx + h * here.xv, b = here.xv, c = here.xv + h * here.vv, d = here.vv;  // P Fᵀ
  if (between) {
    const Four gain00 = a * i00 + b * i01, gain01 = a * i01 + b * i11, gain10 = c * i00 + d * i01, gain11 = c * i01 + d * i11;
    between[0] = sum(gain00 * after.xx + gain01 * after.xv);
    between[1] = sum(gain00 * after.xv + gain01 * after.vv);
    between[2] = sum(gain10 * after.xx + gain11 * after.xv);
    between[3] = sum(gain10 * after.xv + gain11 * after.vv);
    between[4] = sum(q);
  }
  const Four ax = a * l00 + b * l01, av = a * l01 + b * l11, cx = c * l00 + d * l01, cv = c * l01 + d * l11;
  return {here.x + a * lx + b * lv, here.v + c * lx + d * lv, here.xx - (a * ax + b * av), here.xv - (c * ax + d * av),
          here.vv - (c * cx + d * cv)};
}

}  // namespace

void misfit(const PointView& points, const double* noise, const double* roughness, double* found) {
  const Four sigma = four(noise), variance = sigma * sigma, per_variance = 1.0 / variance, q = four(roughness);
  State s = begin(at(points, 0), variance);
  Four sum{}, product = sum + 1.0;
  for (std::size_t i = 1; i < points.count; ++i) {
    const State ahead = predict(s, points.time[i] - points.time[i - 1], q);
    const Innovation seen = innovate(ahead, at(points, i), variance);
    s = update(ahead, seen, variance);
    if (i == 1) continue;  // says nothing: the velocity was unknown
    sum += seen.value * seen.value * seen.weight;
    product *= seen.variance * per_variance;
    for (int k = 0; k < 3; ++k) {
      if (product[k] > 1e80) sum[k] += std::log(product[k]), product[k] = 1;  // one logarithm for many points
    }
  }
  for (int k = 0; k < 3; ++k) found[k] = sum[k] + std::log(product[k]) + static_cast<double>(points.count - 2) * 2 * std::log(noise[k]);
}

void smooth(const PointView& points, const Noise& by, void* scratch, SplineView spline) {
  const std::size_t count = points.count;
  const Four sigma = four(by.noise), variance = sigma * sigma, q = four(by.roughness);
  Filtered* const filtered = static_cast<Filtered*>(scratch);
  State state = begin(at(points, 0), variance);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const State ahead = predict(state, points.time[i + 1] - points.time[i], by.factor[i] * q);
    keep(state, filtered[i].here);
    keep(ahead, filtered[i].ahead);
    state = update(ahead, innovate(ahead, at(points, i + 1), variance), variance);
  }
  if (spline.knots) set_knot(state, spline.knots + kKnot * (count - 1));
  for (std::size_t i = count - 1; i-- > 0;) {
    const double h = points.time[i + 1] - points.time[i];
    double* const between = spline.knots ? spline.between + kBetween * i : nullptr;
    double* const evidence = spline.knots ? nullptr : spline.evidence + kEvidence * i;
    state = step_back(filtered[i], state, h, by.factor[i] * q, between, evidence);
    if (between) set_knot(state, spline.knots + kKnot * i);
  }
}

}  // namespace millscope::trajectory::MILLSCOPE_WIDE
