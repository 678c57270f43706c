// Mindlin and Deresiewicz's tangential force with partial slip, in Langston's closed form (Chagas 2015, Eq. 3.13–3.15, corrected).
//
// symbol   here        meaning
// N        load        F_el + added cap, N: the compression that holds the contact
// S_t      stiffness   8 G* a: stiffness at no slip, N/m
// χ        largest     3/2 μ N/S_t = μ E* δ_n/(4 G*): slip at which the whole contact slides, m
// u        slipped     |δ_t|/χ, 0…1
//
//   F_t = −μ N [1 − (1 − u)^{3/2}] δ_t/|δ_t| − 2 √(5/6)|β| √(m* S_t √(1 − u)) v_t
//   U_t = μ N χ [u − 2/5 (1 − (1 − u)^{5/2})]
//
// The spring follows the elastic F_n so that it has a potential; where damping lowers F_n, the slip is cut back to
// u = 1 − (1 − L/(μ N))^{2/3} with L = μ max(F_n, 0). A sliding contact is pulled with L. The work of turning and compressing at constant
// slip, (∂U_t/∂δ_n) δ̇_n, goes to stiffness_change. Cap `sum` lets through the part of the damping force that keeps |F_t| ≤ L.
#pragma once

#include <cmath>

#include "tangential_spring.hpp"

namespace millscope::laws {

/// U_t/(μ N χ) at u; beyond full slip it grows along the line of constant force.
template <class R>
[[gnu::always_inline]] inline R partial_slip_energy(const R& u) {
  const R rest = maximum(R(1.0) - u, R(0.0));
  return u - R(0.4) * (R(1.0) - rest * rest * square_root(rest));
}

/// F_t/(μ N) at u.
template <class R>
[[gnu::always_inline]] inline R partial_slip_force(const R& u) {
  const R rest = maximum(R(1.0) - u, R(0.0));
  return R(1.0) - rest * square_root(rest);
}

template <class R>
[[gnu::always_inline]] inline Shear<R> pull_partial_slip(const Contact<R>& c, const R& normal_speed, const R& elastic,
                                                         const Spring<R>& spring, Cap cap, R (&history)[3]) {
  const R zero(0.0), one(1.0), half(0.5), tiny(1e-100);
  const Slip<R> slip = advance_slip(c, normal_speed, history);
  const R load = maximum(elastic + c.added_cap, zero);
  const R strength = c.friction * load;
  const R largest = maximum(R(1.5) * strength / maximum(spring.stiffness, tiny), tiny);
  const R distance = maximum(length(slip.trial), tiny);
  const R share = minimum(spring.limit / maximum(strength, tiny), one);
  const R held = lanewise([](double q) { return std::cbrt(q * q); }, one - share);
  const R asked = distance / largest;
  const auto sliding = asked > one - held;
  const R slipped = select(sliding, one - held, asked);
  const R rest = one - slipped, root = square_root(rest);
  const R kept = slipped * largest / distance;
  const R pull = strength * (one - rest * root);
  const R scale = strength * largest;

  Shear<R> out;
  const R size = select(sliding, spring.limit, pull);
  const Vec<R> spring_force = (-(size / distance)) * slip.trial;
  const R damping = spring.damping * square_root(root);
  const R speed_square = dot(slip.speed, slip.speed);
  R passed = select(sliding, zero, one);
  if (cap == Cap::sum) {  // the root in [0, 1] of |F_spring − passed γ v| = L
    const R a = maximum(damping * damping * speed_square, tiny), b = -(damping * dot(spring_force, slip.speed));
    const R free = maximum(spring.limit * spring.limit - size * size, zero);
    passed = maximum(minimum((square_root(b * b + a * free) - b) / a, one), zero);
  }
  out.force = spring_force - (passed * damping) * slip.speed;
  out.per_mass = one / c.mass;
  out.damping = passed * damping * speed_square;
  out.elastic_energy = scale * partial_slip_energy(slipped);

  const Vec<R> now = kept * slip.trial, half_step = (half * c.time_step) * slip.speed;
  const R before = length(slip.trial - half_step) / largest, after = length(now + half_step) / largest;
  const R energy_before = partial_slip_energy(before), energy_after = partial_slip_energy(after);
  const R work = -(dot(spring_force, slip.speed) * c.time_step);
  const R lost = select(sliding, work - scale * (energy_after - energy_before), zero);
  out.friction = maximum((lost + half * spring.stiffness * slip.off_plane * slip.off_plane) * c.per_time_step, zero);
  keep_slip(c, now, slip.speed, history);

  // ∂U_t/∂ln δ_n with N ∝ δ_n^{3/2} in its elastic part and χ = 3/2 μ N/S_t: the mean of what is held before and after the step.
  const R part = elastic / maximum(load, tiny), by_energy = R(3.0) * part - half, by_slip = R(1.5) * part - half;
  const R with_overlap =
      half * scale *
      ((energy_before + energy_after) * by_energy - (before * partial_slip_force(before) + after * partial_slip_force(after)) * by_slip);
  const R growth = maximum(minimum(R(2.0) * spring.growth_scaled / (spring.scale * spring.scale), c.per_time_step), -c.per_time_step);
  out.stiffness_change = -(with_overlap * growth);
  return out;
}

}  // namespace millscope::laws
