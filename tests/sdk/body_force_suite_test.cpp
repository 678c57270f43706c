// The suite of body forces finds what is wrong with one.
#include "millscope/conformance/body_force.hpp"

#include "millscope/body_force_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault { none, not_finite, half_power, forgets_turning, forgets_fluid, remembers, uniform, at_the_end, mute };

constexpr Parameter kParameters[] = {number_parameter("viscosity", "Pa s", 0.01, 0.0, 10.0, "Of the fluid.")};

/// Drag, a braking moment and a layer of fluid that grows with the height, wrong in one thing.
template <Fault fault>
struct Drag {
  explicit Drag(const Parameters& values) : viscosity_(values.number("viscosity")) {
    if (fault == Fault::mute && viscosity_ == 0.0) throw Refusal("");
    if (fault == Fault::at_the_end) viscosity_ = 1.0 / viscosity_;
  }

  bool uniform(double, double (&acceleration)[3]) const {
    acceleration[1] = -9.81;
    return fault == Fault::uniform;
  }

  void act(const Bead& bead, BeadForce& out) const {
    const double rate = 18.8 * viscosity_ * bead.radius;
    if (fault == Fault::remembers) calls_ += 1;
    out.force = -rate * (1.0 + 1e-3 * calls_) * bead.velocity;
    out.moment = -1e-4 * rate * bead.spin;
    out.added_mass = 0.1 * bead.mass * (1.0 + bead.position.y);
    out.power = -dot(out.force, bead.velocity);
    if (fault == Fault::half_power) out.power *= 0.5;
    if (fault != Fault::forgets_turning) out.power -= dot(out.moment, bead.spin);
    if (fault != Fault::forgets_fluid) out.power -= 0.05 * bead.mass * bead.velocity.y * dot(bead.velocity, bead.velocity);
    if (fault == Fault::not_finite) out.moment.x /= dot(bead.velocity, bead.velocity);
  }

  double viscosity_;
  mutable int calls_ = 0;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Drag<fault>>({.name = "drag", .parameters = kParameters});
  const ValueSet values(descriptor);
  return check_body_force(descriptor, values.view());
}

/// The same by hand: overwrites what was there.
Violations violations_of_overwriting() {
  static constexpr BodyForceTable table = [] {
    BodyForceTable t = make_body_force_table<Drag<Fault::none>>();
    t.evaluate = [](const void*, BodyForceBatch* b) {
      for (std::int64_t i = 0; i < b->count; ++i) b->force[0][i] = 0.0;
      b->power_sum = 0.0;
    };
    return t;
  }();
  static constexpr Descriptor descriptor = [] {
    Descriptor d = describe<Drag<Fault::none>>({.name = "drag", .parameters = kParameters});
    d.table = &table;
    return d;
  }();
  const ValueSet values(descriptor);
  return check_body_force(descriptor, values.view());
}

}  // namespace

TEST_CASE("a right body force passes the suite") {
  CHECK_FALSE(names(violations_of<Fault::none>(), ""));
  CHECK(violations_of<Fault::none>().empty());
}

TEST_CASE("the suite finds what is wrong with a body force") {
  CHECK(names(violations_of<Fault::not_finite>(), "finite"));
  CHECK(names(violations_of<Fault::at_the_end>(), "finite"));
  CHECK(names(violations_of<Fault::half_power>(), "power"));
  CHECK(names(violations_of<Fault::forgets_turning>(), "power"));
  CHECK(names(violations_of<Fault::forgets_fluid>(), "power"));
  CHECK(names(violations_of<Fault::remembers>(), "determinism"));
  CHECK(names(violations_of<Fault::uniform>(), "uniform"));
  CHECK(names(violations_of<Fault::mute>(), "refusal"));
  CHECK(names(violations_of_overwriting(), "adds"));
}
