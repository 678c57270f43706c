#include "studies/wear/wear_away.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/base/error.hpp"

namespace millscope::wear {
namespace {

constexpr int kSearches = 60;
constexpr double kNear = 1e-6;     // of the volume of a row
constexpr double kMostOff = 1e-3;  // of it
constexpr double kRadial = 1e-6;   // of a line's length across a direction: it points to the axis

/// The radius in every direction that the line from a to b crosses becomes at least that of the line: the metal on the way is gone.
void reach(std::vector<double>& radius, double step, const Place& a, const Place& b) {
  const double first = std::atan2(a.y, a.x), last = first + std::remainder(std::atan2(b.y, b.x) - first, kTurn);
  const auto columns = static_cast<long>(radius.size());
  const double dx = b.x - a.x, dy = b.y - a.y, moment = a.x * b.y - a.y * b.x;
  const double span = std::hypot(dx, dy), farther = std::max(std::hypot(a.x, a.y), std::hypot(b.x, b.y));
  for (auto k = static_cast<long>(std::ceil(std::min(first, last) / step)); static_cast<double>(k) * step <= std::max(first, last); ++k) {
    const double across = std::cos(static_cast<double>(k) * step) * dy - std::sin(static_cast<double>(k) * step) * dx;
    double& r = radius[static_cast<std::size_t>((k % columns + columns) % columns)];
    // Along the direction itself both are but rounding.
    r = std::max(r, std::fabs(across) <= kRadial * span ? farther : std::min(moment / across, farther));
  }
}

/// A row whose stretches have moved by `depth`, m.
std::vector<double> moved(const Profile& p, const Stretches& s, std::size_t row, const std::vector<double>& depth) {
  std::vector<double> radius(p.radius.begin() + static_cast<std::ptrdiff_t>(row * p.columns),
                             p.radius.begin() + static_cast<std::ptrdiff_t>((row + 1) * p.columns));
  Place before{};
  bool has_before = false;
  for (std::size_t c = 0; c <= p.columns; ++c) {  // the first column again, for the corner between the last and the first
    const std::size_t column = c % p.columns;
    for (std::size_t part = 0; part < s.parts[column]; ++part) {
      const auto share = [&](std::size_t k) { return static_cast<double>(k) / static_cast<double>(s.parts[column]); };
      const Place a = place_of(p, row, c, share(part)), b = place_of(p, row, c, share(part + 1));
      const double length = std::hypot(b.x - a.x, b.y - a.y), d = depth[s.first[column] + part];
      const double nx = (b.y - a.y) / length * d, ny = -(b.x - a.x) / length * d;
      const Place outer_a{a.x + nx, a.y + ny}, outer_b{b.x + nx, b.y + ny};
      if (d > 0) {
        reach(radius, p.step(), a, outer_a);
        reach(radius, p.step(), outer_a, outer_b);
        reach(radius, p.step(), outer_b, b);
      }
      if (has_before) reach(radius, p.step(), before, outer_a);
      before = outer_b;
      has_before = true;
      if (c == p.columns) break;
    }
  }
  return radius;
}

/// m² between two chords from a direction to the next, each given by its radii, m.
double area_between(const std::array<double, 2>& before, const std::array<double, 2>& after, double step) {
  return 0.5 * std::sin(step) * (after[0] * after[1] - before[0] * before[1]);
}

/// m² between two rows, of one pitch.
double area_between(const double* before, const std::vector<double>& after, double step) {
  double area = 0;
  const std::size_t n = after.size();
  for (std::size_t c = 0; c < n; ++c) area += area_between({before[c], before[(c + 1) % n]}, {after[c], after[(c + 1) % n]}, step);
  return area;
}

/// Moves one row until it has lost `area`, m²; returns the factor on the depths.
double wear_row(Profile& p, const Stretches& s, std::size_t row, const std::vector<double>& depth, double area) {
  const double* before = p.radius.data() + row * p.columns;
  std::vector<double> scaled(depth.size()), best;
  const auto lost = [&](double factor) {
    std::transform(depth.begin(), depth.end(), scaled.begin(), [factor](double d) { return factor * d; });
    best = moved(p, s, row, scaled);
    return area_between(before, best, p.step());
  };
  double low = 0, high = 1;
  while (lost(high) < area && high < 1e3) high *= 2;
  double factor = high;
  for (int k = 0; k < kSearches; ++k) {
    factor = 0.5 * (low + high);
    const double found = lost(factor);
    if (std::fabs(found - area) < kNear * area) break;
    (found < area ? low : high) = factor;
  }
  if (std::fabs(area_between(before, best, p.step()) - area) > kMostOff * area) {
    throw base::UserError("wear: the liner cannot lose what the laws say in one step without a hole; give more --steps");
  }
  std::copy(best.begin(), best.end(), p.radius.begin() + static_cast<std::ptrdiff_t>(row * p.columns));
  return factor;
}

}  // namespace

double wear_away(Profile& p, const Stretches& s, const std::vector<double>& volume) {
  double greatest = 0;
  const std::size_t n = s.count();
  const double pitches = p.pitches, along = p.row_length();
  for (std::size_t row = 0; row < p.rows; ++row) {
    const std::vector<double> lengths = lengths_of(p, s, row);
    std::vector<double> depth(n);
    double area = 0;
    for (std::size_t k = 0; k < n; ++k) {
      area += volume[row * n + k] / (pitches * along);
      depth[k] = volume[row * n + k] / (pitches * along * lengths[k]);
    }
    if (!(area > 0)) continue;
    const double factor = wear_row(p, s, row, depth, area);
    greatest = std::max(greatest, factor * *std::max_element(depth.begin(), depth.end()));
  }
  return greatest;
}

std::vector<double> volumes_between(const Profile& before, const Profile& after) {
  std::vector<double> volumes(before.columns, 0.0);
  const double of_area = before.row_length() * before.pitches;
  for (std::size_t row = 0; row < before.rows; ++row) {
    for (std::size_t c = 0; c < before.columns; ++c)
      volumes[c] +=
          of_area * area_between({before.at(row, c), before.at(row, c + 1)}, {after.at(row, c), after.at(row, c + 1)}, before.step());
  }
  return volumes;
}

}  // namespace millscope::wear
