// A pool of liquid in the lower part of the mill: buoyancy, fluid that moves with the bead, drag (Schiller & Naumann 1933).
//
// symbol   here      meaning
// y_s      level_    height of the flat surface above the mill axis (y = 0), m; it stays where it is
// h        depth     of the bead's lowest point under the surface, 0 to 2R, m
// V, A     volume, area   of the submerged cap and of its waterline, m³, m²
// ρ, ν     –         density and kinematic viscosity of the liquid, kg/m³, m²/s
// U, DU    flow, turn   velocity of the liquid and its material acceleration: 0, or Ω × r and −Ω² (x, y, 0)
// v, m_a   –         velocity of the bead; added mass ½ ρ V, kg
// ε, χ     porosity_, –   share of the volume that liquid fills among the beads; χ = 3.7 − 0.65 exp(−½ (1.5 − log₁₀ Re)²)
//
//   V = π h² (3R − h)/3,  A = dV/dh = π h (2R − h)
//   F = ρ V (DU − g) + m_a DU + s (U − v) + V/V_bead · k(ε|U − v|) ε^−χ (U − v),  s = max(dm_a/dt, 0),  dm_a/dt = −½ ρ A v_y
//   (m + m_a) dv/dt = F + all other forces
//
// k(|u|) is the drag of a single sphere over its speed, Re = ε|u| d/ν (Di Felice 1994 with static buoyancy); ε = 1: a bead without
// neighbours. s is the momentum that a bead hands to the liquid it sets in motion when it dives in (von Kármán 1929); without it that
// liquid would get its energy from nowhere. A bead that emerges leaves that energy behind. All terms are in proportion to ρ and grow from 0
// at the surface. Neighbours change neither buoyancy nor added mass, and the spin is not slowed.
//
// Power taken from the bead is −F·v − ½ v² dm_a/dt: its sum is what the liquid took for good, and its potential energy. What the ledger has
// no place for is the liquid's kinetic energy Σ ½ m_a v², which in a steady state does not grow.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drag.hpp"
#include "millscope/body_force_adapter.hpp"

namespace millscope::body_forces {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("fluid_density", "kg/m^3", 1000.0, 0.0, 20000.0, "Density of the liquid; water: 1000. At 0 there is no pool."),
    number_parameter("level", "m", -0.05, -1000.0, 1000.0,
                     "Height of the surface above the mill axis, y; -0.05 is the top of a 30 % filling in a mill of 300 mm."),
    number_parameter("kinematic_viscosity", "m^2/s", 1e-6, 0.0, 0.1, "Viscosity over density; water at 20 C: 1e-6."),
    number_parameter("porosity", "1", 1.0, 0.3, 1.0, "Share of liquid among submerged beads, which raises the drag; 1: single beads.",
                     "Di Felice 1994, doi:10.1016/0301-9322(94)90011-6"),
    choice_parameter("flow", "at_rest|turning", "at_rest", "Velocity of the liquid: none, or rigid rotation about the mill axis."),
    number_parameter("angular_velocity", "rad/s", 0.0, -1000.0, 1000.0,
                     "Of the turning liquid about z, counter-clockwise; needed where flow is turning."),
    number_parameter("gravity", "m/s^2", 9.81, 0.0, 1000.0, "Acceleration along -y that presses the liquid."),
};

constexpr Hypothesis kHypotheses[] = {
    {"fluid_pool", "A pool of liquid lightens and slows the bed below its level.", "F = rho V g + drag, added mass rho V/2",
     "Schiller & Naumann 1933", "fluid_density", 0.0, 0.0, 1200.0},
};

class FluidPool {
 public:
  explicit FluidPool(const Parameters& values)
      : fluid_{values.number("fluid_density"), values.number("fluid_density") * values.number("kinematic_viscosity")},
        level_(values.number("level")),
        porosity_(values.number("porosity")),
        gravity_(values.number("gravity")),
        turning_(values.text("flow") == "turning" ? values.number("angular_velocity") : 0.0) {
    if (values.text("flow") == "at_rest" && values.number("angular_velocity") != 0.0) {
      throw Refusal("fluid_pool: angular_velocity is given but flow is at_rest; write flow: turning or leave it out");
    }
    if (values.text("flow") == "turning" && values.number("angular_velocity") == 0.0) {
      throw Refusal("fluid_pool: flow is turning but angular_velocity is 0; give that of the mill in rad/s, or write flow: at_rest");
    }
  }

  template <class R>
  void act(const BeadState<R>& bead, BeadResponse<R>& out) const {
    if (fluid_.density == 0.0) return;
    const R zero(0.0), pi(std::numbers::pi), density(fluid_.density);
    const Vec<R>&x = bead.position, &v = bead.velocity;
    const R full = R(2.0) * bead.radius, depth = maximum(zero, minimum(R(level_) - x.y + bead.radius, full));
    if (!any(depth > zero)) return;
    const R volume = pi * R(1.0 / 3.0) * depth * depth * (R(3.0) * bead.radius - depth), area = pi * depth * (full - depth);
    const R displaced = density * volume, added = R(0.5) * displaced, growth = R(-0.5) * density * area * v.y;

    const Vec<R> flow{R(-turning_) * x.y, R(turning_) * x.x, zero}, slip = flow - v;
    const Vec<R> turn{R(-turning_ * turning_) * x.x, R(-turning_ * turning_) * x.y, zero};
    const R share = volume / (R(4.0 / 3.0) * pi * bead.radius * bead.radius * bead.radius);
    const R resistance = maximum(growth, zero) + share * drag(full, length(slip));
    out.force = displaced * (turn + Vec<R>{zero, R(gravity_), zero}) + added * turn + resistance * slip;
    out.added_mass = added;
    out.power = -dot(out.force, v) - R(0.5) * growth * dot(v, v);
  }

 private:
  /// Drag over slip of a submerged bead of this diameter, N s/m.
  template <class R>
  R drag(const R& diameter, const R& speed) const {
    const R single = drag_rate(fluid_, diameter, R(porosity_) * speed);
    if (porosity_ == 1.0) return single;
    const R reynolds = R(fluid_.density * porosity_ / std::max(fluid_.viscosity, 1e-300)) * speed * diameter;
    const R decades = R(1.5) - R(1.0 / std::numbers::ln10) * logarithm(reynolds);
    const R exponent = R(0.65) * exponential(R(-0.5) * decades * decades) - R(3.7);  // −χ
    return single * exponential(exponent * R(std::log(porosity_)));
  }

  Fluid fluid_;
  double level_, porosity_, gravity_, turning_;
};

constexpr Descriptor kDescriptor = describe<FluidPool>({
    .name = "fluid_pool",
    .version = "1.0",
    .doc = "A liquid with a flat surface in the lower part of the mill: buoyancy, added mass and drag on what is submerged.",
    .equation = "(m + rho V/2) a = F + rho V g + drag, V the submerged cap",
    .citation = "Schiller & Naumann 1933; Di Felice 1994, doi:10.1016/0301-9322(94)90011-6; von Karman 1929, NACA TN 321",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::body_forces

MILLSCOPE_PLUGINS(&millscope::body_forces::kDescriptor)
