// Mindlin and Deresiewicz's contact with partial slip (1953), its history held by two springs.
//
// A contact of spheres equals a row of springs (reduction of dimension: Jäger 1995; Popov & Heß 2015, ch. 5): the one at x = ξ a begins
// to bear when the overlap passes η = x²/R* = ξ² δ_n, its tangential stiffness per length is 4 G*, and it slides where its slip u reaches
//
//   4 G* |u| = μ E* (δ_n − η)        F_t = 8 G* a ∫₀¹ u dξ        U_t = 4 G* a ∫₀¹ u² dξ
//
// Loading, unloading, reloading and changing compression need no cases of their own: they are what the springs remember. For the integrals
// Gauss's rule with three points over −1 ≤ ξ ≤ 1 has one spring at the centre, ξ = 0, and one at ξ² = 3/5:
//
//   spring   share w of S_t   limit on w S_t |u|
//   centre   4/9              2/3 μ F_n
//   outer    5/9              1/3 μ F_n            so that |F_t| ≤ μ F_n, F_t = S_t u while nothing slips, S_t = 8 G* a
//
// Each is the spring of tangential_spring.hpp. Between its pulls the outer one moves with the contact's radius to a place that bore
// before, where the slip is read off straight lines in η through the centre, itself and the edge, where it is zero. For ρ = δ_n'/δ_n:
//
//   ρ ≥ 1, growing:    u' = max(5/2 − 3/2 ρ, 0) u            ρ < 1, shrinking:  u' = u_c + ρ (u − u_c)
//
// Both are means of what was held: no slip is made. Contact that joins bears nothing, as it should (F_t grows by S_t dδ_t, not by
// d(S_t δ_t)). Half of the move comes before the pull, half after it, as half of the slip does. With S_t ∝ √δ_n the energy changes by
//
//   shrinking:  dU_t/d ln δ_n = S_t/9 |u_c − 5/2 u|² = 1/4 S_t |u_edge|²      u_edge: the straight line's value at the edge
//   growing:    dU_t/d ln δ_n = S_t/9 (|u_c|² − 25/4 |u|²)
//
// The first is what the edge of the row of springs takes with it as it parts: friction, never negative. The second vanishes where slip and
// load grew together, u = 2/5 u_c, as it does at any slip in the row; of two springs the rest is the channel stiffness_change.
#pragma once

#include "tangential_spring.hpp"

namespace millscope::laws {

struct PartialSlip {
  static constexpr int kHistory = 6;
  static constexpr PairTermInfo kInfo = pair_term({{"centre_slip_x", -1},
                                                   {"centre_slip_y", -1},
                                                   {"centre_slip_z", -1},
                                                   {"outer_slip_x", -1},
                                                   {"outer_slip_y", -1},
                                                   {"outer_slip_z", -1}},
                                                  kSpringChannels);

  template <class R>
  [[gnu::always_inline]] static inline Shear<R> pull(const Contact<R>& c, const R& normal_speed, const Spring<R>& spring, Cap cap,
                                                     R (&history)[6]) {
    const R one(1.0), zero(0.0), tiny(1e-100), half(0.5);
    const R overlap = maximum(c.overlap, tiny), change = half * c.time_step * normal_speed;  // parting makes it smaller
    const R growth_before = overlap / maximum(overlap + change, tiny), growth_after = maximum(one - change / overlap, zero);
    R centre[3] = {history[0], history[1], history[2]}, outer[3] = {history[3], history[4], history[5]};

    // Σ w |u|², relative to S_t of this overlap, before and after each of the two moves. S_t goes with the root of the overlap.
    const R first = held(centre, outer) / square_root(growth_before);
    move(growth_before, centre, outer);
    const R second = held(centre, outer);
    const Shear<R> inner = pull_spring(c, normal_speed, part(spring, kCentre, 2.0 / 3.0), cap, centre);
    const Shear<R> rim = pull_spring(c, normal_speed, part(spring, kOuter, 1.0 / 3.0), cap, outer);
    const R third = held(centre, outer);
    move(growth_after, centre, outer);
    const R fourth = held(centre, outer) * square_root(growth_after);
    for (int k = 0; k < 3; ++k) history[k] = centre[k], history[k + 3] = outer[k];

    const auto grows_before = growth_before > one, grows_after = growth_after > one;
    const R parted = select(grows_before, zero, first - second) + select(grows_after, zero, third - fourth);
    const R joined = select(grows_before, first - second, zero) + select(grows_after, third - fourth, zero);
    const R to_power = half * spring.stiffness * c.per_time_step;
    Shear<R> out;
    out.force = inner.force + rim.force;
    out.elastic_energy = inner.elastic_energy + rim.elastic_energy;
    out.damping = inner.damping + rim.damping;
    out.friction = inner.friction + rim.friction + to_power * maximum(parted, zero);
    out.stiffness_change = to_power * joined;
    out.per_mass = inner.per_mass;
    return out;
  }

 private:
  static constexpr double kCentre = 4.0 / 9.0, kOuter = 5.0 / 9.0;

  template <class R>
  static Spring<R> part(const Spring<R>& whole, double share, double share_of_limit) {
    return {R(share) * whole.stiffness,      R(share) * whole.damping,
            R(share_of_limit) * whole.limit, whole.scale,
            R(1.0 / share) * whole.softness, R(0.0)};
  }

  /// Σ w |u|²
  template <class R>
  static R held(const R (&centre)[3], const R (&outer)[3]) {
    return R(kCentre) * (centre[0] * centre[0] + centre[1] * centre[1] + centre[2] * centre[2]) +
           R(kOuter) * (outer[0] * outer[0] + outer[1] * outer[1] + outer[2] * outer[2]);
  }

  /// The outer spring's slip when the overlap grows by this ratio.
  template <class R>
  static void move(const R& growth, const R (&centre)[3], R (&outer)[3]) {
    const auto growing = growth > R(1.0);
    const R own = select(growing, maximum(R(2.5) - R(1.5) * growth, R(0.0)), growth), other = select(growing, R(0.0), R(1.0) - growth);
    for (int k = 0; k < 3; ++k) outer[k] = own * outer[k] + other * centre[k];
  }
};

}  // namespace millscope::laws
