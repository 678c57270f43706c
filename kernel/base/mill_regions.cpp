#include "kernel/base/mill_regions.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace millscope::base {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::array<double, 4> kRings{0, 0.5, 0.8, 1};  // of R; the outermost takes what lies beyond, too
constexpr int kSectors = 8;

/// Degrees from 6 o'clock, positive in the turning sense, −180…180.
double clock_angle(double x, double y, double sense) { return std::atan2(sense * x, -y) * kDegrees; }

std::string signed_angle(double degrees) {
  return degrees < 0 ? fmt::format("{:.0f}° before 6 o'clock", -degrees) : fmt::format("{:.0f}° past 6 o'clock", degrees);
}

std::string region_name(std::size_t ring, int sector) {
  const double from = sector * 360.0 / kSectors - 180, to = from + 360.0 / kSectors;
  const std::string angles =
      from < 0 ? fmt::format("{:.0f}–{:.0f}° before", std::abs(to), -from) : fmt::format("{:.0f}–{:.0f}° past", from, to);
  return fmt::format("{}–{} R, {} 6 o'clock", kRings[ring], kRings[ring + 1], angles);
}

/// A point at a ring's radius and an angle from 6 o'clock.
std::array<double, 2> at(const MillPlace& mill, std::size_t ring, double degrees) {
  const double radius = kRings[ring] * mill.radius, angle = degrees / kDegrees;
  return {mill.sense * radius * std::sin(angle), -radius * std::cos(angle)};
}

using Line = std::vector<std::array<double, 2>>;

Line arc(const MillPlace& mill, std::size_t ring, int sector) {
  constexpr int kSteps = 24;
  Line line;
  for (int i = 0; i <= kSteps; ++i) line.push_back(at(mill, ring, (sector + static_cast<double>(i) / kSteps) * 360.0 / kSectors - 180));
  return line;
}

}  // namespace

MillPlace mill_place(double radius, double omega) { return {radius, omega > 0 ? 1.0 : omega < 0 ? -1.0 : 0.0}; }

std::vector<Region> regions_of(std::span<const double> y_edges, std::span<const double> x_edges, const MillPlace& mill) {
  if (!mill.known()) return {};
  std::vector<Region> all;
  for (std::size_t ring = 0; ring + 1 < kRings.size(); ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) all.push_back({region_name(ring, sector), {}, ring, sector});
  }
  const std::size_t nx = x_edges.size() - 1, ny = y_edges.size() - 1;
  for (std::size_t iy = 0; iy < ny; ++iy) {
    for (std::size_t ix = 0; ix < nx; ++ix) {
      const double px = std::midpoint(x_edges[ix], x_edges[ix + 1]), py = std::midpoint(y_edges[iy], y_edges[iy + 1]);
      const double r = std::hypot(px, py) / mill.radius;
      const std::size_t ring = r < kRings[1] ? 0 : r < kRings[2] ? 1 : 2;
      const int sector = std::min(kSectors - 1, static_cast<int>((clock_angle(px, py, mill.sense) + 180) * kSectors / 360));
      all[ring * kSectors + sector].cells.push_back(iy * nx + ix);
    }
  }
  std::erase_if(all, [](const Region& region) { return region.cells.empty(); });
  return all;
}

std::vector<Line> borders_of(const std::vector<Region>& regions, const std::vector<bool>& chosen, const MillPlace& mill) {
  std::array<std::array<bool, kSectors>, kRings.size()> is_chosen{};  // the last ring lies outside the mill
  for (std::size_t i = 0; i < regions.size(); ++i) is_chosen[regions[i].ring][regions[i].sector] = chosen[i];
  std::vector<Line> lines;
  for (std::size_t ring = 0; ring + 1 < kRings.size(); ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const bool here = is_chosen[ring][sector];
      const bool outside = is_chosen[ring + 1][sector], before = is_chosen[ring][(sector + kSectors - 1) % kSectors];
      if (here != outside) lines.push_back(arc(mill, ring + 1, sector));
      const double from = sector * 360.0 / kSectors - 180;
      if (here != before) lines.push_back({at(mill, ring, from), at(mill, ring + 1, from)});
    }
  }
  return lines;
}

std::string place_in_mill(double x, double y, const MillPlace& mill) {
  if (!mill.known()) return "";
  return fmt::format("{:.2f} R, {}", std::hypot(x, y) / mill.radius, signed_angle(clock_angle(x, y, mill.sense)));
}

}  // namespace millscope::base
