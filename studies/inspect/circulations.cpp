#include "studies/inspect/circulations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/resample.hpp"

namespace millscope::inspect {
namespace {

// Height between the first and the last hundredth of the points.
double extent_of_height(const recording::Recording& recording) {
  std::vector<double> heights;
  for (const recording::Run& run : recording.runs) heights.insert(heights.end(), run.position[1].begin(), run.position[1].end());
  const double low = base::quantile(heights, 0.01);
  return base::quantile(heights, 0.99) - low;
}

}  // namespace

std::vector<Extreme> find_extremes(const recording::Recording& recording, double height, double longest_pause) {
  std::vector<Extreme> extremes;
  for (std::size_t r = 0; r < recording.runs.size(); ++r) {
    const recording::Run& run = recording.runs[r];
    const std::vector<double>& y = run.position[1];
    std::size_t lowest = 0, highest = 0;
    int direction = 0;  // of the motion since the last extreme; 0: not known yet
    bool continues = false;
    for (std::size_t i = 1; i < run.size(); ++i) {
      if (run.time[i] - run.time[i - 1] > longest_pause) {
        lowest = highest = i;
        direction = 0;
        continues = false;
        continue;
      }
      if (y[i] < y[lowest]) lowest = i;
      if (y[i] > y[highest]) highest = i;
      const bool fell = y[i]<y[highest] - height, rose = y[i]> y[lowest] + height;
      if ((direction >= 0 && fell) || (direction <= 0 && rose)) {
        const bool top = direction >= 0 && fell;
        if (direction != 0) extremes.push_back({r, top ? highest : lowest, top, continues});
        continues = direction != 0;
        direction = top ? -1 : 1;
        lowest = highest = i;
      }
    }
  }
  return extremes;
}

Circulations count_circulations(const recording::Recording& recording, double noise, double angular_velocity) {
  Circulations c;
  c.least_height = std::max(8 * noise, 0.06 * extent_of_height(recording));
  c.longest_pause = angular_velocity != 0 ? std::clamp(0.5 * std::numbers::pi / std::fabs(angular_velocity), 0.1, 1.0) : 0.3;
  c.extremes = find_extremes(recording, c.least_height, c.longest_pause);
  std::vector<double> times;
  for (std::size_t i = 2; i < c.extremes.size(); ++i) {
    const Extreme &from = c.extremes[i - 2], &to = c.extremes[i];
    if (to.top || !to.continues || !c.extremes[i - 1].continues || from.run != to.run) continue;
    times.push_back(recording.runs[to.run].time[to.point] - recording.runs[from.run].time[from.point]);
  }
  c.count = times.size();
  if (times.size() < 5) {
    c.time.note = c.per_turn.note = fmt::format("{} whole circulations", times.size());
    return c;
  }
  const auto n = static_cast<double>(times.size());
  double mean = 0, squares = 0;
  for (const double t : times) mean += t / n;
  for (const double t : times) squares += (t - mean) * (t - mean);
  const double deviation = std::sqrt(squares / (n - 1) / n);
  c.time = {interval(mean, deviation, n - 1), fmt::format("{} circulations", times.size())};
  if (angular_velocity == 0) {
    c.per_turn.note = "the mill's speed is not known";
    return c;
  }
  const double turn = 2 * std::numbers::pi / std::fabs(angular_velocity);
  c.per_turn = {interval(turn / mean, turn / mean * deviation / mean, n - 1), c.time.note};
  return c;
}

}  // namespace millscope::inspect
