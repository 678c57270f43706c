// Slip of the charge against the shell: the beads' angular speed over the shell's, by radius and, where the shell's angle is known, by
// the place between two lifters.
//
//   ω = (x v_y − y v_x)/r² of a bead, s = sign Ω
//   ratio(r)  = Σ w s ω / Σ w |Ω|,   slip(r) = 1 − ratio(r)        0: turns with the shell, 1: stands still, above 1: runs back
//   lifter phase u = s (θ − α − α₀)/(2π/n) mod 1                   θ angle of the bead and α of the shell about z, α₀ of lifter 0 from x
//
// Only a sector counts, by default from 6 o'clock 60° up the rising side, where the bed is carried en masse; elsewhere beads flow back
// over it or fly.
#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    integer_parameter("bins_r", 25, 1, 10000, "Rings from the axis to the shell."),
    integer_parameter("lifters", 0, 0, 1000,
                      "Number of lifters, evenly spaced; 0, or a recording without the shell's angle: no slip by lifter phase."),
    integer_parameter("bins_phase", 12, 1, 1000, "Bins of the lifter phase."),
    number_parameter("lifter_angle", "rad", 0, -100, 100,
                     "Angle of the middle of a lifter from the x axis, counter-clockwise, when the shell's angle is zero."),
    number_parameter("sector_from", "rad", 0, -std::numbers::pi, std::numbers::pi,
                     "Start of the sector, from 6 o'clock, positive in the turning sense."),
    number_parameter("sector_to", "rad", std::numbers::pi / 3, -std::numbers::pi, std::numbers::pi, "End of the sector."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

enum Moment { kTime, kTurning, kSquare, kShell, kMoments };

class Slip {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  Slip(const Parameters& p, const AnalyzerContext& context)
      : range_(axial_range(p, context)),
        rings_(0, shell_radius(context), p.integer("bins_r")),
        sense_(known_sense(context)),
        omega_(context.omega),
        from_(p.number("sector_from")),
        to_(p.number("sector_to")),
        lifter_angle_(p.number("lifter_angle")) {
    if (!(to_ > from_)) throw Refusal("the sector is empty: sector_to must be larger than sector_from");
    const auto lifters = p.integer("lifters");
    if (lifters == 0 || (context.has & kHasPhase) == 0) return;
    pitch_ = 2 * std::numbers::pi / static_cast<double>(lifters);
    phases_ = Bins(0, 1, p.integer("bins_phase"));
  }

  std::vector<ArrayInfo> arrays() const {
    return {additive("moments", "mixed", {static_cast<std::uint64_t>(rings_.count), static_cast<std::uint64_t>(phases_.count), kMoments})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      const double omega = block.omega != nullptr ? block.omega[f] : omega_;
      const double shell_angle = pitch_ > 0 ? block.phase[f] + lifter_angle_ : 0;
      for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) {
        const double x = block.position[0][s], y = block.position[1][s], radius_square = x * x + y * y;
        const std::optional<std::int64_t> ring = rings_.at(std::sqrt(radius_square));
        if (!ring || !range_.contains(block.position[2][s]) || !in_sector(x, y)) continue;
        const std::optional<std::int64_t> phase = pitch_ > 0 ? phases_.at(lifter_phase(x, y, shell_angle)) : 0;
        if (!phase) continue;  // the shell's angle is not known
        const double weight = block.weight[s];
        const double turning = sense_ * (x * block.velocity[1][s] - y * block.velocity[0][s]) / std::max(radius_square, 1e-14);
        double* m = sums[0] + (*ring * phases_.count + *phase) * kMoments;
        m[kTime] += weight;
        m[kTurning] += weight * turning;
        m[kSquare] += weight * turning * turning;
        m[kShell] += weight * sense_ * omega;
      }
    }
  }

  void finish(const double* const* sums, Results& results) const {
    const auto rings = as_size(rings_.count), phases = as_size(phases_.count);
    std::vector<double> of_ring(rings * kMoments), ratios(rings), slip(rings), spread(rings), share(rings), by_phase(rings * phases);
    double all = 0;
    for (std::size_t i = 0; i < rings * phases; ++i) {
      const double* m = sums[0] + i * kMoments;
      for (std::size_t k = 0; k < kMoments; ++k) of_ring[i / phases * kMoments + k] += m[k];
      by_phase[i] = 1 - ratio(m[kTurning], m[kShell]);
      all += m[kTime];
    }
    for (std::size_t r = 0; r < rings; ++r) {
      const double* m = of_ring.data() + r * kMoments;
      const double mean = ratio(m[kTurning], m[kTime]), shell = ratio(m[kShell], m[kTime]);
      ratios[r] = ratio(m[kTurning], m[kShell]);
      slip[r] = 1 - ratios[r];
      spread[r] = std::sqrt(std::fmax(0.0, ratio(m[kSquare], m[kTime]) - mean * mean)) / shell;
      if (std::isnan(mean)) spread[r] = kNaN;
      share[r] = ratio(m[kTime], all);
    }
    results.add("r_edges", "m", rings_.edges().data(), {rings + 1}, "Edges of the rings.");
    results.add("angular_velocity_ratio", "1", ratios.data(), {rings}, "Angular velocity of the beads over the shell's, in the sector.",
                {"r_edges"});
    results.add("slip", "1", slip.data(), {rings}, "One less that ratio: 0 turns with the shell, 1 stands still.", {"r_edges"});
    results.add("spread", "1", spread.data(), {rings}, "Standard deviation of the beads' angular velocity over the shell's.", {"r_edges"});
    results.add("time_share", "1", share.data(), {rings}, "Share of each ring in the beads' time in the sector.", {"r_edges"}, kShare);
    if (pitch_ == 0) return;
    results.add("lifter_phase_edges", "1", phases_.edges().data(), {phases + 1},
                "Place between lifters as a fraction of the pitch, in the turning sense: 0 and 1 are the middles of lifters.");
    results.add("slip_by_lifter_phase", "1", by_phase.data(), {rings, phases}, "Slip by radius and place between lifters.",
                {"r_edges", "lifter_phase_edges"});
  }

 private:
  bool in_sector(double x, double y) const {
    const double angle = angle_of(sense_ * x, -y);
    return angle >= from_ && angle <= to_;
  }
  double lifter_phase(double x, double y, double shell_angle) const {
    const double pitches = sense_ * (angle_of(y, x) - shell_angle) / pitch_;
    return pitches - std::floor(pitches);
  }

  AxialRange range_;
  Bins rings_, phases_;
  double sense_, omega_, from_, to_, lifter_angle_, pitch_ = 0;
};

constexpr Descriptor kDescriptor = describe<Slip>({
    .name = "slip",
    .version = "0.1.0",
    .doc = "Slip of the charge against the shell by radius and, where the shell's angle is known, by lifter phase.",
    .equation = "slip(r) = 1 - sum w s omega / sum w |Omega|, omega = (x v_y - y v_x)/r^2",
    .citation = "Chagas 2015 (angular speed)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
