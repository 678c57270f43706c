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

  void act(const Bead& bead, BeadForce& out) const {
    const Vec<double>&x = bead.position, &v = bead.velocity;
    const double full = 2.0 * bead.radius, depth = std::clamp(level_ - x.y + bead.radius, 0.0, full);
    if (depth == 0.0 || fluid_.density == 0.0) return;
    const double volume = std::numbers::pi / 3.0 * depth * depth * (3.0 * bead.radius - depth),
                 area = std::numbers::pi * depth * (full - depth);
    const double displaced = fluid_.density * volume, added = 0.5 * displaced, growth = -0.5 * fluid_.density * area * v.y;

    const Vec<double> flow{-turning_ * x.y, turning_ * x.x, 0.0}, slip = flow - v;
    const Vec<double> turn{-turning_ * turning_ * x.x, -turning_ * turning_ * x.y, 0.0};
    const double share = volume / (4.0 / 3.0 * std::numbers::pi * bead.radius * bead.radius * bead.radius);
    const double resistance = std::max(growth, 0.0) + share * drag(full, length(slip));
    out.force = displaced * (turn + Vec<double>{0.0, gravity_, 0.0}) + added * turn + resistance * slip;
    out.added_mass = added;
    out.power = -dot(out.force, v) - 0.5 * growth * dot(v, v);
  }

 private:
  /// Drag over slip of a submerged bead of this diameter, N s/m.
  double drag(double diameter, double speed) const {
    const double single = drag_rate(fluid_, diameter, porosity_ * speed);
    if (porosity_ == 1.0) return single;
    const double reynolds = fluid_.density * porosity_ * speed * diameter / std::max(fluid_.viscosity, 1e-300);
    const double decades = 1.5 - std::log10(reynolds);
    return single * std::pow(porosity_, 0.65 * std::exp(-0.5 * decades * decades) - 3.7);
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
