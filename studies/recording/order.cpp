// Time order: rows that run backwards, false times, a clock that was set back, duplicates.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "kernel/base/statistics.hpp"
#include "studies/recording/clean.hpp"
#include "studies/recording/select.hpp"

namespace millscope::recording {
namespace {

constexpr std::size_t kLeastRows = 5;  // a shorter stretch of earlier times is disorder, which is sorted
constexpr double kSetBack = 1;         // s

/// Not a row whose time lies more than a second from both neighbours, which agree with each other, nor one a year away from the others.
std::vector<char> true_times(const std::vector<double>& time) {
  constexpr double kYear = 3.2e7;  // s
  std::vector<char> keep(time.size(), 1);
  if (time.empty()) return keep;
  std::vector<double> some;
  for (std::size_t i = 0; i < time.size(); i += time.size() / 10000 + 1) some.push_back(time[i]);
  const double middle = base::quantile(some, 0.5);
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

/// The rows of a part by their time, to which more are added as the part grows: a sorted list, and beside it a small set of the newest.
class PartRows {
 public:
  PartRows(const Run& rows, std::size_t first) : rows_(&rows), next_(first), newest_(Earlier{&rows}) {}

  /// Takes in the rows before `last`; those that are there already, to the bit, need no second place.
  void grow(std::size_t last) {
    const bool many = last - next_ > sorted_.size() / 4;
    for (; next_ < last; ++next_) {
      latest_ = std::max(latest_, rows_->time[next_]);
      if (many) sorted_.push_back(next_);
      if (!many && !holds(next_)) newest_.insert(next_);
    }
    if (!many && newest_.size() <= sorted_.size() / 4) return;
    sorted_.insert(sorted_.end(), newest_.begin(), newest_.end());
    newest_.clear();
    std::sort(sorted_.begin(), sorted_.end(), Earlier{rows_});
  }

  /// Whether a row of this time and place is there.
  bool holds(std::size_t i) const {
    const auto same = [&](std::size_t j) {
      return std::all_of(rows_->position.begin(), rows_->position.end(),
                         [&](const auto& component) { return component[i] == component[j]; });
    };
    const auto old = std::equal_range(sorted_.begin(), sorted_.end(), i, Earlier{rows_});
    const auto fresh = newest_.equal_range(i);
    return std::any_of(old.first, old.second, same) || std::any_of(fresh.first, fresh.second, same);
  }
  double latest() const { return latest_; }  ///< s

 private:
  struct Earlier {
    const Run* rows;
    bool operator()(std::size_t i, std::size_t j) const { return rows->time[i] < rows->time[j]; }
  };
  const Run* rows_;
  std::size_t next_;
  double latest_ = -std::numeric_limits<double>::infinity();
  std::vector<std::size_t> sorted_;
  std::multiset<std::size_t, Earlier> newest_;
};

/// Whether the rows of a stretch, as far as they lie in time that the part covers, are mostly rows of the part over again.
bool repeats(const Run& rows, PartRows& part, const Stretch& stretch) {
  part.grow(stretch.first);
  std::size_t covered = 0, same = 0;
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    if (rows.time[i] > part.latest()) continue;
    ++covered;
    same += part.holds(i);
  }
  return 2 * same > covered;
}

/// Times that a part covers, in spans that do not overlap.
class Cover {
 public:
  bool empty() const { return spans_.empty(); }
  bool overlaps(const Stretch& s) const {
    const auto behind = spans_.lower_bound(s.high);
    return behind != spans_.begin() && std::prev(behind)->second > s.low;
  }
  void add(const Stretch& s) {
    double low = s.low, high = s.high;
    for (auto at = spans_.lower_bound(high); at != spans_.begin() && std::prev(at)->second > low;) {
      --at;
      low = std::min(low, at->first);
      high = std::max(high, at->second);
      at = spans_.erase(at);
    }
    double& end = spans_.try_emplace(low, high).first->second;
    end = std::max(end, high);
  }

 private:
  std::map<double, double> spans_;  // s: from, to
};

/// Half of the steps from row to row are shorter, m.
double usual_step(const Run& rows) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < rows.size(); i += rows.size() / 10000 + 1) steps.push_back(distance(rows, i - 1, i));
  return steps.empty() ? 0 : base::quantile(steps, 0.5);
}

/// Rows at which the clock was set back for good: a stretch begins that covers time which the part covers already, with other points; or
/// the bead goes on where it was, as when a counter begins again at zero, while rows that were written out of order begin elsewhere.
std::vector<std::size_t> resets(const Run& rows) {
  const std::vector<Stretch> all = stretches(rows.time);
  if (all.size() < 2) return {};
  constexpr double kSteps = 4;
  const double near = kSteps * usual_step(rows);
  std::vector<std::size_t> found;
  Cover cover;
  PartRows part(rows, 0);
  for (const Stretch& stretch : all) {
    if (!stretch.is_long()) continue;
    const bool goes_on = stretch.first > 0 && distance(rows, stretch.first - 1, stretch.first) <= near;
    if ((cover.overlaps(stretch) && !repeats(rows, part, stretch)) || (goes_on && stretch.high < rows.time[stretch.first - 1])) {
      found.push_back(stretch.first);
      cover = {};
    }
    if (cover.empty()) part = PartRows(rows, stretch.first);
    cover.add(stretch);
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

}  // namespace

void sort_by_time(Run& run) {
  for (std::size_t i = 1; i < run.size(); ++i) run.report.backwards += run.time[i] < run.time[i - 1];
  if (run.report.backwards == 0) return;
  std::vector<std::size_t> order(run.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return run.time[i] < run.time[j]; });
  reorder(run, order);
}

namespace {

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

std::vector<Run> order_rows(Run whole) {
  const RunReport report = whole.report;
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
    head.lost = report.lost;
    head.false_times = whole.report.false_times;
  }
  for (Run& run : runs) {
    sort_by_time(run);
    drop_duplicates(run);
  }
  return runs;
}

}  // namespace millscope::recording
