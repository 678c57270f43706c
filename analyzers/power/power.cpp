// Power that the shell gives to the charge, from where the beads are and how they turn, and, when simulated, from the shell itself.
//
//   i cell of the x–y plane, l_i its share of the charge's time (by mass), x_i its middle, ω = (x v_y − y v_x)/r², s = sign Ω
//   Bbosa et al. 2011    P = M g s Σ_i x_i l_i ⟨|ω|⟩_i          as Chagas 2015 prints it (Eq. 3.20)
//     of the mean        P = M g s Σ_i x_i l_i |⟨ω⟩_i|          noise of a camera raises this one less
//     signed             P = M g Σ_i x_i l_i ⟨ω⟩_i              the cascading layer counts against the rise
//   gravity              P = M g ⟨x Ω⟩                          exact in the steady state without a fluid
//   shell                P = Δ(work of the walls)/Δt,  torque = P/Ω
//   dissipation          P = Δ(energy lost)/Δt
//
// Bbosa's sum is an estimator with a bias; the last three agree in the steady state. With the shell's |Ω| for |ω|, Bbosa's sum is
// `gravity`: of all readings it comes nearest to the powers that Chagas 2015 prints (docs/analyzers.md).
#include <algorithm>
#include <optional>
#include <vector>

#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    integer_parameter("cells_x", 50, 1, 2000, "Cells across the mill for Bbosa's sum and the maps; 50 are 6 mm each in a mill of 300 mm."),
    integer_parameter("cells_y", 50, 1, 2000, "Cells up the mill."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

/// What a cell adds up.
enum Moment { kMass, kTurning, kSignedTurning, kLever, kMoments };
/// Sums over everything, kg s and what goes with it.
enum Whole { kAllMass, kAllX, kAllY, kAllXOmega, kAllOmega, kWholes };
/// Sums over neighbouring frames.
enum Change { kTime, kWork, kLost, kTurned, kChanges };

class Power {
 public:
  static constexpr std::uint64_t kNeeds = 0;  // without velocities: the centre of mass and what follows from it

  Power(const Parameters& p, const AnalyzerContext& context) : context_(context), range_(axial_range(p, context)) {
    const double shell = shell_radius(context);
    sense_ = known_sense(context);
    if (!(context.gravity > 0))
      throw Refusal("gravity is unknown or zero, so there is no power to lift the charge: give the case's body_forces a gravity");
    x_ = Bins(-shell, shell, p.integer("cells_x"));
    y_ = Bins(-shell, shell, p.integer("cells_y"));
  }

  std::vector<ArrayInfo> arrays() const {
    return {additive("moments", "mixed", {static_cast<std::uint64_t>(x_.count * y_.count), kMoments}),
            additive("whole", "mixed", {kWholes}), additive("changes", "mixed", {kChanges})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    double whole[kWholes] = {};
    for (std::int64_t f = 0; f < block.frame_count; ++f) {
      const double omega = block.omega != nullptr ? block.omega[f] : context_.omega;
      for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) add_sample(block, s, omega, sums[0], whole);
    }
    for (int i = 0; i < kWholes; ++i) sums[1][i] += whole[i];
    for (std::int64_t f = 1; f < block.frame_count; ++f) add_change(block, f, sums[2]);
  }

  void finish(const double* const* sums, Results& results) const {
    const double* whole = sums[1];
    const double mass = whole[kAllMass];
    results.add("x_edges", "m", x_.edges().data(), {static_cast<std::uint64_t>(x_.count) + 1}, "Edges of the cells along x.", {}, kAlongX);
    results.add("y_edges", "m", y_.edges().data(), {static_cast<std::uint64_t>(y_.count) + 1}, "Edges of the cells along y, upwards.");
    results.add("centre_of_mass_x", "m", ratio(whole[kAllX], mass), "Mean x of the charge, by mass and time.", kOdd);
    results.add("centre_of_mass_y", "m", ratio(whole[kAllY], mass), "Mean y of the charge, by mass and time.");
    results.add("turning_speed", "rad/s", ratio(whole[kAllOmega], mass), "Mean Omega about z; negative: clockwise.", kOdd);
    add_power(results, "gravity", context_.gravity * ratio(whole[kAllXOmega], mass), "Power that lifts the charge, M g <x Omega>.");
    add_cells(results, sums[0], mass);
    add_changes(results, sums[2]);
  }

 private:
  void add_sample(const FrameBlock& block, std::int64_t s, double omega, double* moments, double* whole) const {
    const double x = block.position[0][s], y = block.position[1][s];
    if (!range_.contains(block.position[2][s])) return;
    const double mass = block.mass != nullptr ? block.weight[s] * block.mass[s] : block.weight[s];
    whole[kAllMass] += mass;
    whole[kAllX] += mass * x;
    whole[kAllY] += mass * y;
    whole[kAllXOmega] += mass * x * omega;
    whole[kAllOmega] += mass * omega;
    const std::optional<std::int64_t> column = x_.at(x), row = y_.at(y);
    if (!column || !row) return;
    double* m = moments + (*row * x_.count + *column) * kMoments;
    m[kMass] += mass;
    m[kLever] += mass * x * omega;
    if (block.velocity[0] == nullptr) return;
    const double turning = (x * block.velocity[1][s] - y * block.velocity[0][s]) / std::max(x * x + y * y, 1e-14);
    m[kTurning] += mass * std::fabs(turning);
    m[kSignedTurning] += mass * turning;
  }

  static void add_change(const FrameBlock& block, std::int64_t f, double* changes) {
    if (block.piece[f] != block.piece[f - 1]) return;
    const double time = block.time[f] - block.time[f - 1];
    changes[kTime] += time;
    if (block.omega != nullptr) changes[kTurned] += 0.5 * time * (block.omega[f] + block.omega[f - 1]);
    if (block.wall_work != nullptr) changes[kWork] += block.wall_work[f] - block.wall_work[f - 1];
    if (block.dissipation == nullptr) return;
    const double *now = block.dissipation + f * block.channel_count, *before = now - block.channel_count;
    for (std::int64_t c = 0; c < block.channel_count; ++c) changes[kLost] += now[c] - before[c];
  }

  /// `specific` in W/kg; in watts where the charge's mass is known.
  void add_power(Results& results, const std::string& name, double specific, const std::string& doc) const {
    results.add(("specific_power_" + name).c_str(), "W/kg", specific, (doc + " Per mass of the charge.").c_str());
    if (context_.charge_mass > 0) results.add(("power_" + name).c_str(), "W", context_.charge_mass * specific, doc.c_str());
  }

  void add_cells(Results& results, const double* moments, double mass) const {
    const std::size_t count = as_size(x_.count * y_.count);
    std::vector<double> bbosa(count), lift(count);
    double of_mean = 0, is_signed = 0, sum = 0, inside = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double* m = moments + i * kMoments;
      const double x = x_.centre(static_cast<std::int64_t>(i) % x_.count);
      bbosa[i] = m[kMass] > 0 ? sense_ * context_.gravity * x * ratio(m[kTurning], mass) : kNaN;
      lift[i] = m[kMass] > 0 ? context_.gravity * ratio(m[kLever], mass) : kNaN;
      if (!(m[kMass] > 0)) continue;
      sum += bbosa[i];
      of_mean += sense_ * context_.gravity * x * std::fabs(ratio(m[kSignedTurning], mass));
      is_signed += context_.gravity * x * ratio(m[kSignedTurning], mass);
      inside += m[kMass];
    }
    if (!(mass > 0)) sum = of_mean = is_signed = kNaN;
    const bool has_velocity = (context_.has & kHasVelocity) != 0;
    if (has_velocity) {
      add_power(results, "bbosa", sum,
                "Bbosa's sum over cells with the mean of |omega| (Chagas 2015, Eq. 3.20): an estimator with a bias.");
      add_power(results, "bbosa_of_mean", of_mean, "Bbosa's sum with the magnitude of the mean omega of each cell.");
      add_power(results, "bbosa_signed", is_signed, "Bbosa's sum with the signed mean omega: the cascading layer counts against the rise.");
    }
    results.add("outside_fraction", "1", ratio(mass - inside, mass),
                "Fraction of the charge's time outside the cells, which Bbosa's sums lack.", kShare);
    if (has_velocity) add_map(results, "bbosa", bbosa, "Term of each cell in Bbosa's sum.");
    add_map(results, "gravity", lift, "Power that lifts the charge in each cell, M g <x Omega>.");
  }

  void add_map(Results& results, const std::string& name, std::vector<double>& map, const std::string& doc) const {
    const auto columns = static_cast<std::uint64_t>(x_.count), rows = static_cast<std::uint64_t>(y_.count);
    if (context_.charge_mass > 0) {
      for (double& cell : map) cell *= context_.charge_mass;
      results.add(("power_map_" + name).c_str(), "W", map.data(), {rows, columns}, doc.c_str(), {"y_edges", "x_edges"});
    } else {
      results.add(("specific_power_map_" + name).c_str(), "W/kg", map.data(), {rows, columns}, (doc + " Per mass of the charge.").c_str(),
                  {"y_edges", "x_edges"});
    }
  }

  void add_changes(Results& results, const double* changes) const {
    const double time = changes[kTime];
    if ((context_.has & kHasWallWork) != 0) {
      results.add("power_shell", "W", ratio(changes[kWork], time), "Power that the walls give to the charge, from their work.");
      if ((context_.has & kHasOmega) != 0) {
        const double turned = changes[kTurned] * sense_;
        results.add("shell_torque", "N m", turned > 0 ? sense_ * changes[kWork] / turned : kNaN,
                    "Torque of the walls on the charge about the axis; its sign is that of Omega.", kOdd);
      }
    }
    if ((context_.has & kHasDissipation) != 0) {
      results.add("power_dissipation", "W", ratio(changes[kLost], time), "Energy that the contacts lose per time, all channels.");
    }
  }

  AnalyzerContext context_;
  AxialRange range_;
  double sense_ = 0;
  Bins x_, y_;
};

constexpr Descriptor kDescriptor = describe<Power>({
    .name = "power",
    .version = "0.1.0",
    .doc = "Power of the charge: Bbosa's sum over cells, M g <x> Omega, and, when simulated, the shell's work and the dissipation.",
    .equation = "P = M g sign(Omega) sum_i x_i l_i <|omega|>_i; P = M g <x Omega>",
    .citation = "Bbosa et al. 2011; Chagas 2015, Eq. 3.20",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
