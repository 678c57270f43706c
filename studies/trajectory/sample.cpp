#include "studies/trajectory/sample.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::trajectory {
namespace {

using Weights = std::array<double, 4>;  // of position and velocity at the knot before and at the knot behind

/// The cubic of one coordinate between two knots, in powers of the time since the first. `per_h`: 1/s, of the interval.
struct Cubic {
  double c0, c1, c2, c3;
  Cubic(const Knot& before, const Knot& behind, std::size_t axis, double per_h) : c0(before.x[axis]), c1(before.v[axis]) {
    const double mean = (behind.x[axis] - c0) * per_h, v1 = behind.v[axis];
    c2 = (3 * mean - 2 * c1 - v1) * per_h;
    c3 = (c1 + v1 - 2 * mean) * (per_h * per_h);
  }
};

double sum(const Lanes& lanes) { return lanes[0] + lanes[1] + lanes[2]; }

/// Covariance of the states at both ends of an interval, summed over the coordinates.
struct Ends {
  double xx0, xv0, vv0, xx1, xv1, vv1;
  Between between;
  Ends(const Knot& p, const Knot& r, const Between& m)
      : xx0(sum(p.xx)), xv0(sum(p.xv)), vv0(sum(p.vv)), xx1(sum(r.xx)), xv1(sum(r.xv)), vv1(sum(r.vv)), between(m) {}
  double of(const Weights& w) const {
    const double diagonal = xx0 * w[0] * w[0] + vv0 * w[1] * w[1] + xx1 * w[2] * w[2] + vv1 * w[3] * w[3];
    const double beside =
        w[0] * (xv0 * w[1] + between.xx * w[2] + between.xv * w[3]) + w[1] * (between.vx * w[2] + between.vv * w[3]) + xv1 * w[2] * w[3];
    return diagonal + 2 * beside;
  }
};

struct Interval {
  double start, h, per_h;
  std::array<Cubic, 3> cubic;
  Ends ends;

  Interval(const double* time, const Spline& s, std::size_t i)
      : start(time[i]),
        h(time[i + 1] - time[i]),
        per_h(1 / h),
        cubic{Cubic(s.knots[i], s.knots[i + 1], 0, per_h), Cubic(s.knots[i], s.knots[i + 1], 1, per_h),
              Cubic(s.knots[i], s.knots[i + 1], 2, per_h)},
        ends(s.knots[i], s.knots[i + 1], s.between[i]) {}
};

// With s = u/h, r = 1 − s: Hermite's weights, those of the derivatives, and what the random motion does between two known ends:
//   position q u³w³/(3h³), velocity q u w (u² − u w + w²)/h³ with w = h − u (covariance of a clamped beam).
void fill(const Interval& in, double t, std::size_t k, Piece& piece) {
  const double u = std::clamp(t - in.start, 0.0, in.h), w = in.h - u, s = u * in.per_h, r = 1 - s;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Cubic& c = in.cubic[axis];
    piece.position[axis][k] = c.c0 + u * (c.c1 + u * (c.c2 + u * c.c3));
    piece.velocity[axis][k] = c.c1 + u * (2 * c.c2 + 3 * u * c.c3);
  }
  const Weights value{(1 + 2 * s) * r * r, u * r * r, s * s * (3 - 2 * s), -s * u * r};
  const double steep = 6 * s * r * in.per_h;
  const Weights slope{-steep, r * (1 - 3 * s), steep, s * (3 * s - 2)};
  const double q = in.ends.between.roughness, uw = s * w;
  constexpr double kThird = 1.0 / 3;
  piece.position_variance[k] = (in.ends.of(value) + q * uw * uw * uw * kThird) * kThird;
  piece.velocity_variance[k] = (in.ends.of(slope) + q * uw * (s * s - s * r + r * r)) * kThird;
}

}  // namespace

Piece empty_piece(double first, double last, double step) {
  constexpr double kSlack = 1e-9;  // of a step: a point on an even time belongs to it whatever the rounding
  Piece piece;
  const double begin = std::ceil(first / step - kSlack), end = std::floor(last / step + kSlack);
  const auto count = end >= begin ? static_cast<std::size_t>(end - begin) + 1 : 0;
  piece.start = begin * step;
  piece.step = step;
  for (auto* vectors : {&piece.position, &piece.velocity}) {
    for (auto& component : *vectors) component.resize(count);
  }
  piece.position_variance.resize(count);
  piece.velocity_variance.resize(count);
  piece.weight.assign(count, step);
  return piece;
}

void sample(const double* time, const Spline& spline, Piece& piece) {
  const std::size_t intervals = spline.between.size();
  const auto at = [&](std::size_t k) { return piece.start + static_cast<double>(k) * piece.step; };
  for (std::size_t i = 0, k = 0; k < piece.size(); ++i) {
    const bool last = i + 1 == intervals;
    if (!last && at(k) >= time[i + 1]) continue;
    const Interval interval(time, spline, i);
    for (; k < piece.size() && (last || at(k) < time[i + 1]); ++k) fill(interval, at(k), k, piece);
  }
}

}  // namespace millscope::trajectory
