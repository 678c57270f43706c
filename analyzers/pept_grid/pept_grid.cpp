// Maps of a charge, as positron emission particle tracking gives them (Chagas 2015; Sichalwe et al. 2011), from a tracer or from all beads.
//
//   i                  cell; w = time that a sample stands for, s (dwell time of the tracer, or the frame's share of a simulation)
//   occupancy   l_i  = Σ_i w / Σ w                                  fraction of the beads' time
//   velocity  ⟨v⟩_i  = Σ_i w v / Σ_i w                              m/s;  speed ⟨|v|⟩_i
//   turning     ω    = (x v_y − y v_x)/r²,  ⟨|ω|⟩_i and ⟨ω⟩_i       rad/s
//   fluctuation T_i  = (⟨v²⟩_i − |⟨v⟩_i|²)/3 − ⟨σ_v²⟩_i             m²/s²; σ_v² is what the measurement leaves in each component
//   porosity    ε_i  = 1 − l_i f V_beads / V_i                      f: fraction of the time in the range along z
//
// A visit is an entry into a cell, seen in two samples of the same bead that follow each other without a gap.
#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "analyzers/pept_grid/cells.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    choice_parameter("grid", "xy|cylindrical|xyz|r_theta_z", "xy", "Coordinates of the cells."),
    choice_parameter("maps", "all|occupancy_and_speed", "all", "Which maps are made: fewer cost less."),
    integer_parameter("cells_x", 50, 1, 2000, "Cells across the mill; 50 are 6 mm each in a mill of 300 mm."),
    integer_parameter("cells_y", 50, 1, 2000, "Cells up the mill."),
    integer_parameter("cells_z", 10, 1, 2000, "Cells along the axis."),
    integer_parameter("cells_r", 25, 1, 2000, "Cells from the axis to the shell."),
    integer_parameter("cells_theta", 72, 1, 2000, "Cells round the axis."),
    optional(number_parameter("half_width", "m", kRequired, 1e-6, kUnbounded,
                              "Half side of the square, or radius, of the grid; without it the shell's radius.")),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

/// What a cell adds up; side by side, so that a sample touches one or two lines of the cache.
enum Moment { kTime, kVelocity0, kVelocity1, kVelocity2, kSpeed, kTurning, kSignedTurning, kSquare, kVariance, kVisits, kMoments };

class PeptGrid {
 public:
  static constexpr std::uint64_t kNeeds = 0;  // without velocities: where the beads are

  PeptGrid(const Parameters& parameters, const AnalyzerContext& context)
      : range_(axial_range(parameters, context)),
        cells_(parameters, context, range_),
        largest_id_(context.largest_id),
        has_velocity_((context.has & kHasVelocity) != 0),
        all_maps_(parameters.text("maps") == "all") {
    const double beads = context.charge_count * 4.0 / 3.0 * std::numbers::pi * std::pow(context.bead_radius, 3);
    bead_volume_ = beads > 0 ? beads : context.bead_density > 0 ? context.charge_mass / context.bead_density : 0;
  }

  std::vector<ArrayInfo> arrays() const {
    return {additive("moments", "mixed", {static_cast<std::uint64_t>(cells_.count()), kMoments}), additive("bead_time", "s"),
            additive("bead_time_in_range", "s")};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    if (cells_.polar()) return cells_.axial() ? add<true, true>(block, sums) : add<true, false>(block, sums);
    return cells_.axial() ? add<false, true>(block, sums) : add<false, false>(block, sums);
  }

  void finish(const double* const* sums, Results& results) const {
    const double* moments = sums[0];
    const double in_range = *sums[2];
    add_axes(results);
    results.add("bead_time", "s", *sums[1], "Time of all samples, summed over beads.", kBookkeeping | kNotNegative);
    results.add("in_range_fraction", "1", ratio(in_range, *sums[1]),
                "Fraction of the time inside the range along z; the maps see only this.", kShare);
    double inside = 0;
    for (std::int64_t i = 0; i < cells_.count(); ++i) inside += moments[i * kMoments + kTime];
    results.add("outside_fraction", "1", ratio(in_range - inside, in_range),
                "Fraction of the time in the range along z that lies outside the grid; occupancy sums to one less this.", kShare);
    add_field(
        results, "occupancy", "1", "Residence-time fraction of each cell; sums to one over the maps.",
        [=](const double* m) { return ratio(m[kTime], in_range); }, moments, kShare);
    if (!all_maps_) return has_velocity_ ? add_speed(results, moments) : void();
    add_field(
        results, "visits", "1", "Entries into the cell: independent visits.", [](const double* m) { return m[kVisits]; }, moments,
        kBookkeeping | kNotNegative);
    if (has_velocity_) add_velocities(results, moments);
    add_porosity(results, moments, in_range, *sums[1]);
  }

 private:
  /// Where a bead was in the frame before; no cell: outside.
  struct Seen {
    std::optional<std::int64_t> cell;
    std::int32_t piece = 0;
    bool known = false;
  };

  template <bool polar, bool axial>
  void add(const FrameBlock& block, double* const* sums) const {
    thread_local std::vector<Seen> last;
    last.assign(as_size(largest_id_) + 1, Seen{});
    double time = 0, in_range = 0;
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) {
        const double x = block.position[0][s], y = block.position[1][s], z = block.position[2][s], weight = block.weight[s];
        const bool counts = range_.contains(z);
        // A sample without weight is a trimmed one, except in the first frame, which another block has counted.
        const std::optional<std::int64_t> cell = counts && (weight > 0 || f == 0) ? cells_.at<polar, axial>(x, y, z) : std::nullopt;
        const std::int64_t id = block.id[s];
        if (id < 0 || id > largest_id_) throw Refusal("pept_grid: a sample has the id " + std::to_string(id) + ", beyond the largest one");
        Seen& seen = element(last, id);
        const bool entered = seen.known && seen.cell != cell && seen.piece == block.piece[f];
        seen = {cell, block.piece[f], true};
        time += weight;
        in_range += counts ? weight : 0;
        if (!cell) continue;
        double* m = sums[0] + *cell * kMoments;
        if (all_maps_) m[kVisits] += entered ? 1 : 0;
        add_motion<polar>(m, weight, x, y, block, s);
      }
    }
    *sums[1] += time;
    *sums[2] += in_range;
  }

  template <bool polar>
  void add_motion(double* m, double weight, double x, double y, const FrameBlock& block, std::int64_t s) const {
    if (!has_velocity_) {
      m[kTime] += weight;
      return;
    }
    const double u = block.velocity[0][s], v = block.velocity[1][s], w = block.velocity[2][s];
    const double square = u * u + v * v + w * w;
    m[kTime] += weight;
    m[kSpeed] += weight * std::sqrt(square);
    if (!all_maps_) return;
    const double radius_square = std::max(x * x + y * y, 1e-14);  // on the axis itself ω has no value
    const double swirl = cells_.sense() < 0 ? y * u - x * v : x * v - y * u, turning = swirl / radius_square;
    const double per_radius = polar ? 1 / std::sqrt(radius_square) : 0;
    m[kVelocity0] += weight * (polar ? (x * u + y * v) * per_radius : u);
    m[kVelocity1] += weight * (polar ? swirl * per_radius : v);
    m[kVelocity2] += weight * w;
    m[kTurning] += weight * std::fabs(turning);
    m[kSignedTurning] += weight * turning;
    m[kSquare] += weight * square;
    if (block.velocity_variance != nullptr) m[kVariance] += weight * block.velocity_variance[s];
  }

  void add_axes(Results& results) const {
    const auto axis = [&](const char* name, const char* unit, const Bins& bins, double factor, const char* doc, std::uint32_t traits = 0) {
      results.add(name, unit, bins.edges(factor).data(), {static_cast<std::uint64_t>(bins.count) + 1}, doc, {}, traits);
    };
    if (cells_.axial()) axis("z_edges", "m", cells_.slow(), 1, "Edges of the cells along the axis.");
    if (cells_.polar()) {
      axis("r_edges", "m", cells_.middle(), 1, "Edges of the cells from the axis outwards.");
      axis("theta_edges_deg", "deg", cells_.fast(), kDegrees,
           "Edges of the cells round the axis, from 6 o'clock, positive in the turning sense.");
    } else {
      axis("y_edges", "m", cells_.middle(), 1, "Edges of the cells along y, upwards.");
      axis("x_edges", "m", cells_.fast(), 1, "Edges of the cells along x.", kAlongX);
    }
  }

  /// One number per cell, made from its moments.
  template <class Value>
  void add_field(Results& results, const char* name, const char* unit, const char* doc, Value value, const double* moments,
                 std::uint32_t traits = 0) const {
    std::vector<double> field(as_size(cells_.count()));
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = value(moments + i * kMoments);
    add_values(results, name, unit, doc, field, traits);
  }
  void add_values(Results& results, const char* name, const char* unit, const char* doc, const std::vector<double>& field,
                  std::uint32_t traits = 0) const {
    const auto a = static_cast<std::uint64_t>(cells_.fast().count), b = static_cast<std::uint64_t>(cells_.middle().count),
               c = static_cast<std::uint64_t>(cells_.slow().count);
    const char* fast = cells_.polar() ? "theta_edges_deg" : "x_edges";
    const char* middle = cells_.polar() ? "r_edges" : "y_edges";
    if (cells_.axial()) {
      results.add(name, unit, field.data(), {c, b, a}, doc, {"z_edges", middle, fast}, traits);
    } else {
      results.add(name, unit, field.data(), {b, a}, doc, {middle, fast}, traits);
    }
  }
  void add_mean(Results& results, const char* name, const char* unit, const char* doc, Moment moment, const double* moments,
                std::uint32_t traits = 0) const {
    add_field(
        results, name, unit, doc, [=](const double* m) { return ratio(m[moment], m[kTime]); }, moments, traits);
  }

  void add_speed(Results& results, const double* moments) const {
    add_mean(results, "speed", "m/s", "Mean magnitude of the velocity; noise of the measurement raises it where beads are slow.", kSpeed,
             moments);
  }

  void add_velocities(Results& results, const double* moments) const {
    const bool polar = cells_.polar();
    add_mean(results, polar ? "velocity_r" : "velocity_x", "m/s", polar ? "Mean velocity outwards." : "Mean velocity along x.", kVelocity0,
             moments, polar ? 0U : kOdd);
    add_mean(results, polar ? "velocity_theta" : "velocity_y", "m/s",
             polar ? "Mean velocity in the turning sense." : "Mean velocity upwards.", kVelocity1, moments);
    add_mean(results, "velocity_z", "m/s", "Mean velocity along the axis.", kVelocity2, moments);
    add_speed(results, moments);
    add_mean(results, "angular_speed", "rad/s", "Mean of |v_theta|/r (Chagas 2015); noise raises it near the axis.", kTurning, moments);
    if (cells_.sense() != 0) {
      add_mean(results, "angular_velocity", "rad/s", "Mean of v_theta/r, positive in the turning sense.", kSignedTurning, moments);
    }
    add_field(
        results, "granular_temperature", "m^2/s^2",
        "Velocity fluctuation: a third of the variance of the velocity in the cell, less the variance that the measurement leaves in each "
        "component; below zero where that variance is overstated.",
        [](const double* m) {
          double mean_square = 0;
          for (const Moment c : {kVelocity0, kVelocity1, kVelocity2}) mean_square += std::pow(ratio(m[c], m[kTime]), 2);
          return (ratio(m[kSquare], m[kTime]) - mean_square) / 3 - ratio(m[kVariance], m[kTime]);
        },
        moments);
  }

  /// Left out where the charge or the length is unknown.
  void add_porosity(Results& results, const double* moments, double in_range, double all) const {
    const std::vector<double>& volume = volumes_;
    if (volume.empty() || !(bead_volume_ > 0)) return;
    const double solids = bead_volume_ * ratio(in_range, all);  // m³ within the range along z
    std::vector<double> field(volume.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
      const double time = moments[i * kMoments + kTime];
      field[i] = time > 0 && volume[i] > 0 ? 1 - ratio(time, in_range) * solids / volume[i] : kNaN;
    }
    add_values(results, "porosity", "1",
               "Void fraction from occupancy (Sichalwe et al. 2011): one less the beads' volume over the cell's volume inside the bare "
               "shell; lifters "
               "are not subtracted.",
               field);
  }

  AxialRange range_;
  Cells cells_;
  std::vector<double> volumes_ = cells_.volumes();  ///< m³; the same for every resample
  std::int64_t largest_id_;
  bool has_velocity_, all_maps_;
  double bead_volume_ = 0;
};

constexpr Descriptor kDescriptor = describe<PeptGrid>({
    .name = "pept_grid",
    .version = "0.1.0",
    .doc = "Maps of occupancy, velocity, turning speed, velocity fluctuation, visits and porosity.",
    .equation =
        "l_i = sum_i w / sum w; <v>_i = sum_i w v / sum_i w; T_i = (<v^2>_i - |<v>_i|^2)/3 - <s_v^2>_i; porosity_i = 1 - l_i V_beads/V_i",
    .citation = "Chagas 2015, Calibration of DEM contact parameters for tumbling mills using PEPT; Sichalwe et al. 2011 (porosity)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
