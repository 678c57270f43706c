// Random numbers that are the same on every machine (the standard library's distributions are not).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace millscope {
namespace detail {

inline double bell(double x) { return std::exp(-0.5 * x * x); }

/// Layers of one area, one above the other, that cover the right half of the bell: how far each reaches. To the lowest belongs what lies
/// beyond kTail, with which all fit (Marsaglia & Tsang 2000).
struct BellLayers {
  static constexpr std::size_t kCount = 128;
  static constexpr double kTail = 3.442619855899;
  std::array<double, kCount + 1> reach;

  BellLayers() {
    const double area = kTail * bell(kTail) + std::sqrt(0.5 * std::numbers::pi) * std::erfc(kTail / std::numbers::sqrt2);
    reach = {area / bell(kTail), kTail};
    for (std::size_t i = 1; i + 1 < kCount; ++i) reach[i + 1] = std::sqrt(-2.0 * std::log(area / reach[i] + bell(reach[i])));
  }
};

/// Of each library its own: a symbol that is shared would keep a plugin from being unloaded.
[[gnu::visibility("hidden")]] inline const BellLayers kBellLayers;

}  // namespace detail

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
  /// Mean 0, variance 1, mostly without a logarithm; other numbers than `normal` gives, which keeps its own. The layer comes
  /// from other bits than the place in it (Doornik 2005).
  double normal_by_layers() {
    const auto& reach = detail::kBellLayers.reach;
    for (;;) {
      const std::uint64_t drawn = bits();
      const std::size_t layer = drawn % detail::BellLayers::kCount;
      const double x = (static_cast<double>(drawn >> 11) * 0x1p-52 - 1.0) * reach[layer];
      if (std::fabs(x) < reach[layer + 1]) return x;
      if (layer == 0) return std::copysign(normal_beyond(detail::BellLayers::kTail), x);
      if (between(detail::bell(reach[layer]), detail::bell(reach[layer + 1])) < detail::bell(x)) return x;
    }
  }

  /// Every order is as likely (Fisher & Yates).
  template <class List>
  void shuffle(List& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
  }

 private:
  /// Marsaglia 1964.
  double normal_beyond(double least) {
    for (;;) {
      const double x = exponential() / least;
      if (2.0 * exponential() >= x * x) return least + x;
    }
  }

  std::uint64_t state_;
};

}  // namespace millscope
