// Uncertainty from blocks: a bootstrap whose draws are shared by all results, so that their joint covariance exists.
//
//   draw b:  θ_b = f(Σ_i c_bi S_i)            S_i: additive sums of block i, c_bi: how often it was drawn, Σ_i c_bi = n
//   s² = n/(n−1) Var_b(θ_b)                   the bootstrap's variance of a mean is short by (n−1)/n
//   U_i = θ_(·) − θ_(−i)                      influence of block i: θ with it left out, against the mean of those
//   ρ: lag-1 correlation of U, unbiased by (1 + 3 ρ)/n;  g² = (1 + ρ)/(1 − ρ), at least 1;  sem = g s
//   draws: θ_b − θ times √(n/(n − 1)) and one g for all results, that of the mean ρ of x, y, radius and speed: one for each
//          would break that they add up
//   interval  θ + sem (a (1 + 2 t²) ± t),     a = ΣU³/(6 (ΣU²)^{3/2}): skewness (Johnson 1978), t: Student's 95 % point with ν freedom;
//                                            the shift is at most t/2
//   1/ν = ½ (ΣU⁴/(ΣU²)² − 3/n + 2/(n−1)), at most n − 1: blocks without influence give no freedom
//
// Blocks of three autocorrelation times are still correlated with their neighbours by 0.2; without g the intervals hold 80 % instead of 90
// %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace millscope::analysis {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< what the data leave undefined

/// counts[b n + i]: how often block i is in draw b. The same on every machine.
std::vector<std::uint32_t> draw_counts(std::size_t blocks, std::size_t draws, std::uint64_t seed);

/// What the draws and the left-out blocks say of one value.
struct Uncertainty {
  double sem, low, high;
  double effective_blocks;
  std::uint8_t flags;  ///< ResultFlag
  double correlation;  ///< ρ, which may be below 0; NaN where too few neighbours tell it
};

/// Draws of a result that blocks which come twice would bias (ResultTrait kSpread: a variance between beads counts their noise as spread):
/// what the influences make of the counts, Σ_i c_bi U_i (n − 1)/n. Their variance is that of the jackknife, their mean 0, and they go with
/// the draws of all other results. Of a variance between beads the error is up to √2 too large (Efron & Stein 1981), never too small.
/// `counts`: of `draw_counts`. NaN in `left_out` counts as no influence.
std::vector<float> influence_draws(std::span<const float> left_out, std::span<const std::uint32_t> counts);

/// `draws`: θ_b − θ; `left_out`: θ_(−i) − θ, in the order of the blocks; `follows[i]`: block i goes on from block i − 1 (same stretch).
/// NaN where undefined.
Uncertainty uncertainty(double value, std::span<const float> draws, std::span<const float> left_out, std::span<const std::uint8_t> follows);

/// g² of a ρ, which counts from 0 to 0.9.
double widening(double correlation);

}  // namespace millscope::analysis
