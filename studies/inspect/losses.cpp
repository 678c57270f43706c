#include "studies/inspect/losses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"

namespace millscope::inspect {
namespace {

constexpr std::size_t kRanges = 7;
constexpr double kLongest = 0.3;  // s: no speed is given to a longer pause
constexpr double kGroup = 2;      // s that are resampled together

/// One pause between two points.
struct Pause {
  double length = 0;  // s
  double speed = 0;   // m/s
  std::size_t group = 0;
};

double chord_speed(const recording::Run& run, std::size_t from, std::size_t to) {
  double square = 0;
  for (const auto& component : run.position) square += (component[to] - component[from]) * (component[to] - component[from]);
  return std::sqrt(square) / (run.time[to] - run.time[from]);
}

// Slope of a line through the nine points about the pause, within the stretch.
double local_speed(const UnbrokenStretch& stretch, std::size_t before) {
  constexpr std::size_t kSide = 4;
  const recording::Run& run = *stretch.run;
  const std::size_t first = std::max(stretch.first, before - std::min(before, kSide)), last = std::min(stretch.last, before + kSide + 2);
  if (last - first < 5) return chord_speed(run, first, last - 1);
  double mean = 0, square = 0;
  for (std::size_t i = first; i < last; ++i) mean += run.time[i] / static_cast<double>(last - first);
  std::array<double, 3> slope{};
  for (std::size_t i = first; i < last; ++i) {
    const double s = run.time[i] - mean;
    square += s * s;
    for (std::size_t a = 0; a < 3; ++a) slope[a] += s * (run.position[a][i] - run.position[a][first]);
  }
  return std::sqrt(slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]) / square;
}

std::vector<Pause> list_pauses(const recording::Recording& recording, double& unassigned) {
  std::vector<Pause> pauses;
  std::size_t group = 0, group_run = 0;
  double group_start = -std::numeric_limits<double>::infinity();
  const auto add = [&](std::size_t run_number, double time, double length, double speed) {
    if (run_number != group_run || time - group_start > kGroup) {
      group += !pauses.empty();
      group_run = run_number;
      group_start = time;
    }
    pauses.push_back({length, speed, group});
  };
  for (const UnbrokenStretch& stretch : unbroken_stretches(recording)) {
    const recording::Run& run = *stretch.run;
    if (stretch.first > 0) {
      const double length = run.time[stretch.first] - run.time[stretch.first - 1];
      if (length > kLongest) unassigned += length;
      if (length <= kLongest) add(stretch.run_number, run.time[stretch.first], length, chord_speed(run, stretch.first - 1, stretch.first));
    }
    for (std::size_t i = stretch.first; i + 1 < stretch.last; ++i)
      add(stretch.run_number, run.time[i], run.time[i + 1] - run.time[i], local_speed(stretch, i));
  }
  return pauses;
}

/// Counts and times by group and range.
struct Tally {
  std::vector<std::array<double, kRanges>> count, time;
};

// The rate of each range, then the part lost of each range, then that of all. Ranges without time give NaN.
std::vector<double> rates(const Tally& tally, const std::vector<double>& times) {
  std::array<double, kRanges> count{}, time{};
  double all_count = 0, all_time = 0;
  for (std::size_t g = 0; g < tally.count.size(); ++g) {
    for (std::size_t r = 0; r < kRanges; ++r) {
      count[r] += times[g] * tally.count[g][r];
      time[r] += times[g] * tally.time[g][r];
    }
  }
  for (std::size_t r = 0; r < kRanges; ++r) {
    all_count += count[r];
    all_time += time[r];
  }
  double highest = 0;
  for (std::size_t r = 0; r < kRanges / 2; ++r) {
    if (time[r] > 0.03 * all_time) highest = std::max(highest, count[r] / time[r]);
  }
  std::vector<double> result;
  for (std::size_t r = 0; r < kRanges; ++r) result.push_back(time[r] > 0 ? count[r] / time[r] : 0);
  for (std::size_t r = 0; r < kRanges; ++r) result.push_back(highest > 0 ? 1 - result[r] / highest : 0);
  result.push_back(highest > 0 ? 1 - all_count / all_time / highest : 0);
  return result;
}

void measure_ranges(const std::vector<Pause>& pauses, Losses& losses) {
  std::vector<double> speeds;
  for (const Pause& p : pauses) speeds.push_back(p.speed);
  const double width = base::quantile(speeds, 0.98) / (kRanges - 1);
  if (!(width > 0)) return;
  Tally tally;
  tally.count.resize(pauses.back().group + 1);
  tally.time.resize(pauses.back().group + 1);
  std::array<double, kRanges> time{};
  for (const Pause& p : pauses) {
    const auto range = std::min(kRanges - 1, static_cast<std::size_t>(p.speed / width));
    tally.count[p.group][range] += 1;
    tally.time[p.group][range] += p.length;
    time[range] += p.length;
  }
  const std::vector<double> values = rates(tally, std::vector<double>(tally.count.size(), 1.0));
  const auto deviation =
      bootstrap_deviation(tally.count.size(), 200, [&](const std::vector<double>& times) { return rates(tally, times); });
  const double freedom = static_cast<double>(tally.count.size()) - 1;
  for (std::size_t r = 0; r < kRanges; ++r) {
    SpeedRange range{static_cast<double>(r) * width, static_cast<double>(r + 1) * width, time[r], {}, {}};
    if (r + 1 == kRanges) range.high = std::numeric_limits<double>::infinity();
    range.rate = interval(values[r], deviation[r], freedom);
    range.lost = interval(values[kRanges + r], deviation[kRanges + r], freedom);
    if (range.time > 0) losses.ranges.push_back(range);
  }
  losses.lost = {interval(values.back(), deviation.back(), freedom),
                 "rate of locations against that of slow beads; speed and place go together and are not told apart"};
}

// Length of the pause in which the tracer passes the middle height between two extremes.
double pause_at_middle(const recording::Run& run, std::size_t from, std::size_t to) {
  const double middle = 0.5 * (run.position[1][from] + run.position[1][to]);
  const bool rising = run.position[1][to] > run.position[1][from];
  for (std::size_t i = from; i < to; ++i) {
    const double next = run.position[1][i + 1];
    if (rising ? next >= middle : next <= middle) return run.time[i + 1] - run.time[i];
  }
  return 0;
}

// Points that come at random leave out a given instant for so long in 2 % of all cases: (1 + 6) e⁻⁶.
double limit_of_passage(const recording::Recording& recording) { return 6 * median_interval(recording) / std::numbers::ln2; }

void measure_passages(const recording::Recording& recording, const Circulations& circulations, Losses& losses) {
  const double limit = limit_of_passage(recording);
  std::array<double, 2> all{}, missed{};  // falling, rising
  for (std::size_t i = 1; i < circulations.extremes.size(); ++i) {
    const Extreme &from = circulations.extremes[i - 1], &to = circulations.extremes[i];
    if (!to.continues || to.run != from.run) continue;
    all[to.top] += 1;
    missed[to.top] += pause_at_middle(recording.runs[to.run], from.point, to.point) > limit;
  }
  for (const std::size_t rising : {0, 1}) {
    Finding& finding = rising ? losses.missed_rising : losses.missed_falling;
    if (all[rising] < 10) {
      finding.note = "fewer than ten of them";
      continue;
    }
    finding = {
        proportion(missed[rising], all[rising]),
        fmt::format("{:.0f} of {:.0f} pass their middle height unseen for more than {:.0f} ms", missed[rising], all[rising], limit * 1e3)};
  }
}

}  // namespace

Losses measure_losses(const recording::Recording& recording, const Circulations& circulations) {
  Losses losses;
  const std::vector<Pause> pauses = list_pauses(recording, losses.unassigned);
  losses.lost.note = "fewer than 200 pauses between points";
  if (pauses.size() >= 200) measure_ranges(pauses, losses);
  measure_passages(recording, circulations, losses);
  return losses;
}

}  // namespace millscope::inspect
