// Rolling resistance as an elastic-plastic spring with an optional dashpot (Ai et al. 2011, model C).
//
// symbol   here        meaning
// μ_r      friction_   coefficient of rolling friction, 1
// L        lever       R* (Ai's R_r) or the bead's radius, m
// k_n      –           normal stiffness of the contact, N/m
// k_r      –           2.25 k_n μ_r² L², N m/rad
// M_max    –           μ_r L F_n, N m
//
//   M = −k_r θ, |M| ≤ M_max; the spring itself: rolling_spring.hpp
#include "rolling_spring.hpp"

namespace millscope::interactions {
namespace {

constexpr Parameter kParameters[] = {
    rolling_friction_parameter,
    rolling_length_parameter,
    rolling_damping_parameter,
};

constexpr Hypothesis kHypotheses[] = {
    {"rolling_resistance", "Rolling is resisted elastically at first, then plastically: beads can rest on a slope.",
     "M = -k_r theta, |M| <= mu_r R* F_n", "Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030", "rolling_friction", 0.0, 0.0, 0.2,
     "rolling_friction|bead_shape"},
};

class RollingEpsd {
 public:
  static constexpr int kHistory = RollingSpring::kHistory, kChannels = RollingSpring::kChannels;
  static constexpr PairTermInfo kInfo = RollingSpring::kInfo;

  RollingEpsd(const Parameters& values, const PairContext&)
      : spring_{values.number("damping_ratio")},
        friction_(values.number("rolling_friction")),
        effective_(values.text("length") == "effective") {}

  double reach(double) const { return 0.0; }

  template <class R>
  void post(const PairState<R>& pair, R (&history)[4], PostResponse<R, 3>& out) const {
    const R zero(0.0), lever = rolling_lever(pair, effective_) * R(friction_);
    spring_.resist(pair, R(2.25) * maximum(pair.normal_stiffness, zero) * lever * lever, lever * maximum(pair.normal_force, zero), history,
                   out);
  }

 private:
  RollingSpring spring_;
  double friction_;
  bool effective_;
};

constexpr Descriptor kDescriptor = describe<RollingEpsd>({
    .name = "rolling_epsd",
    .version = "1.0",
    .doc = "Rolling resistance by an elastic-plastic spring, optionally with a dashpot.",
    .equation = "M = -k_r theta, k_r = 2.25 k_n mu_r^2 R*^2, |M| <= mu_r R* F_n",
    .citation = "Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
