// Drag of a gas on single beads (Schiller & Naumann 1933).
//
// symbol   here        meaning
// u        slip        fluid velocity − bead velocity, m/s
// ρ, η     fluid_      its density and viscosity, kg/m³, Pa s
// Re       –           ρ |u| d/η
// C_d      –           24/Re (1 + 0.15 Re^0.687) for Re < 800, at least 0.44 above (Newton's regime)
//
//   F = s · 3 π η d (1 + 0.15 Re^0.687) u,  s = strength (1: as it is, 0: none)
//
// The fluid is at rest or turns with the mill as a rigid body at Ω about z. Neighbours, walls and the bead's spin do not change the drag.
// Power taken from the bead is −F·v, negative where a turning fluid drives it.
#include "drag.hpp"
#include "millscope/body_force_adapter.hpp"

namespace millscope::body_forces {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("fluid_density", "kg/m^3", 1.204, 0.0, 100.0, "Density of the gas; air at 20 C and 1 atm: 1.204."),
    number_parameter("viscosity", "Pa s", 1.82e-5, 0.0, 1.0, "Dynamic viscosity; air at 20 C: 1.82e-5."),
    choice_parameter("flow", "at_rest|turning", "at_rest", "Velocity of the fluid: none, or rigid rotation about the mill axis."),
    number_parameter("angular_velocity", "rad/s", 0.0, -1000.0, 1000.0,
                     "Of the turning fluid about z, counter-clockwise; needed where flow is turning."),
    number_parameter("strength", "1", 1.0, 0.0, 100.0, "Factor on the drag; 0 switches it off."),
};

constexpr Hypothesis kHypotheses[] = {
    {"air_drag", "The air slows the beads in flight.", "F = 3 pi eta d (1 + 0.15 Re^0.687) u", "Schiller & Naumann 1933", "strength", 0.0,
     0.0, 3.0},
};

class AirDrag {
 public:
  explicit AirDrag(const Parameters& values)
      : fluid_{values.number("fluid_density"), values.number("viscosity")},
        strength_(values.number("strength")),
        turning_(values.text("flow") == "turning" ? values.number("angular_velocity") : 0.0) {
    if (values.text("flow") == "at_rest" && values.number("angular_velocity") != 0.0) {
      throw Refusal("air_drag: angular_velocity is given but flow is at_rest; write flow: turning or leave it out");
    }
    if (values.text("flow") == "turning" && values.number("angular_velocity") == 0.0) {
      throw Refusal("air_drag: flow is turning but angular_velocity is 0; give that of the mill in rad/s, or write flow: at_rest");
    }
  }

  template <class R>
  void act(const BeadState<R>& bead, BeadResponse<R>& out) const {
    const Vec<R> fluid{R(-turning_) * bead.position.y, R(turning_) * bead.position.x, R(0.0)};
    const Vec<R> slip = fluid - bead.velocity;
    out.force = (R(strength_) * drag_rate(fluid_, R(2.0) * bead.radius, length(slip))) * slip;
    out.power = -dot(out.force, bead.velocity);
  }

 private:
  Fluid fluid_;
  double strength_, turning_;
};

constexpr Descriptor kDescriptor = describe<AirDrag>({
    .name = "air_drag",
    .version = "1.0",
    .doc = "Drag of a gas on each bead alone; Schiller-Naumann, valid for Re < 800, drag coefficient at least 0.44 above.",
    .equation = "F = 3 pi eta d (1 + 0.15 Re^0.687) u",
    .citation = "Schiller & Naumann 1933",
    .parameters = kParameters,
    .hypotheses = kHypotheses,
});

}  // namespace
}  // namespace millscope::body_forces

MILLSCOPE_PLUGINS(&millscope::body_forces::kDescriptor)
