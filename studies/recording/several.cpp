// Files that hold more than one bead, or no bead's places at all.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  constexpr double kNear = 0.25, kDigits = 10;
  const double far = kDigits * last_digit(rows);
  std::size_t all = 0, found = 0;
  for (std::size_t i = 0; i + 2 < rows.size(); i += stride, ++all) {
    const double step = distance(rows, i, i + 1);
    found += step > far && distance(rows, i, i + 2) < kNear * step;
  }
  return all == 0 ? 0 : static_cast<double>(found) / static_cast<double>(all);
}

/// Whether rows that follow one another lie as far apart as any two, farther than a camera's noise and than a bead can fly.
bool is_random(const Run& rows, std::size_t stride) {
  constexpr double kAsFar = 0.7, kNoise = 0.02;  // m, of a difference
  const std::size_t half = rows.size() / 2;
  std::vector<double> near, far, pauses;
  for (std::size_t i = 0; i + 1 < half; i += stride) {
    near.push_back(distance(rows, i, i + 1));
    far.push_back(distance(rows, i, i + half));
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
  if (names.empty()) return {std::move(table.rows)};
  std::vector<std::size_t> beads;  // labels of some; -1 and what nobody wants tell not how many there are
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!is_no_bead(table.labels[k]) && (wanted.empty() || of_beads(names[k]))) beads.push_back(k);
  }
  if (beads.empty()) throw UserError(where, "no row has the label of a bead");
  std::vector<std::vector<std::size_t>> rows(names.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < table.label.size(); ++i) rows[table.label[i]].push_back(i);
  for (const std::size_t k : beads) kept += rows[k].size();
  const bool numbers_rows = beads.size() > kMostBeads || kept < kFewestRows * beads.size();
  std::vector<Run> runs;
  if (wanted.empty() && (beads.size() == 1 || numbers_rows)) {
    std::vector<std::size_t> all;
    for (const std::size_t k : beads) all.insert(all.end(), rows[k].begin(), rows[k].end());
    std::sort(all.begin(), all.end());
    runs.push_back(chosen(table.rows, all));
  } else {
    for (const std::size_t k : beads) runs.push_back(chosen(table.rows, rows[k])), runs.back().name = names[k];
  }
  for (Run& run : runs) run.report.rows = run.report.used = run.size();
  // Lines that hold no point, and points of no bead, belong to no run: the first carries them.
  RunReport& head = runs.front().report;
  head.rows += table.rows.report.rows - table.rows.size();
  head.unreadable = table.rows.report.unreadable;
  head.not_finite = table.rows.report.not_finite;
  carry_lost(runs.front(), table.rows.size() - kept);
  return runs;
}

void refuse_several(const Run& rows, const std::filesystem::path& file) {
  constexpr std::size_t kEnough = 100, kSample = 50000;
  constexpr double kTurns = 0.2;
  if (rows.size() < kEnough) return;
  const std::size_t stride = rows.size() / kSample + 1;
  // One bead that two programs wrote in turns is in order by time; a clock that was set back is in the order of the file.
  Run in_order = rows;
  sort_by_time(in_order);
  if (turns(rows, stride) > kTurns && turns(in_order, stride) > kTurns)
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
