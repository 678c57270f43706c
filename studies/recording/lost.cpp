// Rows in which a tracker says that it has lost the bead.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/base/statistics.hpp"
#include "studies/recording/clean.hpp"
#include "studies/recording/select.hpp"

namespace millscope::recording {
namespace {

constexpr int kSign = 3;           // so often no place comes back by chance
constexpr std::size_t kSigns = 3;  // a tracker has one or two; more are a motion that was made up and repeats itself
constexpr double kFine = 10;       // last digits that a usual step covers along an axis

using Place = std::array<double, 3>;

Place place(const Run& rows, std::size_t i) { return {rows.position[0][i], rows.position[1][i], rows.position[2][i]}; }

/// Whether the last digit is so fine, and the bead so quick, that it cannot come to the very same place from one row to the next: along
/// two axes half of the steps that are any are ten times the smallest one.
bool moves_finely(const Run& rows) {
  int fine = 0;
  for (const std::vector<double>& x : rows.position) {
    std::vector<double> steps;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < x.size(); ++i) {
      const double step = std::fabs(x[i] - x[i - 1]);
      if (step == 0) continue;
      least = std::min(least, step);
      steps.push_back(step);
    }
    fine += steps.size() > x.size() / 10 && base::quantile(steps, 0.5) > kFine * least;
  }
  return fine >= 2;
}

/// Numbers that stand for "no place".
bool is_usual_sign(double x) {
  const double size = std::fabs(x);
  for (const double unit : {1.0, 1e-3, 1e-2}) {  // of m, mm, cm
    for (const double sign : {0.0, 1.0, 999.0, 9999.0, 99999.0}) {
      if (std::fabs(size - sign * unit) <= 1e-9 * sign * unit) return true;
    }
  }
  return false;
}

/// A place with one number three times that stands for none, (0, 0, 0) or (-1, -1, -1), and comes twice; but in most rows only of a bead
/// with a label, for else it rests there. Or any that the bead leaves and comes back to. Rows that were written twice, with their times,
/// are one visit.
std::vector<Place> signs(const Run& rows, bool fine) {
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const Place a = place(rows, i), b = place(rows, j);
    return a != b ? a < b : rows.time[i] != rows.time[j] ? rows.time[i] < rows.time[j] : i < j;
  });
  std::vector<Place> equal, left;
  for (std::size_t first = 0; first < order.size();) {
    const Place here = place(rows, order[first]);
    std::size_t last = first;
    int visits = 0;
    for (; last < order.size() && place(rows, order[last]) == here; ++last) {
      const bool again = last > first && rows.time[order[last]] == rows.time[order[last - 1]];
      const std::size_t i = order[last];
      visits += !again && (i == 0 || place(rows, i - 1) != here);
    }
    const std::size_t count = last - first;
    if (here[0] == here[1] && here[1] == here[2] && is_usual_sign(here[0]) && count > 1 && (2 * count < rows.size() || !rows.name.empty()))
      equal.push_back(here);
    else if (fine && visits >= kSign)
      left.push_back(here);
    first = last;
  }
  if (left.size() <= kSigns) equal.insert(equal.end(), left.begin(), left.end());
  std::sort(equal.begin(), equal.end());
  return equal;
}

/// Marks rows that repeat the place of the row before. Two in a row happen by chance where one row follows the other at once; three do not,
/// nor do pairs that are more than one row in a hundred. A bead that has rested goes on slowly; one that was lost is elsewhere.
void mark_repeats(const Run& rows, std::vector<char>& keep) {
  constexpr double kChance = 0.01, kSlow = 0.25;
  std::vector<double> steps;
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double step = distance(rows, i - 1, i);
    if (step > 0) steps.push_back(step);
    repeats += step == 0 && rows.time[i] != rows.time[i - 1];
  }
  if (steps.empty()) return;
  const bool many = static_cast<double>(repeats) > kChance * static_cast<double>(rows.size());
  const double usual = base::quantile(steps, 0.5);
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t last = first + 1;
    while (last < rows.size() && place(rows, last) == place(rows, first)) ++last;
    const bool held = last < rows.size() ? distance(rows, first, last) > kSlow * usual : many;
    for (std::size_t i = first + 1; held && i < last; ++i) {
      if ((many || last - first > 2) && rows.time[i] != rows.time[i - 1]) keep[i] = 0;
    }
    first = last;
  }
}

}  // namespace

void carry_lost(Run& run, std::uint64_t rows) {
  run.report.rows += rows;
  run.report.lost += rows;
}

void drop_lost(Run& rows) {
  const bool fine = moves_finely(rows);
  const std::vector<Place> none = signs(rows, fine);
  std::vector<char> keep(rows.size(), 1);
  if (fine) mark_repeats(rows, keep);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (std::binary_search(none.begin(), none.end(), place(rows, i))) keep[i] = 0;
  }
  rows.report.lost += keep_only(rows, keep);
}

}  // namespace millscope::recording
