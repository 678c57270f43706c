// Friction that falls with the sliding speed (Stribeck's falling branch).
//
// symbol      here       meaning
// v           sliding    |v_t| now, m/s
// μ_s, μ_k    static_, kinetic_   given as μ_s and the ratio μ_k/μ_s
// v_s         speed_     speed at which 1/e of the difference is left, m/s
//
//   μ = μ_k + (μ_s − μ_k) exp(−v/v_s)
#include "millscope/functions.hpp"
#include "millscope/pair_parameter_adapter.hpp"

namespace millscope::pair_parameters {
namespace {

constexpr Parameter kParameters[] = {
    pair_parameter("static_friction", "1", kRequired, 0.0, kUnbounded, "Coefficient of friction mu_s at rest."),
    pair_parameter("kinetic_ratio", "1", kRequired, 0.0, 10.0, "mu_k over mu_s, mu_k at high sliding speed; 1: no dependence."),
    pair_parameter("decay_speed", "m/s", 0.1, 1e-9, 1e4, "Sliding speed v_s over which mu falls from mu_s to mu_k."),
};

constexpr Hypothesis kHypotheses[] = {
    {"speed_dependent_friction", "Sliding surfaces rub less than resting ones.", "mu = mu_k + (mu_s - mu_k) exp(-v/v_s)",
     "Bowden & Tabor 1950; Armstrong-Helouvry et al. 1994, doi:10.1016/0005-1098(94)90209-7", "kinetic_ratio", 1.0, 0.2, 1.0},
};

class FrictionBySpeed {
 public:
  static constexpr int kHistory = 0;
  static constexpr PairParameterInfo kInfo = pair_parameter_info({});
  static constexpr std::uint64_t kGives = kGivesFriction;

  FrictionBySpeed(const Parameters& values, const PairContext&)
      : static_(values.number("static_friction")),
        kinetic_(static_ * values.number("kinetic_ratio")),
        speed_(values.number("decay_speed")) {}

  template <class R>
  void values(const ParameterState<R>& pair, R*, PairValues<R>& out) const {
    const R normal_speed = dot(pair.velocity, pair.normal);
    const R sliding = length(pair.velocity - normal_speed * pair.normal);
    const R left = exponential(-(sliding / R(speed_)));
    out.friction = R(kinetic_) + R(static_ - kinetic_) * left;
  }

 private:
  double static_, kinetic_, speed_;
};

constexpr Descriptor kDescriptor = describe<FrictionBySpeed>({
    .name = "friction_by_speed",
    .version = "1.0",
    .doc = "Coefficient of friction as a function of the sliding speed.",
    .equation = "mu = mu_k + (mu_s - mu_k) exp(-v/v_s)",
    .citation = "Bowden & Tabor 1950; Armstrong-Helouvry et al. 1994, doi:10.1016/0005-1098(94)90209-7",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::pair_parameters

MILLSCOPE_PLUGINS(&millscope::pair_parameters::kDescriptor)
