#include "studies/analysis/times.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/base/statistics.hpp"
#include "studies/analysis/resample.hpp"

namespace millscope::analysis {
namespace {

/// Mean and variance of all values.
struct Moments {
  double mean = 0, variance = 0;
  std::size_t count = 0;
};

Moments moments_of(const EvenSeries& series) {
  Moments m;
  for (const auto& row : series.rows) {
    for (const double value : row) {
      if (std::isnan(value)) continue;
      m.mean += value;
      ++m.count;
    }
  }
  if (m.count == 0) return m;
  m.mean /= static_cast<double>(m.count);
  for (const auto& row : series.rows) {
    for (const double value : row) m.variance += std::isnan(value) ? 0 : (value - m.mean) * (value - m.mean);
  }
  m.variance /= static_cast<double>(m.count);
  return m;
}

/// Autocovariances over all pairs that exist, lag after lag; several lags at once, since each is a chain of sums.
class Autocovariance {
 public:
  Autocovariance(const EvenSeries& series, double mean) {
    for (const auto& row : series.rows) {
      Row centred{std::vector<double>(row.size()), std::vector<double>(row.size())};
      for (std::size_t i = 0; i < row.size(); ++i) {
        const bool there = !std::isnan(row[i]);
        centred.value[i] = there ? row[i] - mean : 0;
        centred.there[i] = there ? 1 : 0;
      }
      rows_.push_back(std::move(centred));
    }
  }

  /// NaN: no pair exists.
  double at(std::size_t lag) {
    if (lag < first_ || lag >= first_ + kLags) fill(lag);
    return values_[lag - first_];
  }

 private:
  static constexpr std::size_t kLags = 8;
  struct Row {
    std::vector<double> value, there;
  };

  void fill(std::size_t lag) {
    first_ = lag;
    std::array<double, kLags> sums{}, pairs{};
    for (const Row& row : rows_) {
      const std::size_t size = row.value.size(), whole = size > lag + kLags ? size - lag - kLags : 0;
      const double *value = row.value.data(), *there = row.there.data();
      for (std::size_t i = 0; i < whole; ++i) {
        for (std::size_t k = 0; k < kLags; ++k) {
          sums[k] += value[i] * value[i + lag + k];
          pairs[k] += there[i] * there[i + lag + k];
        }
      }
      for (std::size_t i = whole; i < size; ++i) {
        for (std::size_t k = 0; k < kLags && i + lag + k < size; ++k) {
          sums[k] += value[i] * value[i + lag + k];
          pairs[k] += there[i] * there[i + lag + k];
        }
      }
    }
    for (std::size_t k = 0; k < kLags; ++k) values_[k] = pairs[k] > 0 ? sums[k] / pairs[k] : kNaN;
  }

  std::vector<Row> rows_;
  std::size_t first_ = std::numeric_limits<std::size_t>::max() - kLags;
  std::array<double, kLags> values_{};
};

/// The usual distance of two frames, s.
double usual_step(const std::vector<BasicSeries>& stretches) {
  std::vector<double> steps;
  for (const BasicSeries& s : stretches) {
    for (std::size_t i = 1; i < s.size(); ++i) steps.push_back(s.time[i] - s.time[i - 1]);
  }
  return steps.empty() ? 0 : base::quantile(steps, 0.5);
}

std::vector<double> even_row(const BasicSeries& s, std::size_t basic, double step) {
  std::vector<double> row;
  if (s.size() == 0) return row;
  const auto last = std::lround((s.time.back() - s.time.front()) / step);
  row.assign(last + 1, 0.0);
  std::vector<double> count(last + 1, 0.0);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto at = std::min(last, std::lround((s.time[i] - s.time.front()) / step));
    row[at] += s.value[basic][i];
    count[at] += 1;
  }
  for (std::size_t k = 0; k < row.size(); ++k) row[k] = count[k] > 0 ? row[k] / count[k] : kNaN;
  return row;
}

/// Of at most about `most` steps in all; 0: unknown.
double even_step(const std::vector<BasicSeries>& stretches, std::size_t most) {
  double span = 0;
  for (const BasicSeries& s : stretches) span += s.size() > 0 ? s.time.back() - s.time.front() : 0;
  const double usual = usual_step(stretches);
  return usual > 0 ? usual * std::max(1.0, std::ceil(span / usual / static_cast<double>(most))) : 0;
}

EvenSeries even_series_of(const std::vector<BasicSeries>& stretches, std::size_t basic, double step) {
  EvenSeries even;
  if (!(step > 0)) return even;
  even.step = step;
  for (const BasicSeries& s : stretches) even.rows.push_back(even_row(s, basic, step));
  return even;
}

/// Lag at which the autocorrelation first falls to zero, s; 0: never.
double first_zero(const EvenSeries& series, const Moments& m) {
  std::size_t longest = 0;
  for (const auto& row : series.rows) longest = std::max(longest, row.size());
  if (!(m.variance > 0)) return 0;
  Autocovariance covariance(series, m.mean);
  for (std::size_t lag = 1; lag < longest; ++lag) {
    if (covariance.at(lag) <= 0) return series.step * static_cast<double>(lag);
  }
  return 0;
}

}  // namespace

void BasicSeries::append(const BasicSeries& other) {
  time.insert(time.end(), other.time.begin(), other.time.end());
  weight.insert(weight.end(), other.weight.begin(), other.weight.end());
  for (std::size_t k = 0; k < kBasics; ++k) value[k].insert(value[k].end(), other.value[k].begin(), other.value[k].end());
}

double BasicSeries::duration() const { return std::accumulate(weight.begin(), weight.end(), 0.0); }

BasicSeries basics_of(const FrameBlock& block) {
  BasicSeries series;
  for (std::int64_t f = 0; f < block.frame_count; ++f) {
    const std::int64_t begin = block.first[f], end = block.first[f + 1];
    double weight = 0;
    Basics sums{};
    for (std::int64_t s = begin; s < end; ++s) {
      const double w = block.weight[s], x = block.position[0][s], y = block.position[1][s];
      weight += w;
      sums[0] += w * x;
      sums[1] += w * y;
      sums[2] += w * std::sqrt(x * x + y * y);
      sums[3] += w * block.position[2][s];
      if (block.velocity[0] == nullptr) continue;
      const double u = block.velocity[0][s], v = block.velocity[1][s], z = block.velocity[2][s];
      sums[4] += w * std::sqrt(u * u + v * v + z * z);
    }
    if (!(weight > 0)) continue;
    for (double& sum : sums) sum /= weight;
    series.add(block.time[f], weight / static_cast<double>(end - begin), sums);
  }
  return series;
}

EvenSeries even_series(const std::vector<BasicSeries>& stretches, std::size_t basic, std::size_t most) {
  return even_series_of(stretches, basic, even_step(stretches, most));
}

double autocorrelation_time(const EvenSeries& series) {
  const Moments m = moments_of(series);
  if (m.count < 8) return kNaN;
  if (!(m.variance > 0)) return 0.5 * series.step;
  std::size_t longest = 0;
  for (const auto& row : series.rows) longest = std::max(longest, row.size());
  Autocovariance autocovariance(series, m.mean);
  double tau = 0.5;
  std::size_t window = 1;
  for (; window < longest; ++window) {
    const double covariance = autocovariance.at(window);
    if (!std::isnan(covariance)) tau += covariance / m.variance;
    if (static_cast<double>(window) >= 5 * tau) break;
  }
  const double n = static_cast<double>(m.count);
  return series.step * std::max(0.5, tau) * (1 + (2 * static_cast<double>(window) + 1) / n);
}

BlockMemory block_memory(const std::vector<BasicSeries>& stretches, std::size_t basic, const std::vector<ResultBlock>& blocks,
                         const std::vector<std::uint32_t>& counts) {
  double weight = 0, mean = 0, variance = 0;
  for (const BasicSeries& s : stretches) {
    for (std::size_t i = 0; i < s.size(); ++i) weight += s.weight[i], mean += s.weight[i] * s.value[basic][i];
  }
  mean /= weight;
  std::vector<float> left_out;
  std::vector<std::uint8_t> follows;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const BasicSeries& s = stretches.at(blocks[b].stretch);
    const bool goes_on = b > 0 && blocks[b].stretch == blocks[b - 1].stretch;
    if (!goes_on) at = 0;
    double own = 0, deviation = 0;
    for (; at < s.size() && s.time[at] <= blocks[b].end; ++at) {
      const double d = s.value[basic][at] - mean;
      own += s.weight[at], deviation += s.weight[at] * d, variance += s.weight[at] * d * d / weight;
    }
    left_out.push_back(static_cast<float>(-deviation / (weight - own)));
    follows.push_back(goes_on ? 1 : 0);
  }
  if (blocks.size() < 2) return {};
  const Uncertainty u = uncertainty(0, influence_draws(left_out, counts), left_out, follows);
  return {u.sem > 0 ? variance / (u.sem * u.sem) : kNaN, u.correlation};
}

double circulation_time(const EvenSeries& series) {
  const Moments m = moments_of(series);
  const double band = std::sqrt(m.variance) / 2;
  double sum = 0;
  std::size_t count = 0;
  for (const auto& row : series.rows) {
    bool below = false, seen = false;
    std::size_t last = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (std::isnan(row[i])) {
        below = seen = false;
      } else if (row[i] < m.mean - band) {
        below = true;
      } else if (below && row[i] > m.mean + band) {
        if (seen) sum += series.step * static_cast<double>(i - last), ++count;
        below = false;
        seen = true;
        last = i;
      }
    }
  }
  return count < 2 ? 4 * first_zero(series, m) : sum / static_cast<double>(count);
}

BlockRule block_rule(const std::vector<BasicSeries>& stretches, bool one_bead) {
  BlockRule rule;
  double span = 0;
  for (const BasicSeries& s : stretches) span += s.duration();
  const double step = even_step(stretches, kMostSteps);
  for (std::size_t k = 0; k < kBasics; ++k) {
    const EvenSeries even = even_series_of(stretches, k, step);
    const double time = autocorrelation_time(even);
    const bool sets = k < 3;  // x, y, radius
    rule.times.push_back({kBasicNames[k], time, span / (2 * time), sets, kNaN});
    if (sets && !std::isnan(time)) rule.lengths.least = std::max(rule.lengths.least, 3 * time);
    if (std::string(kBasicNames[k]) == "speed" && !std::isnan(time)) rule.lengths.wished = 3 * time;
    if (k == 0 && one_bead) rule.circulation = circulation_time(even);
  }
  rule.lengths.least = std::max(rule.lengths.least, 2 * rule.circulation);
  return rule;
}

}  // namespace millscope::analysis
