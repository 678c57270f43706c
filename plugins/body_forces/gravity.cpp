// Gravity: the same acceleration for every bead, g d/|d| turned by α about the mill axis z.
#include "millscope/body_force_adapter.hpp"

namespace millscope::body_forces {
namespace {

constexpr Parameter kParameters[] = {
    number_parameter("magnitude", "m/s^2", 9.81, 0.0, 1000.0, "Acceleration g."),
    optional(vector_parameter("direction", "1", kRequired, "Where gravity points, of any length; without it -y (0, -1, 0).")),
    number_parameter("angle", "rad", 0.0, -kUnbounded, kUnbounded, "Turns the direction about z, counter-clockwise."),
};

class Gravity {
 public:
  explicit Gravity(const Parameters& values) {
    const double down[3] = {0.0, -1.0, 0.0};
    const double* d = values.given("direction") ? values.vector("direction") : down;
    const double size = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (!(size > 0.0) || !std::isfinite(size)) throw Refusal("gravity: direction has no length; give a vector such as [0, -1, 0]");
    const double scale = values.number("magnitude") / size;
    const double angle = values.number("angle"), cosine = std::cos(angle), sine = std::sin(angle);
    acceleration_[0] = scale * (cosine * d[0] - sine * d[1]);
    acceleration_[1] = scale * (sine * d[0] + cosine * d[1]);
    acceleration_[2] = scale * d[2];
  }

  bool uniform(double, double (&acceleration)[3]) const {
    for (int a = 0; a < 3; ++a) acceleration[a] = acceleration_[a];
    return true;
  }
  /// For a host that asks bead by bead.
  void act(const Bead& bead, BeadForce& out) const {
    out.force = bead.mass * Vec<double>{acceleration_[0], acceleration_[1], acceleration_[2]};
  }

 private:
  double acceleration_[3];
};

constexpr Descriptor kDescriptor = describe<Gravity>({
    .name = "gravity",
    .version = "1.0",
    .doc = "The same acceleration for every bead, in any direction.",
    .equation = "F = m g",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::body_forces

MILLSCOPE_PLUGINS(&millscope::body_forces::kDescriptor)
