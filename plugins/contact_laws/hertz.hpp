// Hertz's normal spring with viscous damping, over a tangential spring of choice.
//
// symbol   here               meaning
// δ_n      overlap            m
// a        contact            √(R* δ_n), radius of the contact, m
// E*, G*   young_, shear_     effective moduli, Pa
// S_n      stiffness          dF_n/dδ_n = 2 E* a, N/m
// S_t      –                  8 G* a, N/m
// β        –                  ln e/√(ln² e + π²)
// v_n      normal_speed       v·n, > 0 when parting, m/s
//
//   F_n = 4/3 E* a δ_n − 2√(5/6)|β| √(S_n m*) v_n      (Chagas 2015, Eq. 3.6–3.8, corrected)
//   U_n = 8/15 E* a δ_n²
//
// Hertz 1882; Tsuji, Tanaka & Ishida 1992; Antypov & Elliott 2011. One root gives a, one √(m* a) both dampings.
#pragma once

#include "options.hpp"
#include "restitution.hpp"
#include "tangential_spring.hpp"

namespace millscope::laws {

/// `Tangential` has kHistory, kInfo with four channels, and pull(contact, normal speed, spring, cap, history).
template <class Tangential>
class Hertz {
 public:
  static constexpr int kHistory = Tangential::kHistory, kChannels = 4;
  static constexpr PairTermInfo kInfo = Tangential::kInfo;

  Hertz(const Parameters& values, const PairContext& pair)
      : young_(pair.effective_young),
        normal_stiffness_(2.0 * pair.effective_young),
        shear_stiffness_(8.0 * pair.effective_shear),
        restitution_(values.number("restitution")),
        friction_(values.number("static_friction")),
        damping_(hertz_damping(restitution_)),
        normal_root_(std::sqrt(normal_stiffness_)),
        shear_root_(std::sqrt(shear_stiffness_)),
        shear_softness_(1.0 / shear_stiffness_),
        tension_(values.flag("allow_tension")),
        pulled_friction_(values.flag("friction_in_tension")),
        cap_(cap_choice(values)) {}

  double reach(double) const { return 0.0; }
  double restitution() const { return restitution_; }
  double friction() const { return friction_; }
  /// Hertz: 2.87 (m*²/(R* E*² v))^{1/5}, undamped.
  double contact_time(double radius, double mass, double speed) const {
    return 2.87 * std::pow(mass * mass / (radius * young_ * young_ * speed), 0.2);
  }

  template <class R>
  [[gnu::always_inline]] inline void force(const Contact<R>& c, R (&history)[kHistory], Response<R, 4>& out) const {
    const R zero(0.0);
    const R overlap = maximum(c.overlap, zero);
    const R normal_speed = dot(c.velocity, c.normal);
    const R contact = square_root(c.radius * overlap);
    R damping(damping_);
    if (!c.own_e) damping = lanewise(hertz_damping, c.restitution);
    const R root = damping * square_root(c.mass * contact);

    const R stiffness = R(normal_stiffness_) * contact;
    const R elastic = R(2.0 / 3.0) * stiffness * overlap;
    R total = elastic - R(normal_root_) * root * normal_speed;
    if (!tension_) total = maximum(total, zero);
    R pressing = total;
    if (pulled_friction_) pressing = maximum(total, -total);
    const R limit = c.friction * maximum(pressing + c.added_cap, zero);

    const Spring<R> spring{R(shear_stiffness_) * contact, R(shear_root_) * root, limit,
                           maximum(contact, R(1e-100)),   R(shear_softness_),    R(-0.5) * c.radius * normal_speed};
    const Shear<R> shear = Tangential::pull(c, normal_speed, spring, cap_, history);
    out.force = total * c.normal + shear.force;
    out.normal_force = total;
    out.normal_stiffness = stiffness;
    out.elastic_energy = R(0.4) * elastic * overlap + shear.elastic_energy;
    R taken = R(1.0) + entry_share(c, stiffness, shear.per_mass);
    if (!tension_) taken = select(total > zero, taken, R(1.0));  // no force, no loss
    out.power[0] = (elastic - total) * normal_speed * taken;
    out.power[1] = shear.damping;
    out.power[2] = shear.friction;
    out.power[3] = shear.stiffness_change;
  }

 private:
  double young_, normal_stiffness_, shear_stiffness_;  // E*, S_n/a, S_t/a
  double restitution_, friction_, damping_, normal_root_, shear_root_, shear_softness_;
  bool tension_, pulled_friction_;
  Cap cap_;
};

}  // namespace millscope::laws
