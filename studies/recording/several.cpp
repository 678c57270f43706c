// Files that hold more than one bead, or no bead's places at all.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "kernel/base/statistics.hpp"
#include "studies/recording/clean.hpp"
#include "studies/recording/select.hpp"
#include "studies/recording/travel.hpp"

namespace millscope::recording {
namespace {

using base::UserError;

constexpr std::size_t kMostBeads = 1000, kFewestRows = 6;  // of each, on average; else a label numbers rows or places
constexpr const char* kNoBead = "-1";

bool is_no_bead(const std::string& label) { return label == kNoBead || label.starts_with("-1.0") || label.empty() || label == "nan"; }

/// "1.000" → "1": names of runs and of `labels` are short.
std::string short_label(const std::string& label) {
  if (label.find('.') == std::string::npos || label.find_first_not_of("-0123456789.") != std::string::npos) return label;
  const std::size_t last = label.find_last_not_of('0');
  return label.substr(0, label[last] == '.' ? last : last + 1);
}

void reserve_points(Run& run, const Run& like, std::size_t count) {
  run.time.reserve(count);
  for (auto& x : run.position) x.reserve(count);
  if (!like.spread.empty()) run.spread.reserve(count);
  if (!like.events.empty()) run.events.reserve(count);
}

void append_point(Run& run, const Run& from, std::size_t i) {
  run.time.push_back(from.time[i]);
  for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(from.position[axis][i]);
  if (!from.spread.empty()) run.spread.push_back(from.spread[i]);
  if (!from.events.empty()) run.events.push_back(from.events[i]);
}

double squared_distance(const Run& r, std::size_t i, std::size_t j) {
  double sum = 0;
  for (const auto& x : r.position) sum += (x[j] - x[i]) * (x[j] - x[i]);
  return sum;
}

/// In the order of time, rows of one time in that of the file.
Run in_order(Run rows) {
  if (std::is_sorted(rows.time.begin(), rows.time.end())) return rows;
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return rows.time[i] < rows.time[j]; });
  reorder(rows, order);
  return rows;
}

/// The smallest step along an axis: the last digit, or less than any that matters.
double last_digit(const Run& rows) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : rows.position) {
    for (std::size_t i = 1; i < x.size(); ++i) {
      if (x[i] != x[i - 1]) least = std::min(least, std::fabs(x[i] - x[i - 1]));
    }
  }
  return std::isfinite(least) ? least : 0;
}

/// Part of the rows from which the next is far, by many last digits, while the one after it is near: two beads that take turns. One bead,
/// of which noise is all that is seen, has one in seven (differences along a line, correlated by a half: a ratio of Cauchy's).
double turns(const Run& rows, std::size_t stride) {
  constexpr double kNear = 1.0 / 16;  // squared
  constexpr double kDigits = 10;
  const double far = std::pow(kDigits * last_digit(rows), 2);
  std::size_t all = 0, found = 0;
  for (std::size_t i = 0; i + 2 < rows.size(); i += stride, ++all) {
    const double step = squared_distance(rows, i, i + 1);
    found += step > far && squared_distance(rows, i, i + 2) < kNear * step;
  }
  return all == 0 ? 0 : static_cast<double>(found) / static_cast<double>(all);
}

/// Whether rows that follow one another lie as far apart as any two, farther than a camera's noise and than a bead can fly.
bool is_random(const Run& rows, std::size_t stride) {
  constexpr double kAsFar = 0.7, kNoise = 0.02;  // m, of a difference
  const std::size_t half = rows.size() / 2;
  std::vector<double> near, far, pauses;
  for (std::size_t i = 0; i + 1 < half; i += stride) {
    near.push_back(std::sqrt(squared_distance(rows, i, i + 1)));
    far.push_back(std::sqrt(squared_distance(rows, i, i + half)));
    pauses.push_back(std::fabs(rows.time[i + 1] - rows.time[i]));
  }
  const double step = base::quantile(near, 0.5), any = base::quantile(far, 0.5), pause = base::quantile(pauses, 0.5);
  return any > kNoise && step > kAsFar * any && step > 3 * fall_speed(any) * pause;
}

}  // namespace

std::vector<Run> runs_of_labels(Table table, const std::vector<std::string>& wanted, const base::Location& where) {
  std::vector<std::string> names;
  for (const std::string& label : table.labels) names.push_back(short_label(label));
  const auto of_beads = [&](const std::string& name) { return std::find(wanted.begin(), wanted.end(), name) != wanted.end(); };
  for (const std::string& one : wanted) {
    if (std::find(names.begin(), names.end(), one) == names.end())
      throw UserError(where, fmt::format("names the label '{}', which no row has; {}", one,
                                         names.empty() ? "the file has no column of labels that is read"
                                                       : fmt::format("there are {}", fmt::join(names, ", "))));
  }
  std::vector<std::size_t> rows_of(names.size(), 0);
  for (const std::size_t label : table.label) ++rows_of[label];
  // -1 and what nobody wants go first: neither tells how many beads there are.
  std::vector<char> keep(table.label.size(), 1);
  std::size_t beads = 0, of_beads_rows = 0;
  std::vector<std::optional<std::size_t>> place(names.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (is_no_bead(table.labels[k]) || (!wanted.empty() && !of_beads(names[k]))) continue;
    place[k] = beads++;
    of_beads_rows += rows_of[k];
  }
  const bool numbers_rows = beads > kMostBeads || of_beads_rows < kFewestRows * beads;
  if (table.label.empty()) return {std::move(table.rows)};
  if (wanted.empty() && (beads == names.size()) && (beads < 2 || numbers_rows)) return {std::move(table.rows)};
  if (wanted.empty() && (beads == 1 || numbers_rows)) {
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = static_cast<char>(place[table.label[i]].has_value());
    const RunReport before = table.rows.report;
    const std::uint64_t gone = keep_only(table.rows, keep);
    table.rows.report.lost = before.lost + gone;
    if (table.rows.size() == 0) throw UserError(where, "no row has the label of a bead");
    return {std::move(table.rows)};
  }
  std::vector<Run> runs(beads);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (place[k]) runs[*place[k]].name = names[k], reserve_points(runs[*place[k]], table.rows, rows_of[k]);
  }
  std::uint64_t lost = 0;
  for (std::size_t i = 0; i < table.label.size(); ++i) {
    if (place[table.label[i]])
      append_point(runs[*place[table.label[i]]], table.rows, i);
    else
      ++lost;
  }
  for (Run& run : runs) run.report.rows = run.report.used = run.size();
  if (runs.empty()) throw UserError(where, "no row has the label of a bead");
  // Lines that hold no point, and points of no bead, belong to no run: the first carries them.
  RunReport& head = runs.front().report;
  head.rows += table.rows.report.rows - table.rows.size() + lost;
  head.unreadable = table.rows.report.unreadable;
  head.not_finite = table.rows.report.not_finite;
  head.lost = lost;
  return runs;
}

void refuse_several(const Run& rows, const std::filesystem::path& file) {
  constexpr std::size_t kEnough = 100, kSample = 50000;
  constexpr double kTurns = 0.2;
  if (rows.size() < kEnough) return;
  const std::size_t stride = rows.size() / kSample + 1;
  // One bead that two programs wrote in turns is in order by time; a clock that was set back is in the order of the file.
  if (turns(rows, stride) > kTurns && turns(in_order(rows), stride) > kTurns)
    throw UserError(
        fmt::format("{}: the points jump to and fro between two places, as of two tracers in one file; give each its own file, or "
                    "a column with the head 'label'",
                    file.string()));
  if (is_random(rows, stride))
    throw UserError(
        fmt::format("{}: points that follow one another lie as far apart as any two, and no bead moves so; these may be lines of "
                    "response (t, x1, y1, x2, y2): locate the bead first, and give its places",
                    file.string()));
}

}  // namespace millscope::recording
