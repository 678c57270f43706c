// One bead's motion at even times, and what is added up from it: circulations, axial spread, correlations.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"
#include "analyzers/common/tracks.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {

/// Quantities whose correlation in time is looked at.
enum Signal { kSignalX, kSignalSpeed, kSignalAxial, kSignalZ, kSignals };
enum CorrelationMoment { kPairs, kHead, kTail, kHeadSquare, kTailSquare, kProduct, kCorrelationMoments };
enum SpreadMoment { kSpreadPairs, kSpreadSum, kSpreadSquare, kSpreadMoments };

using Series = std::array<std::vector<double>, kSignals>;

/// The signals at first time + k · step, linear between samples. `period` > 0: z jumps by it at the periodic ends and is unrolled.
inline void resample(const FrameBlock& block, const Track& track, double step, double period, Series& series) {
  for (auto& signal : series) signal.clear();
  if (track.size() < 2) return;
  const double start = track.time(0), span = track.time(track.size() - 1) - start;
  const auto count = static_cast<std::size_t>(span / step * (1 + 1e-12)) + 1;
  const auto value = [&](std::size_t i, int signal) {
    const std::int64_t s = track.points[i].sample;
    if (signal == kSignalX) return block.position[0][s];
    if (signal == kSignalZ) return block.position[2][s];
    if (signal == kSignalAxial) return block.velocity[2][s];
    return std::sqrt(block.velocity[0][s] * block.velocity[0][s] + block.velocity[1][s] * block.velocity[1][s] +
                     block.velocity[2][s] * block.velocity[2][s]);
  };
  std::size_t i = 0;
  double turns = 0;  // periods by which z at sample i is unrolled
  const auto jump = [&](std::size_t at) {
    return period > 0 ? -std::round((value(at + 1, kSignalZ) - value(at, kSignalZ)) / period) : 0.0;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double t = start + static_cast<double>(k) * step;
    while (i + 2 < track.size() && track.time(i + 1) < t) {
      turns += jump(i);
      ++i;
    }
    const double part = std::fmin(1.0, (t - track.time(i)) / (track.time(i + 1) - track.time(i)));
    for (int signal = 0; signal < kSignals; ++signal) {
      double a = value(i, signal), b = value(i + 1, signal);
      if (signal == kSignalZ) a += turns * period, b += (turns + jump(i)) * period;
      element(series, signal).push_back(a + part * (b - a));
    }
  }
}

/// Sums over all pairs at lags 0 … lags − 1 steps; kCorrelationMoments numbers per lag.
inline void add_correlation(const std::vector<double>& signal, std::int64_t lags, double* sums) {
  const auto n = static_cast<std::int64_t>(signal.size());
  for (std::int64_t lag = 0; lag < std::min(lags, n); ++lag) {
    double head = 0, tail = 0, head_square = 0, tail_square = 0, mixed = 0;
    const double* a = signal.data();
    const double* b = signal.data() + lag;
    for (std::int64_t i = 0; i < n - lag; ++i) {
      head += a[i];
      tail += b[i];
      head_square += a[i] * a[i];
      tail_square += b[i] * b[i];
      mixed += a[i] * b[i];
    }
    double* sum = sums + kCorrelationMoments * lag;
    sum[kPairs] += static_cast<double>(n - lag);
    sum[kHead] += head;
    sum[kTail] += tail;
    sum[kHeadSquare] += head_square;
    sum[kTailSquare] += tail_square;
    sum[kProduct] += mixed;
  }
}

/// Lags for the axial spread, in steps: about six per factor of two.
inline std::vector<std::int64_t> spread_lags(std::int64_t longest) {
  std::vector<std::int64_t> lags;
  for (double lag = 1; lag < static_cast<double>(longest) + 0.5; lag *= 1.122462048309373) {
    const auto rounded = static_cast<std::int64_t>(std::llround(lag));
    if (lags.empty() || rounded > lags.back()) lags.push_back(rounded);
  }
  return lags;
}

/// Axial displacements over each lag, from starts a quarter of the lag apart.
inline void add_spread(const std::vector<double>& z, const std::vector<std::int64_t>& lags, double* sums) {
  const auto n = static_cast<std::int64_t>(z.size());
  for (std::size_t l = 0; l < lags.size(); ++l) {
    double* sum = sums + kSpreadMoments * static_cast<std::int64_t>(l);
    for (std::int64_t i = 0; i + lags[l] < n; i += std::max<std::int64_t>(1, lags[l] / 4)) {
      const double moved = element(z, i + lags[l]) - element(z, i);
      sum[kSpreadPairs] += 1;
      sum[kSpreadSum] += moved;
      sum[kSpreadSquare] += moved * moved;
    }
  }
}

/// Circulations of one track about a centre. A circulation goes from one passage of the half-line from the centre away from the mill's
/// axis to the next one after a whole turn about the centre; going back and forth over the line counts once.
struct Circulations {
  double angle = 0;                  ///< turned about the centre in the mill's sense over the track, rad
  std::vector<double> completed;     ///< s
  std::optional<double> unfinished;  ///< time since the last passage when the track ended, s; none without a passage
};

inline Circulations follow(const FrameBlock& block, const Track& track, double sense, double centre_x, double centre_y) {
  Circulations found;
  const double line = std::atan2(centre_y, sense * centre_x);
  double angle = 0, before = 0, highest = 0;
  std::optional<double> last;  // passage, s
  for (std::size_t i = 0; i < track.size(); ++i) {
    const std::int64_t s = track.points[i].sample;
    const double now = angle_of(block.position[1][s] - centre_y, sense * (block.position[0][s] - centre_x)) - line;
    if (i == 0) {
      angle = now - 2 * std::numbers::pi * std::floor(now / (2 * std::numbers::pi));  // 0 … 2π: the first passage is at 2π
      found.angle = -angle;
      highest = angle;
      before = now;
      continue;
    }
    const double next = angle + std::remainder(now - before, 2 * std::numbers::pi);
    const double turn = 2 * std::numbers::pi * (std::floor(highest / (2 * std::numbers::pi)) + 1);
    if (next >= turn) {
      const double t = track.time(i - 1) + (track.time(i) - track.time(i - 1)) * (turn - angle) / (next - angle);
      if (last) found.completed.push_back(t - *last);
      last = t;
    }
    highest = std::fmax(highest, next);
    angle = next;
    before = now;
  }
  found.angle += angle;
  if (last) found.unfinished = track.time(track.size() - 1) - *last;
  return found;
}

}  // namespace millscope::analyzers
