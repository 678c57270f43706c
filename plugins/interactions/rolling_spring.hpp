// A rolling resistance that is elastic up to a limit and slides there; what resists (k_r, M_max) is the plugin's.
//
// symbol   here        meaning
// θ        history     rolling angle held by the spring, rad (3 components in the world frame, half a step ahead of the force)
// k_r      stiffness   N m/rad
// M_max    limit       N m
// I_r      inertia     1/(1/(I_i + m_i R_i²) + 1/(I_j + m_j R_j²)), I = 2/5 m R²; the two beads have the same density
// η        damping     ratio to the critical one; the dashpot acts only while the spring does not slide
//
//   M = −k_r θ, |M| ≤ M_max (the spring is cut back),  −2 η √(I_r k_r) ω_roll,   U = ½ k_r θ²
//
// k_r changes from step to step: −½ θ² Δk_r is booked as stiffness_change.
#pragma once

#include "rolling.hpp"

namespace millscope::interactions {

struct RollingSpring {
  static constexpr int kHistory = 4, kChannels = 3;
  static constexpr PairTermInfo kInfo = pair_term({{"angle_x", -1}, {"angle_y", -1}, {"angle_z", -1}, {"stiffness", 1}},
                                                  {{"rolling_damping", ChannelPart::rolling, ChannelNature::dissipative},
                                                   {"rolling", ChannelPart::rolling, ChannelNature::dissipative},
                                                   {"rolling_stiffness_change", ChannelPart::rolling, ChannelNature::elastic}});

  double damping;

  /// `stiffness` and `limit` are those of a contact that is closed; both bodies feel the moment.
  template <class R>
  void resist(const PairState<R>& pair, const R& stiffness_closed, const R& limit_closed, R (&history)[4], PostResponse<R, 3>& out) const {
    const R zero(0.0), one(1.0), half(0.5), tiny(1e-100);
    const R held = select(pair.overlap > zero, one, zero), stiffness = held * stiffness_closed, limit = held * limit_closed;
    const R rate = select(pair.time_step > zero, one, zero) / maximum(pair.time_step, R(1e-300));

    const Vec<R> spin = rolling_part(pair.spin_i - pair.spin_j, pair.normal);
    const Vec<R> angle{history[0], history[1], history[2]};
    const Vec<R> before = rolling_part(angle, pair.normal);
    const Vec<R> half_turn = (half * pair.time_step) * spin;
    const Vec<R> trial = before + half_turn;
    const R distance = maximum(length(trial), tiny), asked = stiffness * distance;
    const auto sliding = asked > limit;
    const R kept = minimum(one, limit / maximum(asked, tiny));  // nothing where neither resists: no angle is held without a load
    R dashpot = zero;
    if (damping > 0.0) dashpot = select(sliding, zero, R(2.0 * damping) * square_root(inertia(pair) * stiffness));
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
};

inline constexpr Parameter rolling_damping_parameter =
    number_parameter("damping_ratio", "1", 0.0, 0.0, 10.0, "Damping of the rolling spring over the critical one; 0: none.");

}  // namespace millscope::interactions
