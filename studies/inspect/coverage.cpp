#include "studies/inspect/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"
#include "studies/recording/noise.hpp"

namespace millscope::inspect {
namespace {

void add(recording::RunReport& sum, const recording::RunReport& r) {
  sum.rows += r.rows;
  sum.used += r.used;
  sum.unreadable += r.unreadable;
  sum.not_finite += r.not_finite;
  sum.lost += r.lost;
  sum.false_times += r.false_times;
  sum.backwards += r.backwards;
  sum.duplicates += r.duplicates;
  sum.outliers += r.outliers;
  sum.outside += r.outside;
  sum.gap_time += r.gap_time;
  sum.gaps += r.gaps;
}

recording::Run part_of(const recording::Run& run, std::size_t first, std::size_t last) {
  const auto slice = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  recording::Run part;
  part.name = run.name;
  part.time = slice(run.time);
  for (std::size_t a = 0; a < 3; ++a) part.position[a] = slice(run.position[a]);
  return part;
}

}  // namespace

Coverage measure_coverage(const recording::Recording& recording) {
  Coverage c;
  c.runs = recording.runs.size();
  c.gap_limit = recording.gap_limit;
  c.median_interval = median_interval(recording);
  for (const recording::Run& run : recording.runs) {
    add(c.report, run.report);
    c.points += run.size();
    c.span += run.time.back() - run.time.front();
    for (std::size_t i = 1; i < run.size(); ++i) {
      const double pause = run.time[i] - run.time[i - 1];
      if (pause <= recording.gap_limit) c.covered += pause;
      if (pause > recording.gap_limit) c.longest_gap = std::max(c.longest_gap, pause);
    }
  }
  c.rate = c.covered > 0 ? static_cast<double>(c.points) / c.covered : 0;
  return c;
}

std::array<Finding, 3> measure_noise(const recording::Recording& recording) {
  constexpr std::size_t kParts = 20, kFewest = 60;
  std::size_t all = 0;
  for (const recording::Run& run : recording.runs) all += run.size();
  const std::size_t length = std::max(kFewest, all / kParts);
  std::array<std::vector<double>, 3> values;
  for (const recording::Run& run : recording.runs) {
    for (std::size_t first = 0; first + length <= run.size(); first += length) {
      const auto noise = recording::difference_noise(part_of(run, first, first + length), recording.gap_limit);
      for (std::size_t a = 0; a < 3; ++a) {
        if (noise[a] > 0) values[a].push_back(noise[a]);
      }
    }
  }
  std::array<Finding, 3> result;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<double>(values[a].size());
    if (values[a].size() < 4) {
      result[a].note = fmt::format("fewer than four parts of {} points in unbroken stretches", length);
      continue;
    }
    double mean = 0, squares = 0;
    for (const double v : values[a]) mean += v / n;
    for (const double v : values[a]) squares += (v - mean) * (v - mean);
    result[a] = {interval(mean, std::sqrt(squares / (n - 1) / n), n - 1), "from point to point; its slow part comes on top"};
  }
  return result;
}

Axial measure_axial(const recording::Recording& recording) {
  std::vector<std::pair<double, double>> heights;
  double all = 0;
  for (const recording::Run& run : recording.runs) {
    const std::vector<double> dwell = dwell_times(run, recording.gap_limit);
    for (std::size_t i = 0; i < run.size(); ++i) {
      heights.emplace_back(run.position[2][i], dwell[i]);
      all += dwell[i];
    }
  }
  Axial axial;
  if (!(all > 0)) return axial;
  axial.low = base::weighted_quantile(heights, 0.005);
  axial.high = base::weighted_quantile(heights, 0.995);
  const double length = axial.high - axial.low;
  if (!(length > 0)) return axial;
  for (const auto& [z, weight] : heights)
    axial.share[static_cast<std::size_t>(std::clamp((z - axial.low) / length * 10, 0.0, 9.0))] += weight / all;
  for (const recording::Run& run : recording.runs) {
    int side = 0;
    for (const double z : run.position[2]) {
      const double place = (z - axial.low) / length;
      const int now = place < 1. / 3 ? -1 : place > 2. / 3 ? 1 : 0;
      axial.traverses += side * now < 0;
      if (now != 0) side = now;
    }
  }
  return axial;
}

}  // namespace millscope::inspect
