// Beads that are not quite round, as spheres whose rolling is resisted like that of an ellipse of aspect ratio α and the same volume:
// they rock about their flat side and tip over their ends. A surrogate (Wensrich & Katterfeld 2012): packing, orientation and impacts
// stay those of spheres, and a bead that would roll about its long axis is resisted, too.
//
// symbol   here        meaning
// α        –           aspect ratio a/b of a prolate spheroid, 1
// R, R*    –           radius of the sphere of the same volume, effective radius of the contact (R at a wall), m
// a, b     –           half axes: a = R α^⅔, b = R α^−⅓, m
// h(φ)     –           height of the centre over the plane, φ from the flat side: √(b² cos²φ + a² sin²φ), m
// θ        –           rolling angle of the two bodies against each other, rad
//
// A plane carries the bead with F_n beside its centre by dh/dφ, so that the moment against the rolling is F_n dh/dφ. It begins as
//
//   k_r φ,  k_r = F_n (a²/b − b) = F_n b (α² − 1)                (curvature radius a²/b at the flat side, centre b above it)
//
// In half a turn the centre is lifted once, from b to a, and what the lift costs is lost when the bead falls from its end. The spring
// slides where half a turn loses just that:
//
//   M_max = F_n (a − b)/π
//
// It is half the mean of |dh/dφ|, 2 (a − b)/π, since on the way down the weight drives the bead. Two beads that roll on each other turn
// against the plane between them by φ_i = θ R*/R_i, so that a and b are those of R* in k_r and of 2 R* in M_max.
#include <cmath>
#include <numbers>

#include "rolling_spring.hpp"

namespace millscope::interactions {
namespace {

constexpr Parameter kParameters[] = {
    pair_parameter("aspect_ratio", "1", kRequired, 1.0, 5.0, "Length over width alpha of a bead of the same volume; 1: a sphere."),
    rolling_damping_parameter,
};

constexpr Hypothesis kHypotheses[] = {
    {"bead_shape", "The beads are not round: they rock and tip over instead of rolling freely.",
     "M = -k_r theta, k_r = F_n b (alpha^2 - 1), |M| <= F_n (a - b)/pi",
     "after Wensrich & Katterfeld 2012, doi:10.1016/j.powtec.2011.10.057", "aspect_ratio", 1.0, 1.0, 1.3,
     "rolling_resistance|rolling_friction"},
};

class BeadShape {
 public:
  static constexpr int kHistory = RollingSpring::kHistory, kChannels = RollingSpring::kChannels;
  static constexpr PairTermInfo kInfo = RollingSpring::kInfo;

  BeadShape(const Parameters& values, const PairContext&) : spring_{values.number("damping_ratio")} {
    const double alpha = values.number("aspect_ratio"), b = std::cbrt(1 / alpha), a = alpha * b;  // over R
    stiffness_ = b * (alpha * alpha - 1);
    limit_ = std::numbers::inv_pi * (a - b);
  }

  double reach(double) const { return 0.0; }

  template <class R>
  void post(const PairState<R>& pair, R (&history)[4], PostResponse<R, 3>& out) const {
    const R carried = pair.radius * maximum(pair.normal_force, R(0.0));
    const R bodies = select(pair.radius_j > R(0.0), R(2.0), R(1.0));
    spring_.resist(pair, R(stiffness_) * carried, R(limit_) * bodies * carried, history, out);
  }

 private:
  RollingSpring spring_;
  double stiffness_ = 0, limit_ = 0;  // k_r and M_max over R F_n at a wall
};

constexpr Descriptor kDescriptor = describe<BeadShape>({
    .name = "bead_shape",
    .version = "1.0",
    .doc = "Spheres that resist rolling as beads of another aspect ratio do.",
    .equation = "M = -k_r theta, k_r = F_n b (alpha^2 - 1), |M| <= F_n (a - b)/pi, a = R alpha^(2/3), b = R alpha^(-1/3)",
    .citation = "after Wensrich & Katterfeld 2012, doi:10.1016/j.powtec.2011.10.057",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
