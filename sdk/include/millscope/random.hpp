// Random numbers that are the same on every machine (the standard library's distributions are not).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace millscope {

/// SplitMix64 (Steele, Lea & Flood 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t below(std::uint64_t n) { return bits() % n; }                         ///< 0 … n − 1; bias < n/2^64
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }            ///< [0, 1)
  double between(double low, double high) { return low + (high - low) * uniform(); }  ///< [low, high)
  double exponential() { return -std::log(1.0 - uniform()); }                         ///< mean 1
  double normal() {                                                                   ///< mean 0, variance 1 (Box & Muller 1958)
    const double radius = std::sqrt(2.0 * exponential());
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// Two that are independent of each other, for less than the price of one (Marsaglia & Bray 1964).
  std::array<double, 2> normals() {
    for (;;) {
      const double x = between(-1.0, 1.0), y = between(-1.0, 1.0), square = x * x + y * y;
      if (square >= 1.0 || square == 0.0) continue;
      const double factor = std::sqrt(-2.0 * std::log(square) / square);
      return {factor * x, factor * y};
    }
  }

  /// Every order is as likely (Fisher & Yates).
  template <class List>
  void shuffle(List& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
  }

 private:
  std::uint64_t state_;
};

}  // namespace millscope
