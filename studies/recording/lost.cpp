// Rows in which a tracker says that it has lost the bead.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

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

/// A place with one number three times, (0, 0, 0) or (-1, -1, -1), that comes twice; or any that the bead leaves and comes back to. Rows
/// that were written twice, with their times, are one visit.
std::vector<Place> signs(const Run& rows, bool fine) {
  struct Visits {
    std::size_t rows = 0;
    int times = 0;
    double latest = -std::numeric_limits<double>::infinity();  // s
  };
  std::map<Place, Visits> visited;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Place here = place(rows, i);
    Visits& v = visited[here];
    ++v.rows;
    const bool fresh = rows.time[i] > v.latest;
    v.times += fresh && (i == 0 || place(rows, i - 1) != here);
    if (fresh) v.latest = rows.time[i];
  }
  std::vector<Place> equal, left;
  for (const auto& [here, v] : visited) {
    if (here[0] == here[1] && here[1] == here[2] && v.rows > 1)
      equal.push_back(here);
    else if (fine && v.times >= kSign)
      left.push_back(here);
  }
  if (left.size() <= kSigns) equal.insert(equal.end(), left.begin(), left.end());
  std::sort(equal.begin(), equal.end());
  return equal;
}

/// Marks rows that repeat the place of the row before. Two in a row happen by chance where one row follows the other at once; three do not,
/// nor do pairs that are more than one row in a hundred.
void mark_repeats(const Run& rows, std::vector<char>& keep) {
  constexpr double kChance = 0.01;
  const auto again = [&](std::size_t i) { return i > 0 && place(rows, i - 1) == place(rows, i) && rows.time[i - 1] != rows.time[i]; };
  std::size_t repeats = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) repeats += again(i);
  const bool many = static_cast<double>(repeats) > kChance * static_cast<double>(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool thrice = again(i - 1) || (i + 1 < rows.size() && again(i + 1));
    if (again(i) && (many || thrice)) keep[i] = 0;
  }
}

}  // namespace

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
