// The tangential spring with a memory and Coulomb's cap, shared by the contact laws.
//
// symbol    here            meaning
// S_t       stiffness       tangential stiffness, N/m; may change with the overlap
// γ_t       damping         N s/m
// δ⁻        history         slip kept by the spring half a step ago, m, in the world frame
// T         trial           δ⁻ on the tangent plane + ½ v_t Δt: the spring at the time of the overlap
// s         kept            part of T that the cap leaves
// L         limit           μ max(F_n + added cap, 0), N
//
//   cap spring:  s = min(1, L/|S_t T|),           F_t = −s S_t T − γ_t v_t [no sliding]
//   cap sum:     s = min(1, L/|S_t T + γ_t v_t|), F_t = −s (S_t T + γ_t v_t)
//
// and the spring keeps s T. (Cutting the spring so far that spring + whole damping = L would load it backwards in fast sliding.)
//
// The velocity is that predicted for the time of the overlap, so the slip is advanced half a step before the force and half a step
// after it (the midpoint rule): a whole step before the force would act as damping of S_t Δt/2.
//
// The ledger over one step, with p = (1 − s) T the slip that the cap took away: −F_t·v_t Δt = ΔU + friction + damping + stiffness change,
//   friction = S_t p·(δ⁻ − ½ p) + ½ S_t (δ⁻·n)²,  damping = γ_t v_t² Δt,  stiffness change = −½ ½(|δ⁻|² + |δ⁺|²) ΔS_t (either sign),
// where the second part of the friction is what the turning of the tangent plane takes, and δ⁺ is the next δ⁻.
#pragma once

#include "millscope/contact_law_adapter.hpp"

namespace millscope::laws {

enum class Cap { spring, sum };

inline Cap cap_choice(const Parameters& values) { return values.text("cap") == "sum" ? Cap::sum : Cap::spring; }

/// The spring's properties at this instant. `scale` x is what the laws have to divide by: one division serves them and the cap.
template <class R>
struct Spring {
  R stiffness;
  R damping;
  R limit;
  R scale;          ///< x > 0
  R softness;       ///< x/S_t
  R growth_scaled;  ///< x² (dS_t/dt)/S_t
};

/// What a damped collision loses beyond c v_n², as a share of it. Steps of Δt sum the elastic work by trapezoids; where the force begins
/// and ends between two steps they take too much on the way in and give back too much, at lower speed, on the way out: S_n Δt²/(6 m*) of
/// the loss for a linear spring, about S_n Δt²/(10 m*) for Hertz's (summed over where in a step the touch falls, 10 to 20 steps per
/// contact). One eighth leaves at most 0.4 % of a collision's loss unaccounted at 13 steps; without it, up to 0.9 %.
template <class R>
R entry_share(const Contact<R>& c, const R& stiffness, const R& per_mass) {
  return R(1.0 / 8.0) * c.time_step * c.time_step * stiffness * per_mass;
}

template <class R>
struct Shear {
  Vec<R> force;
  R elastic_energy;
  R damping, friction, stiffness_change;  ///< W lost
  R per_mass;                             ///< 1/m*, for what the law itself books
};

/// Slip at the time of the overlap: the history on the tangent plane, advanced by half a step.
template <class R>
struct Slip {
  Vec<R> speed;  ///< v_t
  Vec<R> trial;  ///< T
  R off_plane;   ///< δ⁻·n
};

template <class R>
[[gnu::always_inline]] inline Slip<R> advance_slip(const Contact<R>& c, const R& normal_speed, const R (&history)[3]) {
  Slip<R> slip;
  slip.speed = c.velocity - normal_speed * c.normal;
  const Vec<R> before{history[0], history[1], history[2]};
  slip.off_plane = dot(before, c.normal);
  slip.trial = (before - slip.off_plane * c.normal) + (R(0.5) * c.time_step) * slip.speed;
  return slip;
}

/// Keeps the slip for the next step; without contact nothing is kept.
template <class R>
[[gnu::always_inline]] inline void keep_slip(const Contact<R>& c, const Vec<R>& now, const Vec<R>& speed, R (&history)[3]) {
  const auto touching = c.overlap > R(0.0);
  const R zero(0.0), half_step = R(0.5) * c.time_step;
  history[0] = select(touching, now.x + half_step * speed.x, zero);
  history[1] = select(touching, now.y + half_step * speed.y, zero);
  history[2] = select(touching, now.z + half_step * speed.z, zero);
}

template <class R>
[[gnu::always_inline]] inline Shear<R> pull_spring(const Contact<R>& c, const R& normal_speed, const Spring<R>& spring, Cap cap,
                                                   R (&history)[3]) {
  const R zero(0.0), one(1.0), half(0.5), tiny(1e-100);
  const Slip<R> slip = advance_slip(c, normal_speed, history);
  const R trial_speed = dot(slip.trial, slip.speed), trial_square = dot(slip.trial, slip.trial), speed_square = dot(slip.speed, slip.speed);
  const R share_mass = spring.scale * c.mass;
  Shear<R> out;
  R kept, damping, per_scale_mass;  // the last is 1/(x m*)
  if (cap == Cap::spring) {
    const R distance = maximum(square_root(trial_square), tiny);
    const R inverse = one / (distance * share_mass);
    const auto sliding = spring.stiffness * distance > spring.limit;
    kept = select(sliding, spring.limit * (spring.softness * c.mass * inverse), one);
    damping = select(sliding, zero, spring.damping);
    per_scale_mass = inverse * distance;
  } else {
    const R sum = maximum(length(spring.stiffness * slip.trial + spring.damping * slip.speed), tiny);
    const R inverse = one / (sum * share_mass);
    kept = select(sum > spring.limit, spring.limit * (inverse * share_mass), one);
    damping = kept * spring.damping;
    per_scale_mass = inverse * sum;
  }
  const Vec<R> now = kept * slip.trial;
  const R now_square = kept * kept * trial_square;
  const R lost = (one - kept) * ((one + kept) * trial_square - c.time_step * trial_speed);
  out.force = (-(spring.stiffness * kept)) * slip.trial - damping * slip.speed;
  out.damping = damping * speed_square;
  keep_slip(c, now, slip.speed, history);
  const R half_stiffness = half * spring.stiffness;
  out.elastic_energy = half_stiffness * now_square;
  out.friction = maximum(half_stiffness * (lost + slip.off_plane * slip.off_plane) * c.per_time_step, zero);
  const R per_scale = per_scale_mass * c.mass;
  // Within one step S_t cannot change by more than itself: bounds the rate at the first and the last touch.
  const R growth = spring.growth_scaled * (per_scale * per_scale);
  const R mean_square = half * (now_square + trial_square - c.time_step * ((one - kept) * trial_speed - half * c.time_step * speed_square));
  out.stiffness_change = -(half_stiffness * mean_square * maximum(minimum(growth, c.per_time_step), -c.per_time_step));
  out.per_mass = per_scale_mass * spring.scale;
  return out;
}

}  // namespace millscope::laws
