// Time order: rows that run backwards, false times, a clock that was set back, duplicates.
#include <algorithm>
#include <numeric>

#include "studies/recording/clean.hpp"
#include "studies/recording/select.hpp"

namespace millscope::studies {
namespace {

constexpr std::size_t kLeastRows = 5;  // a shorter stretch of earlier times is disorder, which is sorted
constexpr double kSetBack = 1;         // s

/// Not a row whose time lies more than a second from both neighbours, which agree with each other, nor one a year away from the others.
std::vector<char> true_times(const std::vector<double>& time) {
  constexpr double kYear = 3.2e7;  // s
  std::vector<char> keep(time.size(), 1);
  std::vector<double> some;
  for (std::size_t i = 0; i < time.size(); i += time.size() / 10000 + 1) some.push_back(time[i]);
  const double middle = quantile(some, 0.5);
  for (std::size_t i = 0; i < time.size(); ++i) keep[i] = std::abs(time[i] - middle) < kYear;
  const auto apart = [&](std::size_t i, std::size_t j) { return std::abs(time[i] - time[j]); };
  for (std::size_t i = 1; i + 1 < time.size(); ++i) {
    const double around = apart(i - 1, i + 1);
    if (around < kSetBack && apart(i - 1, i) > kSetBack + around && apart(i, i + 1) > kSetBack + around) keep[i] = 0;
  }
  return keep;
}

/// Rows between two falls of the time by more than a second.
struct Stretch {
  std::size_t first = 0, last = 0;
  double low = 0, high = 0;  ///< s
  bool overlaps(const Stretch& other) const { return low < other.high && other.low < high; }
  bool is_long() const { return last - first >= kLeastRows; }
};

std::vector<Stretch> stretches(const std::vector<double>& time) {
  std::vector<Stretch> found;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (i == 0 || time[i] < time[i - 1] - kSetBack) found.push_back({i, i, time[i], time[i]});
    Stretch& here = found.back();
    here.last = i + 1;
    here.low = std::min(here.low, time[i]);
    here.high = std::max(here.high, time[i]);
  }
  return found;
}

/// Whether the rows of a stretch, as far as they lie in time that the part covers, are mostly rows of the part over again.
bool repeats(const Run& rows, std::size_t part_first, const Stretch& stretch) {
  const auto earlier = [&](std::size_t i, std::size_t j) { return rows.time[i] < rows.time[j]; };
  std::vector<std::size_t> known(stretch.first - part_first);
  std::iota(known.begin(), known.end(), part_first);
  std::sort(known.begin(), known.end(), earlier);
  std::size_t covered = 0, same = 0;
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    if (rows.time[i] > rows.time[known.back()]) continue;
    ++covered;
    const auto [low, high] = std::equal_range(known.begin(), known.end(), i, earlier);
    same += std::any_of(low, high, [&](std::size_t j) {
      return std::all_of(rows.position.begin(), rows.position.end(), [&](const auto& component) { return component[i] == component[j]; });
    });
  }
  return 2 * same > covered;
}

/// Rows at which the clock was set back for good: a stretch begins that covers time which the part covers already, with other points.
std::vector<std::size_t> resets(const Run& rows) {
  std::vector<std::size_t> found;
  std::vector<Stretch> part;
  Stretch hull;
  for (const Stretch& stretch : stretches(rows.time)) {
    if (!stretch.is_long()) continue;
    const auto overlapped = [&](const Stretch& other) { return stretch.overlaps(other); };
    const bool again = !part.empty() && stretch.overlaps(hull) && std::any_of(part.begin(), part.end(), overlapped);
    if (again && !repeats(rows, hull.first, stretch)) {
      found.push_back(stretch.first);
      part.clear();
    }
    if (part.empty()) hull = stretch;
    hull.low = std::min(hull.low, stretch.low);
    hull.high = std::max(hull.high, stretch.high);
    part.push_back(stretch);
  }
  return found;
}

Run cut(const Run& whole, std::size_t first, std::size_t last) {
  const auto slice = [&](const auto& values) {
    if (values.empty()) return values;
    return std::decay_t<decltype(values)>(values.begin() + static_cast<std::ptrdiff_t>(first),
                                          values.begin() + static_cast<std::ptrdiff_t>(last));
  };
  Run run;
  run.time = slice(whole.time);
  for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis] = slice(whole.position[axis]);
  run.spread = slice(whole.spread);
  run.events = slice(whole.events);
  run.report.rows = run.report.used = last - first;
  return run;
}

void sort_by_time(Run& run) {
  for (std::size_t i = 1; i < run.size(); ++i) run.report.backwards += run.time[i] < run.time[i - 1];
  if (run.report.backwards == 0) return;
  std::vector<std::size_t> order(run.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return run.time[i] < run.time[j]; });
  reorder(run, order);
}

/// Of several rows with one time the one with the smallest spread is kept, the first of the file where that does not decide.
void drop_duplicates(Run& run) {
  std::vector<char> keep(run.size(), 1);
  for (std::size_t i = 1, kept = 0; i < run.size(); ++i) {
    if (run.time[i] > run.time[kept]) {
      kept = i;
      continue;
    }
    const bool better = !run.spread.empty() && run.spread[i] < run.spread[kept];
    keep[better ? kept : i] = 0;
    if (better) kept = i;
  }
  run.report.duplicates += keep_only(run, keep);
}

}  // namespace

std::vector<Run> order_rows(Rows rows, const RunReport& report) {
  Run whole;
  whole.time = std::move(rows.time);
  whole.position = std::move(rows.position);
  whole.spread = std::move(rows.spread);
  whole.events = std::move(rows.events);
  whole.report = report;
  whole.report.false_times = keep_only(whole, true_times(whole.time));
  std::vector<std::size_t> ends = resets(whole);
  std::vector<Run> runs;
  if (ends.empty()) {
    runs.push_back(std::move(whole));
  } else {
    ends.push_back(whole.size());
    std::size_t first = 0;
    for (const std::size_t last : ends) {
      runs.push_back(cut(whole, first, last));
      first = last;
    }
    // Lines that hold no point belong to no part: the first carries them.
    RunReport& head = runs.front().report;
    head.rows += report.rows - whole.size();
    head.unreadable = report.unreadable;
    head.not_finite = report.not_finite;
    head.false_times = whole.report.false_times;
  }
  for (Run& run : runs) {
    sort_by_time(run);
    drop_duplicates(run);
  }
  return runs;
}

}  // namespace millscope::studies
