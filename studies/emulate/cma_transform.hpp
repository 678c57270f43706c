// From an unbounded search into [0, 1], smooth, the ends included (boundary transformation of Hansen's c-cmaes):
// the identity inside, a parabola near an end that touches it, then mirrored again and again.
#pragma once

#include <cmath>

namespace millscope::emulate {

inline constexpr double kMargin = 0.05;  ///< width of the parabolas

inline double into_range(double x) {
  const double period = 2 * (1 + 2 * kMargin);
  x = std::fmod(x + kMargin, period);
  if (x < 0) x += period;
  x = (x > 0.5 * period ? period - x : x) - kMargin;  // now in [−margin, 1 + margin]
  const auto near_zero = [](double y) { return y < kMargin ? (y + kMargin) * (y + kMargin) / (4 * kMargin) : y; };
  return x < 0.5 ? near_zero(x) : 1 - near_zero(1 - x);
}

/// The nearest that leads there.
inline double out_of_range(double y) {
  const auto near_zero = [](double z) { return z < kMargin ? 2 * std::sqrt(kMargin * z) - kMargin : z; };
  return y < 0.5 ? near_zero(y) : 1 - near_zero(1 - y);
}

}  // namespace millscope::emulate
