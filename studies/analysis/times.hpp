// How fast a charge forgets: autocorrelation times of basic observables, and from them how long a block must be.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "millscope/analyzer.hpp"
#include "studies/analysis/resample.hpp"
#include "studies/analysis/results.hpp"

namespace millscope::analysis {

inline constexpr std::size_t kBasics = 5;
inline constexpr std::array<const char*, kBasics> kBasicNames{"x", "y", "radius", "z", "speed"};

using Basics = std::array<double, kBasics>;

/// Means over the samples of each frame (one bead: the bead itself), in time order within a stretch.
struct BasicSeries {
  std::vector<double> time;    ///< s
  std::vector<double> weight;  ///< s that the frame stands for
  std::array<std::vector<double>, kBasics> value;
  void add(double time_of_frame, double weight_of_frame, const Basics& means) {
    time.push_back(time_of_frame);
    weight.push_back(weight_of_frame);
    for (std::size_t k = 0; k < kBasics; ++k) value[k].push_back(means[k]);
  }
  std::size_t size() const { return time.size(); }
  void append(const BasicSeries& other);
  double duration() const;  ///< s, sum of the weights
};

/// Of one chunk; a first frame without weight belongs to the chunk before and is left out.
BasicSeries basics_of(const FrameBlock& block);

/// Evenly sampled values of one observable, one row per stretch; NaN in gaps.
struct EvenSeries {
  double step = 0;  ///< s
  std::vector<std::vector<double>> rows;
};

inline constexpr std::size_t kMostSteps = 50000;

/// On an even grid (means of what falls into each step) of at most about `most` steps in all.
EvenSeries even_series(const std::vector<BasicSeries>& stretches, std::size_t basic, std::size_t most = kMostSteps);

/// Integrated autocorrelation time τ = Δt (½ + Σ_k ρ_k), summed to the first lag W ≥ 5 τ (Sokal 1997), with the correction 1 + (2 W + 1)/n
/// for the mean that was taken from the data (Wolff 2004); s. Pairs across gaps count at their lag. NaN: fewer than 8 values.
double autocorrelation_time(const EvenSeries& series);

/// What the blocks say of one observable.
struct BlockMemory {
  double independent = kNaN;  ///< N_eff = (σ/sem)² of its mean: σ over all values, sem as of any result (resample.hpp)
  double correlation = kNaN;  ///< of neighbouring blocks
};

/// `stretches` are in the order of their numbers, `counts` of `draw_counts`. NaN: too few blocks.
BlockMemory block_memory(const std::vector<BasicSeries>& stretches, std::size_t basic, const std::vector<ResultBlock>& blocks,
                         const std::vector<std::uint32_t>& counts);

/// Mean time of one circulation: from one crossing of the mean upwards to the next, half a standard deviation being passed on
/// both sides; s. Where gaps leave fewer than three, four times the lag at which the
/// autocorrelation first falls to zero. 0: unknown.
double circulation_time(const EvenSeries& series);

/// What the series say of the blocks.
struct BlockRule {
  std::vector<ObservableTime> times;
  BlockLengths lengths;
  double circulation = 0;  ///< s; 0: unknown or many beads
};
/// `one_bead`: the series follow a single bead, so that circulations are seen.
BlockRule block_rule(const std::vector<BasicSeries>& stretches, bool one_bead);

}  // namespace millscope::analysis
