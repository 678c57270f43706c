// Prescribed motion: the pose is the integral of the velocity field.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"
#include "kernel/dem/motion.hpp"

using namespace dem_test;
using dem::Motion;
using dem::Pose;

namespace {

Vector at(const Pose& p, const Vector& x) {
  Vector r = p.offset;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) r[i] += p.rotation[i][j] * x[j];
  }
  return r;
}

Vector velocity_of(const Pose& p, const Vector& x) { return plus(p.velocity, 1, cross(p.omega, minus(x, p.centre))); }

Motion full_motion() {
  Motion m;
  m.speed = -7;
  m.axis = {2.0 / 7, 3.0 / 7, 6.0 / 7};
  m.point = {0.1, -0.05, 0.2};
  m.start = 0.2;
  m.ramp = 0.5;
  m.ripple_amplitude = 0.3;
  m.ripple_frequency = 4;
  m.ripple_phase = 0.7;
  m.velocity = {0.1, 0, -0.3};
  m.oscillation_amplitude = {0.01, 0.02, 0};
  m.oscillation_frequency = 5;
  m.oscillation_phase = 1.1;
  m.translation_start = 0.4;
  return m;
}

}  // namespace

TEST_CASE("the velocity field is the derivative of the pose") {
  const Motion m = full_motion();
  const Vector body{0.3, -0.2, 0.5};
  const double h = 1e-5;
  for (const double t : {-1.0, 0.1, 0.3, 0.55, 0.69, 0.75, 1.3, 4.2}) {
    INFO("t = " << t);
    const Vector x = at(dem::pose_at(m, t), body);
    const Vector derivative = plus({}, 0.5 / h, minus(at(dem::pose_at(m, t + h), body), at(dem::pose_at(m, t - h), body)));
    const Vector expected = velocity_of(dem::pose_at(m, t), x);
    CHECK(length(minus(derivative, expected)) < 1e-6);
    if (t < 0.2) CHECK(length(expected) == 0.0);
  }
}

TEST_CASE("the angle is the integral of the angular speed through start, ramp and ripple") {
  const Motion m = full_motion();
  double angle = 0;
  const double dt = 1e-5;
  int next = 0;
  for (std::int64_t k = 0; k < 300000; ++k) {
    angle += dt * dem::angular_speed(m, (static_cast<double>(k) + 0.5) * dt);
    const double t = static_cast<double>(k + 1) * dt;
    if (++next % 30000 == 0) CHECK(dem::pose_at(m, t).angle == Approx(angle).margin(1e-6));
  }
  CHECK(dem::angular_speed(m, 0.2) == 0.0);
  CHECK(dem::angular_speed(m, 0.45) == Approx(-3.5));
}

TEST_CASE("a pose is a rotation about its centre") {
  const Motion m = full_motion();
  const Pose p = dem::pose_at(m, 1.9);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double dot = 0;
      for (int k = 0; k < 3; ++k) dot += p.rotation[i][k] * p.rotation[j][k];
      CHECK(dot == Approx(i == j ? 1 : 0).margin(1e-14));
    }
  }
  const Vector shift = minus(p.centre, m.point);
  CHECK(length(minus(at(p, m.point), plus(m.point, 1, shift))) < 1e-15);
  Motion turn;
  turn.speed = std::numbers::pi / 2;
  const Vector quarter = at(dem::pose_at(turn, 1.0), {1, 0, 0});  // counter-clockwise about z
  CHECK(quarter[0] == Approx(0).margin(1e-15));
  CHECK(quarter[1] == Approx(1));
}

TEST_CASE("a turning floor drives a sphere, a sinking one leaves it behind, a rising one carries it") {
  Setup s;
  s.pairs = "restitution: 0.5, static_friction: 0.5";
  s.body_forces = kWithGravity;
  std::string floor = "kind: plane, point: [0, 0, 0], normal: [0, 1, 0]";
  const auto after = [&s, &floor](const char* motion, double time) {
    s.geometry = "{floor: {" + floor + ", material: wall, motion: " + motion + "}}";
    Assembly a = assembled(s);
    Bead b;
    b.position = {0.05, 0.9999 * kRadius, 0};
    start(a, {b});
    advance(a, std::llround(time / a.time_step));
    return a;
  };
  {
    // A conveyor that starts at once: it drags the sphere with μ g until the sphere rolls on it at 2/7 of the belt's speed.
    const Assembly a = after("{translation: {velocity: [0.7, 0, 0]}}", 0.3);
    CHECK(velocity(a, 0)[0] == Approx(0.2).epsilon(0.01));
    CHECK(velocity(a, 0)[0] + kRadius * spin(a, 0)[2] == Approx(0.7).epsilon(0.01));
  }
  {
    const Assembly a = after("{translation: {velocity: [0, 0.5, 0]}}", 0.3);
    CHECK(velocity(a, 0)[1] == Approx(0.5).epsilon(1e-4));
    CHECK(position(a, 0)[1] == Approx(0.15 + kRadius).epsilon(1e-4));
    // The floor keeps its speed: its work is that times the momentum that it gives, m (v + g t).
    CHECK(a.system->ledger().bodies[0].work == Approx(bead_mass() * 0.5 * (0.5 + kGravity * 0.3)).epsilon(1e-3));
  }
  {
    s.law = "{kind: hertz_mindlin, allow_tension: false}";  // else the dashpot pulls
    const Assembly a = after("{translation: {velocity: [0, -5, 0]}}", 0.05);
    CHECK(position(a, 0)[1] == Approx(kRadius - 0.5 * kGravity * 0.0025).epsilon(0.01));
  }
  {
    // A floor with an end may turn about any axis: like a paddle it sweeps up beads far from it.
    floor = "kind: box, low: [-0.2, 0, -0.2], high: [0.2, 0.4, 0.2]";
    const Assembly a = after("{rotation: {speed: 1 rad/s, axis: [0, 0, 1], point: [0, 0, 0]}}", 0.5);
    const double angle = 0.5, height = -std::sin(angle) * position(a, 0)[0] + std::cos(angle) * position(a, 0)[1];
    CHECK(height == Approx(kRadius).epsilon(0.01));
  }
}
