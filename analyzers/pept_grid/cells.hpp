// The cells of a map: a grid of two or three coordinates in the mill's frame.
//
//   grid         coordinates, the slowest first     unit
//   xy           y, x                               m
//   cylindrical  r, θ                               m, degrees
//   xyz          z, y, x                            m
//   r_theta_z    z, r, θ                            m, m, degrees
//
// θ counts from 6 o'clock, positive in the turning sense, −180°…180°; maps of mills that turn either way then lie on each other.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

namespace millscope::analyzers {

class Cells {
 public:
  /// Reads `grid`, `cells_…` and `half_width`; refuses what the chosen grid needs and nobody gave.
  Cells(const Parameters& parameters, const AnalyzerContext& context, const AxialRange& range)
      : shell_(context.mill_radius), sense_(turning_sense(context)) {
    const std::string grid = parameters.text("grid");
    polar_ = grid == "cylindrical" || grid == "r_theta_z";
    axial_ = grid == "xyz" || grid == "r_theta_z";
    const double half = parameters.given("half_width") ? parameters.number("half_width") : shell_radius(context);
    if (polar_) {
      sense_ = known_sense(context);
      fast_ = Bins(-std::numbers::pi, std::numbers::pi, parameters.integer("cells_theta"));
      middle_ = Bins(0, half, parameters.integer("cells_r"));
    } else {
      fast_ = Bins(-half, half, parameters.integer("cells_x"));
      middle_ = Bins(-half, half, parameters.integer("cells_y"));
    }
    if (axial_) slow_ = axial_bins(range, context, parameters.integer("cells_z"));
    length_ = axial_ ? slow_.width() : range.length;
    constexpr std::int64_t kMost = 2'000'000;  // 160 MB per sum, of which the host keeps many
    if (count() > kMost) throw Refusal("the grid has " + std::to_string(count()) + " cells, more than 2000000: choose larger cells");
  }

  bool polar() const { return polar_; }
  bool axial() const { return axial_; }
  double sense() const { return sense_; }  ///< ±1; 0: unknown
  std::int64_t count() const { return fast_.count * middle_.count * slow_.count; }
  const Bins& fast() const { return fast_; }
  const Bins& middle() const { return middle_; }
  const Bins& slow() const { return slow_; }

  /// Number of the cell; none outside.
  template <bool polar, bool axial>
  std::optional<std::int64_t> at(double x, double y, double z) const {
    const std::optional<std::int64_t> a = polar ? fast_.at(angle_of(sense_ * x, -y)) : fast_.at(x);
    const std::optional<std::int64_t> b = polar ? middle_.at(std::sqrt(x * x + y * y)) : middle_.at(y);
    const std::optional<std::int64_t> c = axial ? slow_.at(z) : 0;
    if (!a || !b || !c) return std::nullopt;
    return (*c * middle_.count + *b) * fast_.count + *a;
  }

  /// Volume of each cell inside the bare shell, m³; empty where the length or the shell is unknown.
  std::vector<double> volumes() const {
    std::vector<double> all;
    if (!(length_ > 0) || !(shell_ > 0)) return all;
    for (std::int64_t c = 0; c < slow_.count; ++c) {
      for (std::int64_t b = 0; b < middle_.count; ++b) {
        for (std::int64_t a = 0; a < fast_.count; ++a) all.push_back(length_ * area(a, b));
      }
    }
    return all;
  }

 private:
  static Bins axial_bins(const AxialRange& range, const AnalyzerContext& context, std::int64_t count) {
    if (std::isfinite(range.low) && std::isfinite(range.high)) return {range.low, range.high, count};
    if (context.mill_high > context.mill_low && !std::isfinite(range.low) && !std::isfinite(range.high)) {
      return {context.mill_low, context.mill_high, count};
    }
    throw Refusal("a grid along z needs both ends of its range: give z_from and z_to, or 'ends' in the recording's frame");
  }
  double area(std::int64_t a, std::int64_t b) const {
    if (!polar_) return area_in_circle(fast_.edge(a), fast_.edge(a + 1), middle_.edge(b), middle_.edge(b + 1), shell_);
    const double inner = std::fmin(middle_.edge(b), shell_), outer = std::fmin(middle_.edge(b + 1), shell_);
    return 0.5 * (outer * outer - inner * inner) * fast_.width();
  }

  double shell_, sense_, length_ = 0;
  bool polar_ = false, axial_ = false;
  Bins fast_, middle_, slow_{0, 1, 1};
};

}  // namespace millscope::analyzers
