// Where the beads are, and how fast: distributions along x, y, z, from the axis outwards, and of speed over shell speed (Chagas 2015).
//
//   percent in a bin     100 Σ_bin w / Σ w         w = time that a sample stands for, s
//   cumulative           percent below each edge
//   radial density       (Σ_ring w / Σ w) / (area of the ring), 1/m²
//
// What lies outside the bins is not moved into them: it stands in `…_outside_percent`.
#include <array>
#include <numbers>
#include <vector>

#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    integer_parameter("bins_x", 50, 1, 100000, "Bins across the mill, from shell to shell; 50 are 6 mm each in a mill of 300 mm."),
    integer_parameter("bins_y", 50, 1, 100000, "Bins up the mill, from shell to shell."),
    integer_parameter("bins_z", 50, 1, 100000, "Bins along the axis, from end face to end face."),
    integer_parameter("bins_r", 50, 1, 100000, "Bins from the axis to the shell."),
    integer_parameter("bins_speed", 60, 1, 100000, "Bins of speed over shell speed."),
    number_parameter("largest_speed", "1", 3, 1e-6, 1e6, "Upper edge of the last bin of speed over shell speed."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

/// One coordinate. Its array has a slot below and one above the bins, so that nothing gets lost.
struct Axis {
  const char* array;  ///< name of the additive array
  const char *edges, *percent, *cumulative, *outside;
  const char* unit;
  const char* what;  ///< ends the sentence "Percent of the beads' time per bin …"
  Bins bins;
  bool known;  ///< false: its range or its scale is unknown, so it is left out
};

enum Coordinate { kX, kY, kZ, kR, kRelativeSpeed, kCoordinates };

class Distributions {
 public:
  static constexpr std::uint64_t kNeeds = 0;  // without velocities: where the beads are

  Distributions(const Parameters& p, const AnalyzerContext& context)
      : range_(axial_range(p, context)),
        charge_count_(context.charge_count),
        shell_speed_((context.has & kHasVelocity) != 0 ? std::fabs(context.omega) * shell_radius(context) : 0) {
    const double shell = context.mill_radius;
    const bool ends = context.mill_high > context.mill_low;
    const Bins z = ends ? Bins(context.mill_low, context.mill_high, p.integer("bins_z")) : Bins();
    const Bins speed(0, p.number("largest_speed"), p.integer("bins_speed"));
    axes_ = {{
        {"time_x", "x_edges", "x_percent", "x_cumulative", "x_outside_percent", "m", "along x", {-shell, shell, p.integer("bins_x")}, true},
        {"time_y", "y_edges", "y_percent", "y_cumulative", "y_outside_percent", "m", "along y", {-shell, shell, p.integer("bins_y")}, true},
        {"time_z", "z_edges", "z_percent", "z_cumulative", "z_outside_percent", "m", "along the axis", z, ends},
        {"time_r",
         "r_edges",
         "r_percent",
         "r_cumulative",
         "r_outside_percent",
         "m",
         "from the axis outwards",
         {0, shell, p.integer("bins_r")},
         true},
        {"time_speed", "speed_ratio_edges", "speed_ratio_percent", "speed_ratio_cumulative", "speed_ratio_outside_percent", "1",
         "of speed over shell speed", speed, shell_speed_ > 0},
    }};
  }

  std::vector<ArrayInfo> arrays() const {
    std::vector<ArrayInfo> all;
    for (const Axis& axis : axes_) all.push_back(additive(axis.array, "s", {static_cast<std::uint64_t>(axis.bins.count) + 2}));
    return all;
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    const double per_shell_speed = shell_speed_ > 0 ? 1 / shell_speed_ : 0;  // 0: not known, or there are no velocities
    for (std::int64_t s = block.first[0]; s < block.first[block.frame_count]; ++s) {
      const double x = block.position[0][s], y = block.position[1][s], z = block.position[2][s], weight = block.weight[s];
      if (!range_.contains(z)) continue;
      sums[kX][axes_[kX].bins.slot(x)] += weight;
      sums[kY][axes_[kY].bins.slot(y)] += weight;
      sums[kZ][axes_[kZ].bins.slot(z)] += weight;
      sums[kR][axes_[kR].bins.slot(std::sqrt(x * x + y * y))] += weight;
      if (!(shell_speed_ > 0)) continue;
      const double u = block.velocity[0][s], v = block.velocity[1][s], w = block.velocity[2][s];
      sums[kRelativeSpeed][axes_[kRelativeSpeed].bins.slot(std::sqrt(u * u + v * v + w * w) * per_shell_speed)] += weight;
    }
  }

  void finish(const double* const* sums, Results& results) const {
    for (std::size_t c = 0; c < kCoordinates; ++c) {
      if (axes_[c].known) add_distribution(results, axes_[c], sums[c]);
    }
    add_radial_density(results, sums[kR]);
    if (shell_speed_ > 0) results.add("shell_speed", "m/s", shell_speed_, "Speed of the bare shell, |Omega| R.");
  }

 private:
  static double total(const double* slots, const Bins& bins) {
    double sum = 0;
    for (std::int64_t i = 0; i < bins.count + 2; ++i) sum += slots[i];
    return sum;
  }

  void add_distribution(Results& results, const Axis& axis, const double* slots) const {
    const auto count = as_size(axis.bins.count);
    const double all = total(slots, axis.bins);
    std::vector<double> percent(count), cumulative(count + 1);
    double below = slots[0];
    cumulative[0] = 100 * ratio(below, all);
    for (std::size_t i = 0; i < count; ++i) {
      percent[i] = 100 * ratio(slots[i + 1], all);
      below += slots[i + 1];
      cumulative[i + 1] = 100 * ratio(below, all);
    }
    const std::string what = axis.what;
    results.add(axis.edges, axis.unit, axis.bins.edges().data(), {count + 1}, ("Edges of the bins " + what + ".").c_str(), {},
                &axis == &axes_[kX] ? kAlongX : 0U);
    results.add(axis.percent, "%", percent.data(), {count}, ("Percent of the beads' time per bin " + what + ".").c_str(), {axis.edges},
                kShare);
    results.add(axis.cumulative, "%", cumulative.data(), {count + 1}, ("Percent of the beads' time below each edge, " + what + ".").c_str(),
                {axis.edges}, kShare | kCumulative);
    results.add(axis.outside, "%", 100 * ratio(slots[0] + slots[count + 1], all),
                ("Percent of the beads' time outside the bins " + what + ".").c_str(), kShare);
  }

  void add_radial_density(Results& results, const double* slots) const {
    const Bins& rings = axes_[kR].bins;
    const double all = total(slots, rings);
    std::vector<double> density(as_size(rings.count));
    for (std::int64_t i = 0; i < rings.count; ++i) {
      const double inner = rings.edge(i), outer = rings.edge(i + 1);
      element(density, i) = ratio(slots[i + 1], all) / (std::numbers::pi * (outer * outer - inner * inner));
    }
    results.add("radial_density", "1/m^2", density.data(), {density.size()}, "Fraction of the beads' time per area of the ring.",
                {"r_edges"});
    if (!(charge_count_ > 0)) return;
    for (double& d : density) d *= charge_count_;
    results.add("radial_number_density", "1/m^2", density.data(), {density.size()},
                "Beads of the whole charge per area of the ring, seen along the axis.", {"r_edges"});
  }

  AxialRange range_;
  double charge_count_, shell_speed_;  ///< speed: 0 where none is compared with it
  std::array<Axis, kCoordinates> axes_{};
};

constexpr Descriptor kDescriptor = describe<Distributions>({
    .name = "distributions",
    .version = "0.1.0",
    .doc = "Distributions along x, y, z and the radius, and of speed over shell speed, with their cumulative forms.",
    .equation = "percent = 100 sum_bin w / sum w",
    .citation = "Chagas 2015, Calibration of DEM contact parameters for tumbling mills using PEPT",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
