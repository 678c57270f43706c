// The smoothing spline as the mean of a random motion: dv = √q dW, dx = v dt, seen with white noise. Over a step h the state (x, v) goes by
//   F = [1 h; 0 1],   Q = q M,   M = [h³/3 h²/2; h²/2 h]
// A filter forward and a smoother backward (Rauch, Tung, Striebel 1965) give mean and covariance at the knots in O(n).
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

/// A symmetric matrix of two rows.
struct Matrix {
  double a, b, c;  ///< [a b; b c]
};

Matrix sandwich(const Matrix& outer, const Matrix& inner) {  // outer · inner · outer
  const double r00 = outer.a * inner.a + outer.b * inner.b, r01 = outer.a * inner.b + outer.b * inner.c;
  const double r10 = outer.b * inner.a + outer.c * inner.b, r11 = outer.b * inner.b + outer.c * inner.c;
  return {r00 * outer.a + r01 * outer.b, r00 * outer.b + r01 * outer.c, r10 * outer.b + r11 * outer.c};
}

/// One step backward from knot i + 1, which is smoothed, to knot i. With λ = (P⁻)⁻¹(x − x⁻) and Λ = (P⁻)⁻¹(P⁻ − P)(P⁻)⁻¹ at knot i + 1 the
/// likelihood's slope with respect to q is ½[λᵀMλ − tr(MΛ)].
void step_back(double h, double q, std::size_t i, AxisSpline& spline, Evidence& evidence) {
  const State here{spline.position[i], spline.velocity[i], spline.variance[i]};
  const State ahead = predict(here, h, q);
  const double inverse = 1 / (ahead.p.position * ahead.p.velocity - ahead.p.mixed * ahead.p.mixed);
  const Matrix precision{ahead.p.velocity * inverse, -ahead.p.mixed * inverse, ahead.p.position * inverse};
  const StateVariance& after = spline.variance[i + 1];
  const Matrix gone{ahead.p.position - after.position, ahead.p.mixed - after.mixed, ahead.p.velocity - after.velocity};
  const double dx = spline.position[i + 1] - ahead.x, dv = spline.velocity[i + 1] - ahead.v;
  const double force_x = precision.a * dx + precision.b * dv, force_v = precision.b * dx + precision.c * dv;  // λ
  const Matrix taken = sandwich(precision, gone);                                                             // Λ
  const double cube = h * h * h / 3, square = h * h / 2;
  evidence.found = q * (cube * force_x * force_x + 2 * square * force_x * force_v + h * force_v * force_v);
  evidence.expected = q * (cube * taken.a + 2 * square * taken.b + h * taken.c);
  // Gain G = P Fᵀ (P⁻)⁻¹; P Fᵀ = [a b; c d].
  const double a = here.p.position + h * here.p.mixed, b = here.p.mixed, c = here.p.mixed + h * here.p.velocity, d = here.p.velocity;
  spline.position[i] = here.x + a * force_x + b * force_v;
  spline.velocity[i] = here.v + c * force_x + d * force_v;
  spline.variance[i] = {here.p.position - (a * a * taken.a + 2 * a * b * taken.b + b * b * taken.c),
                        here.p.mixed - (a * c * taken.a + (a * d + b * c) * taken.b + b * d * taken.c),
                        here.p.velocity - (c * c * taken.a + 2 * c * d * taken.b + d * d * taken.c)};
  const double g00 = a * precision.a + b * precision.b, g01 = a * precision.b + b * precision.c;
  const double g10 = c * precision.a + d * precision.b, g11 = c * precision.b + d * precision.c;
  spline.cross[i] = {g00 * after.position + g01 * after.mixed, g00 * after.mixed + g01 * after.velocity,
                     g10 * after.position + g11 * after.mixed, g10 * after.mixed + g11 * after.velocity};
}

}  // namespace

double misfit(const double* time, const double* value, std::size_t count, double noise, double roughness) {
  State s = begin(value[0], noise);
  double sum = 0, product = 1;
  for (std::size_t i = 1; i < count; ++i) {
    double square, spread;
    s = update(predict(s, time[i] - time[i - 1], roughness), value[i], noise, square, spread);
    if (i == 1) continue;  // says nothing: the velocity was unknown
    sum += square;
    product *= spread / (noise * noise);
    if (product > 1e200) sum += std::log(product), product = 1;  // a logarithm for many points
  }
  return sum + std::log(product) + static_cast<double>(count - 2) * 2 * std::log(noise);
}

void smooth(const double* time, const double* value, double noise, const std::vector<double>& roughness, AxisSpline& spline,
            std::vector<Evidence>& evidence) {
  const std::size_t count = roughness.size() + 1;
  spline.position.resize(count);
  spline.velocity.resize(count);
  spline.variance.resize(count);
  spline.cross.resize(count - 1);
  spline.roughness = roughness;
  evidence.resize(count - 1);
  State s = begin(value[0], noise);
  for (std::size_t i = 0; i < count; ++i) {
    double square, spread;
    if (i > 0) s = update(predict(s, time[i] - time[i - 1], roughness[i - 1]), value[i], noise, square, spread);
    spline.position[i] = s.x;
    spline.velocity[i] = s.v;
    spline.variance[i] = s.p;
  }
  for (std::size_t i = count - 1; i-- > 0;) step_back(time[i + 1] - time[i], roughness[i], i, spline, evidence[i]);
}

}  // namespace millscope::studies
