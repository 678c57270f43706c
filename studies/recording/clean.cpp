#include "studies/recording/clean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/statistics.hpp"
#include "studies/recording/select.hpp"

namespace millscope::recording {

void drop_outside(Run& run, const std::array<std::array<double, 2>, 3>& range) {
  std::vector<char> keep(run.size(), 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double value = run.position[axis][i];
      keep[i] = static_cast<char>(keep[i] & (value >= range[axis][0]) & (value <= range[axis][1]));
    }
  }
  run.report.outside += keep_only(run, keep);
}

// The chain with the most points in which each can be reached from the one before; a jump within the chain costs as much as ten points, so
// it is taken only where both sides of it are long. Groups of up to nine outliers are passed over.
void drop_outliers(Run& run, const Travel& travel) {
  constexpr std::size_t kBack = 10;
  constexpr int kJump = 10;
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  const std::size_t n = run.size();
  std::vector<int> score(n);
  std::vector<std::size_t> from(n, kNone);
  int best = 0;
  std::size_t best_at = kNone;
  for (std::size_t i = 0; i < n; ++i) {
    score[i] = 1 + std::max(0, best - kJump);
    from[i] = best > kJump ? best_at : kNone;
    for (std::size_t j = i; j-- > 0 && i - j <= kBack;) {
      if (score[j] + 1 <= score[i] || !travel.possible(run, j, i)) continue;
      score[i] = score[j] + 1;
      from[i] = j;
      if (score[j] == best) break;
    }
    if (score[i] > best) {
      best = score[i];
      best_at = i;
    }
  }
  std::vector<char> keep(n, 0);
  for (std::size_t i = best_at; i != kNone; i = from[i]) keep[i] = 1;
  run.report.outliers += keep_only(run, keep);
}

double median_interval(const std::vector<Run>& runs) {
  std::size_t total = 0;
  for (const Run& run : runs) total += run.size();
  const std::size_t stride = total / 50000 + 1;
  std::vector<double> intervals;
  for (const Run& run : runs) {
    for (std::size_t i = 1; i < run.size(); i += stride) intervals.push_back(run.time[i] - run.time[i - 1]);
  }
  return intervals.empty() ? 0 : base::quantile(intervals, 0.5);
}

double default_gap_limit(const std::vector<Run>& runs) {
  const double median = median_interval(runs);
  return std::max(3 * median, std::clamp(10 * median, 0.01, 0.1));
}

void count_gaps(Run& run, double gap_limit) {
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double pause = run.time[i] - run.time[i - 1];
    if (pause <= gap_limit) continue;
    ++run.report.gaps;
    run.report.gap_time += pause;
  }
}

}  // namespace millscope::recording
