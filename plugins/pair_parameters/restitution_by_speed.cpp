// Restitution that falls with the impact speed.
//
// symbol   here        meaning
// v        history     closing speed at first touch, kept while the bodies touch, m/s
// e_0      reference_  restitution at the speed v_0
//
//   viscoelastic: e = 1 − (1 − e_0) (v/v_0)^{1/5}   (Kuwabara & Kono 1987; Brilliantov et al. 1996: 1 − C v^{1/5})
//   plastic:      e = e_0 (v/v_0)^{−1/4}, at most 1  (Johnson 1985, §11.5)
//
// The difference from e_0 is scaled by `strength`; never below `floor`.
#include "millscope/functions.hpp"
#include "millscope/pair_parameter_adapter.hpp"

namespace millscope::pair_parameters {
namespace {

constexpr Parameter kParameters[] = {
    choice_parameter("form", "viscoelastic|plastic", "viscoelastic", "How e falls with speed: 1 - C v^(1/5), or v^(-1/4)."),
    pair_parameter("reference_restitution", "1", kRequired, 1e-6, 1.0, "Restitution e_0 at the reference speed."),
    pair_parameter("reference_speed", "m/s", 1.0, 1e-9, 1e4, "Closing speed v_0 at which e_0 holds."),
    pair_parameter("strength", "1", 1.0, 0.0, 1.0, "Share of the dependence that acts; 0: e_0 at every speed."),
    pair_parameter("floor", "1", 0.05, 1e-6, 1.0, "Smallest e that is given."),
};

constexpr Hypothesis kHypotheses[] = {
    {"speed_dependent_restitution", "Fast impacts lose a larger share of their energy than slow ones.", "e = 1 - (1 - e_0) (v/v_0)^(1/5)",
     "Brilliantov et al. 1996, doi:10.1103/PhysRevE.53.5382", "strength", 0.0, 0.0, 1.0},
};

class RestitutionBySpeed {
 public:
  static constexpr int kHistory = 1;
  static constexpr PairParameterInfo kInfo = pair_parameter_info({{"impact_speed", 1}});
  static constexpr std::uint64_t kGives = kGivesRestitution;

  RestitutionBySpeed(const Parameters& values, const PairContext&)
      : reference_(values.number("reference_restitution")),
        speed_(values.number("reference_speed")),
        strength_(values.number("strength")),
        floor_(values.number("floor")),
        plastic_(values.text("form") == "plastic") {}

  template <class R>
  void values(const ParameterState<R>& pair, R (&history)[1], PairValues<R>& out) const {
    const R zero(0.0), slowest(1e-9);
    const auto touching = pair.overlap > zero;
    const R closing = maximum(-dot(pair.velocity, pair.normal), slowest);
    history[0] = select(touching, select(history[0] > zero, history[0], closing), zero);
    const R one(1.0), reference(reference_), ratio = maximum(history[0], slowest) / R(speed_);
    const R e = plastic_ ? reference / square_root(square_root(ratio)) : one - (one - reference) * power(ratio, 0.2);
    out.restitution = minimum(one, maximum(R(floor_), reference + R(strength_) * (minimum(one, e) - reference)));
  }

 private:
  double reference_, speed_, strength_, floor_;
  bool plastic_;
};

constexpr Descriptor kDescriptor = describe<RestitutionBySpeed>({
    .name = "restitution_by_speed",
    .version = "1.0",
    .doc = "Restitution as a function of the impact speed.",
    .equation = "e = 1 - (1 - e_0) (v/v_0)^(1/5), or e_0 (v/v_0)^(-1/4)",
    .citation = "Brilliantov et al. 1996, doi:10.1103/PhysRevE.53.5382; Johnson 1985, Contact Mechanics",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::pair_parameters

MILLSCOPE_PLUGINS(&millscope::pair_parameters::kDescriptor)
