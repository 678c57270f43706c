// exp, log and powers for packs, from operations that IEEE fixes: the same bits on `double` and on `Pack` of every width, a few times
// faster than the standard library lane by lane.
//
//   log₂ x: x = 2^e m with √½ ≤ m < √2, log₂ x = e + 2/ln 2 · (s + s³/3 + s⁵/5 + …), s = (m − 1)/(m + 1), |s| < 0.172
//   2^t: t = n + f with n whole and |f| ≤ ½, 2^t = 2^n Σ (f ln 2)^k/k!
//
// Both series are cut where what they leave is below 1e-17. Their even and their odd terms are summed side by side: a processor need not
// wait for the one to go on with the other. Relative errors: of 2^t below 4e-16, of e^x below 3e-16 (1 + |x|), of x^y below
// 1e-15 (1 + |y log₂ x|) while that is within 2^±1022. What is no number stays none; infinite ones are outside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "millscope/pack.hpp"

namespace millscope {
namespace detail {

template <class R>
struct BitsOf;
template <>
struct BitsOf<double> {
  using type = std::uint64_t;
};
template <>
struct BitsOf<Pack> {
  typedef std::uint64_t type __attribute__((vector_size(kPackWidth * sizeof(double))));
};

template <class R>
typename BitsOf<R>::type bits_of(const R& value) {
  typename BitsOf<R>::type bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}
template <class R>
R from_bits(const typename BitsOf<R>::type& bits) {
  R value;
  __builtin_memcpy(&value, &bits, sizeof value);
  return value;
}

inline constexpr double kWhole = 6755399441055744.0;  ///< 1.5 · 2⁵²: what is added to it is rounded to a whole number in its last bits
inline constexpr std::uint64_t kWholeBits = 0x4338000000000000, kMantissa = 0x000fffffffffffff, kOneBits = 0x3ff0000000000000;
inline constexpr int kMantissaBits = 52;
inline constexpr std::uint64_t kExponentBias = 1023;

/// 1/k!
inline constexpr auto kInverseFactorial = [] {
  std::array<double, 15> inverse{1.0};
  double factorial = 1.0;  // exact
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / (factorial *= static_cast<double>(k));
  return inverse;
}();

}  // namespace detail

/// Σ q^k/(2k + 1) up to k = kLast, which is even: artanh(s)/s for q = s², arctan(s)/s for q = −s².
template <int kLast, class R>
R inverse_odd_series(const R& q) {
  const R square = q * q;
  R even(1.0 / (2 * kLast + 1)), odd(1.0 / (2 * kLast - 1));
  for (int k = kLast - 2; k >= 0; k -= 2) even = R(1.0 / (2 * k + 1)) + square * even;
  for (int k = kLast - 3; k >= 1; k -= 2) odd = R(1.0 / (2 * k + 1)) + square * odd;
  return even + q * odd;
}

/// log₂ x for normal x > 0; for what is smaller, the logarithm of the smallest normal number (−1022).
template <class R>
R binary_logarithm(R x) {
  const auto bits = detail::bits_of(maximum(x, R(2.2250738585072014e-308)));
  R m = detail::from_bits<R>((bits & detail::kMantissa) | detail::kOneBits);
  R e = detail::from_bits<R>((bits >> detail::kMantissaBits) + (detail::kWholeBits - detail::kExponentBias)) - R(detail::kWhole);
  const auto upper = m > R(std::numbers::sqrt2);
  m = select(upper, R(0.5) * m, m);
  e = e + select(upper, R(1.0), R(0.0));
  const R s = (m - R(1.0)) / (m + R(1.0));
  return select(x <= x, e + R(2.0 * std::numbers::log2e) * (s * inverse_odd_series<10>(s * s)), x);
}

/// 2^t; t is taken to lie from −1022 to 1023.
template <class R>
R binary_power(R exponent) {
  const R t = maximum(R(-1022.0), minimum(exponent, R(1023.0)));
  const R shifted = t + R(detail::kWhole);
  const R f = R(std::numbers::ln2) * (t - (shifted - R(detail::kWhole)));
  const R square = f * f;
  R even(detail::kInverseFactorial[14]), odd(detail::kInverseFactorial[13]);
  for (std::size_t k = 12; k > 0; k -= 2) {
    even = R(detail::kInverseFactorial[k]) + square * even;
    odd = R(detail::kInverseFactorial[k - 1]) + square * odd;
  }
  const R whole = detail::from_bits<R>((detail::bits_of(shifted) - detail::kWholeBits + detail::kExponentBias) << detail::kMantissaBits);
  return select(exponent <= exponent, (R(1.0) + (f * odd + square * even)) * whole, exponent);
}

/// e^x for −708 ≤ x ≤ 709; beyond, 2^−1022 and 2^1023.
template <class R>
R exponential(R x) {
  return binary_power(R(std::numbers::log2e) * x);
}

/// ln x for normal x > 0; for what is smaller, −708.4.
template <class R>
R logarithm(R x) {
  return R(std::numbers::ln2) * binary_logarithm(x);
}

/// x^y for x ≥ 0 and y > 0; 0 where x is 0.
template <class R>
R power(R x, double y) {
  return select(x <= R(0.0), R(0.0), binary_power(R(y) * binary_logarithm(x)));
}

}  // namespace millscope
