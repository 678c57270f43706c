// Rolling resistance as an elastic-plastic spring with an optional dashpot (Ai et al. 2011, model C).
//
// symbol   here        meaning
// μ_r      –           coefficient of rolling friction, 1
// L        lever       R* (Ai's R_r) or the bead's radius, m
// θ        history     rolling angle held by the spring, rad (3 components in the world frame, half a step ahead of the force)
// k_r      stiffness   2.25 k_n μ_r² L², N m/rad
// M_max    limit       μ_r L F_n, N m
// I_r      inertia     1/(1/(I_i + m_i R_i²) + 1/(I_j + m_j R_j²)), I = 2/5 m R²; the two beads have the same density
// η        –           damping ratio; the dashpot acts only while the spring does not slide
//
//   M = −k_r θ, |M| ≤ M_max (the spring is cut back),  −2 η √(I_r k_r) ω_roll,   U = ½ k_r θ²
//
// k_n changes from step to step, and k_r with it: −½ θ² Δk_r is booked as stiffness_change.
#include "options.hpp"
#include "rolling.hpp"

namespace millscope::interactions {
namespace {

constexpr Parameter kParameters[] = {
    rolling_friction_parameter,
    rolling_length_parameter,
    number_parameter("damping_ratio", "1", 0.0, 0.0, 10.0, "Damping of the rolling spring over the critical one; 0: none."),
};

constexpr Hypothesis kHypotheses[] = {
    {"rolling_resistance", "Rolling is resisted elastically at first, then plastically: beads can rest on a slope.",
     "M = -k_r theta, |M| <= mu_r R* F_n", "Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030", "rolling_friction", 0.0, 0.0, 0.2, 0, 0,
     "damping_ratio", "rolling_friction"},
};

class RollingEpsd {
 public:
  static constexpr int kHistory = 4, kChannels = 3;
  static constexpr ContactLawInfo kInfo = {4,
                                           3,
                                           {-1, -1, -1, 1, 1, 1},
                                           {"angle_x", "angle_y", "angle_z", "stiffness", "", ""},
                                           {"rolling_damping", "rolling", "rolling_stiffness_change", "", "", ""}};

  RollingEpsd(const Parameters& values, const PairContext&)
      : friction_(values.number("rolling_friction")),
        damping_(values.number("damping_ratio")),
        effective_(values.text("length") == "effective") {}

  double reach(double) const { return 0.0; }

  template <class R>
  void post(const PairState<R>& pair, R (&history)[4], PostResponse<R, 3>& out) const {
    const R zero(0.0), one(1.0), half(0.5), tiny(1e-100);
    const auto touching = pair.overlap > zero;
    const R held = select(touching, one, zero);
    const R rate = select(pair.time_step > zero, one, zero) / maximum(pair.time_step, R(1e-300));
    const R lever = rolling_lever(pair, effective_) * R(friction_);
    const R stiffness = held * R(2.25) * maximum(pair.normal_stiffness, zero) * lever * lever;
    const R limit = held * lever * maximum(pair.normal_force, zero);

    const Vec<R> spin = rolling_part(pair.spin_i - pair.spin_j, pair.normal);
    const Vec<R> angle{history[0], history[1], history[2]};
    const Vec<R> before = rolling_part(angle, pair.normal);
    const Vec<R> half_turn = (half * pair.time_step) * spin;
    const Vec<R> trial = before + half_turn;
    const R distance = maximum(length(trial), tiny), asked = stiffness * distance;
    const auto sliding = asked > limit;
    const R kept = select(sliding, limit / maximum(asked, tiny), one);
    const R dashpot = select(sliding, zero, R(2.0 * damping_) * square_root(inertia(pair) * stiffness));
    const Vec<R> now = kept * trial, taken = (one - kept) * trial;

    out.moment_i = (-stiffness) * now - dashpot * spin;
    out.moment_j = R(-1.0) * out.moment_i;
    out.elastic_energy = half * stiffness * dot(now, now);
    out.power[0] = dashpot * dot(spin, spin);
    const R twist = dot(angle, pair.normal);  // lost as the rolling plane turns
    out.power[1] = maximum(stiffness * (dot(taken, before) - half * dot(taken, taken) + half * twist * twist) * rate, zero);
    out.power[2] = -(half * dot(before, before) * (stiffness - history[3]) * rate);
    history[0] = held * (now.x + half_turn.x);
    history[1] = held * (now.y + half_turn.y);
    history[2] = held * (now.z + half_turn.z);
    history[3] = stiffness;
  }

 private:
  /// I_r from R_i, R_j and m*: of beads of one density m_i = m* (1 + R_i³/R_j³).
  template <class R>
  static R inertia(const PairState<R>& pair) {
    const R zero(0.0), one(1.0);
    const auto wall = pair.radius_j <= zero;
    const R ratio = pair.radius_i / select(wall, one, pair.radius_j), cube = ratio * ratio * ratio;
    const R i = R(1.4) * pair.mass * (one + select(wall, zero, cube)) * pair.radius_i * pair.radius_i;
    const R j = R(1.4) * pair.mass * (one + one / maximum(cube, R(1e-100))) * pair.radius_j * pair.radius_j;
    return select(wall, i, i * j / maximum(i + j, R(1e-300)));
  }

  double friction_, damping_;
  bool effective_;
};

constexpr InteractionTable kTable = make_interaction_table<RollingEpsd>();

constexpr Descriptor kDescriptor = [] {
  Descriptor d = interaction_descriptor<RollingEpsd>("rolling_epsd", &kTable, kParameters, kHypotheses);
  d.doc = "Rolling resistance by an elastic-plastic spring, optionally with a dashpot.";
  d.equation = "M = -k_r theta, k_r = 2.25 k_n mu_r^2 R*^2, |M| <= mu_r R* F_n";
  d.citation = "Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030";
  return d;
}();

}  // namespace
}  // namespace millscope::interactions

MILLSCOPE_PLUGINS(&millscope::interactions::kDescriptor)
