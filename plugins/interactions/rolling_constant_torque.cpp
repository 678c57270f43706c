// Rolling friction as a moment of constant size against the rolling (Zhou et al. 1999; Chagas 2015, Eq. 3.17, corrected).
//
// symbol   here      meaning
// μ_r      –         coefficient of rolling friction, 1
// L        lever     R* (or the bead's radius), m
// ω        spin      rolling part of ω_i − ω_j: what is left without the twist about n, rad/s
//
//   T_i = −μ_r L F_n ω/|ω|,   T_j = −T_i
//
// Near rest the moment is no larger than m* R*² |ω|/(10 Δt): without this it would flip from step to step. The rolling then fades with a
// time constant of 4 steps at a wall and of 16 steps between two equal beads (their m* and R* are half of each, and both are braked). The
// tenth is a quarter of a sphere's 2/5 m R², so that even four contacts at walls together do not turn a bead round within a step.
// `spin: absolute` is the study's form, −μ_r L F_n ω_i/|ω_i| on each body with its own spin: it depends on the frame, brakes a bead that
// turns with the shell as a rigid body, and its two moments are no pair. It is there to repeat the study only.
#include "rolling.hpp"

namespace millscope::interactions {
namespace {

constexpr Parameter kParameters[] = {
    rolling_friction_parameter,
    rolling_length_parameter,
    choice_parameter(
        "spin", "relative|absolute", "relative",
        "Spin that is resisted: of the bodies relative to each other; absolute (each body's own) is not frame-indifferent: only to "
        "repeat Chagas 2015."),
};

constexpr Hypothesis kHypotheses[] = {
    {"rolling_friction", "Rolling is resisted: the beads are not perfect spheres, or the surfaces give way.", "T = -mu_r R* F_n w/|w|",
     "Zhou et al. 1999, doi:10.1016/S0378-4371(99)00183-1", "rolling_friction", 0.0, 0.0, 0.2, "rolling_resistance|bead_shape"},
};

class RollingConstantTorque {
 public:
  static constexpr int kHistory = 0, kChannels = 1;
  static constexpr PairTermInfo kInfo = pair_term({}, {{"rolling", ChannelPart::rolling, ChannelNature::dissipative}});

  RollingConstantTorque(const Parameters& values, const PairContext&)
      : friction_(values.number("rolling_friction")),
        effective_(values.text("length") == "effective"),
        relative_(values.text("spin") == "relative") {}

  double reach(double) const { return 0.0; }

  template <class R>
  void post(const PairState<R>& pair, R*, PostResponse<R, 1>& out) const {
    const R zero(0.0);
    const R moment = R(friction_) * rolling_lever(pair, effective_) * select(pair.overlap > zero, maximum(pair.normal_force, zero), zero);
    const R stopping = R(0.1) * pair.mass * pair.radius * pair.radius / maximum(pair.time_step, R(1e-300));
    if (relative_) {
      out.moment_i = resist(rolling_part(pair.spin_i - pair.spin_j, pair.normal), moment, stopping, out.power[0]);
      out.moment_j = R(-1.0) * out.moment_i;
    } else {
      R lost_j;
      out.moment_i = resist(pair.spin_i, moment, stopping, out.power[0]);
      out.moment_j = resist(pair.spin_j, select(pair.radius_j > zero, moment, zero), stopping, lost_j);
      out.power[0] += lost_j;
    }
  }

 private:
  template <class R>
  static Vec<R> resist(const Vec<R>& spin, const R& moment, const R& stopping, R& lost) {
    const R size = maximum(length(spin), R(1e-100));
    const R rate = minimum(moment / size, stopping);
    lost = rate * size * size;
    return (-rate) * spin;
  }

  double friction_;
  bool effective_, relative_;
};

constexpr Descriptor kDescriptor = describe<RollingConstantTorque>({
    .name = "rolling_constant_torque",
    .version = "1.0",
    .doc = "A moment of constant size against the rolling part of the relative spin.",
    .equation = "T = -mu_r R* F_n w/|w|",
    .citation = "Zhou et al. 1999, doi:10.1016/S0378-4371(99)00183-1; Chagas 2015, Eq. 3.17",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
