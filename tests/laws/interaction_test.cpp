// Rolling friction, cohesion and parameters that depend on speed.
#include <catch2/catch.hpp>

#include "laws/one_pair.hpp"
#include "laws/two_bodies.hpp"

using namespace laws_test;

TEST_CASE("the constant torque is mu_r L F_n against the rolling, and nothing against the twist") {
  OnePair p;
  p.spin_i[0][0] = 40.0;
  p.spin_i[2][0] = 10.0;
  p.spin_j[2][0] = -5.0;
  p.evaluate("rolling_constant_torque", "rolling_friction=0.02");
  CHECK(p.moment_i[0][0] == 0.0);
  CHECK(p.moment_i[2][0] == Approx(-0.02 * 2.5e-3 * 2.0));
  CHECK(p.moment_j[2][0] == -p.moment_i[2][0]);
  CHECK(p.batch.power_sum[0] == Approx(0.02 * 2.5e-3 * 2.0 * 15.0));
  p.evaluate("rolling_constant_torque", "rolling_friction=0.02 length=radius");
  CHECK(p.moment_i[2][0] == Approx(-0.02 * 5e-3 * 2.0));
  p.evaluate("rolling_constant_torque", "rolling_friction=0.02 spin=absolute");
  CHECK(p.moment_j[2][0] == Approx(0.02 * 2.5e-3 * 2.0));
  CHECK(p.moment_i[0][0] < 0.0);
}

TEST_CASE("near rest the torque does not overshoot") {
  OnePair p;
  p.spin_i[2][0] = 1e-4;
  p.evaluate("rolling_constant_torque", "rolling_friction=0.5");
  const double inertia = 0.4 * 2e-3 * 25e-6;
  CHECK(std::fabs(p.moment_i[2][0]) * 1e-5 / inertia < 0.5 * 1e-4);
  CHECK(p.moment_i[2][0] < 0.0);
}

TEST_CASE("a rolling sphere on a plane stops after the distance of theory") {
  // Deceleration 5/7 μ_r g L/R with L = R for a wall: v² = 2 a s.
  const double mass = bead().mass, radius = 5e-3, rolling = 0.05, weight = mass * 9.81;
  OnePair p;
  p.radius_i[0] = p.radius[0] = radius;
  p.radius_j[0] = 0.0;
  p.mass[0] = mass;
  p.force[0] = weight;
  const double inertia = 1.4 * mass * radius * radius;  // about the point of contact
  double spin = 20.0, distance = 0.0;
  const double start = spin * radius;
  p.batch.time_step = 1e-4;
  for (int step = 0; step < 20000 && spin > 1e-6; ++step) {
    p.spin_i[2][0] = spin;
    p.evaluate("rolling_constant_torque", "rolling_friction=0.05");
    spin += p.moment_i[2][0] / inertia * 1e-4;
    distance += spin * radius * 1e-4;
  }
  CHECK(distance == Approx(start * start / (2 * 5.0 / 7.0 * rolling * 9.81)).epsilon(0.01));
}

TEST_CASE("the elastic-plastic rolling spring is stiff at first and then capped") {
  OnePair p;
  p.spin_i[2][0] = 1.0;
  const double lever = 0.1 * 2.5e-3, stiffness = 2.25 * 1e4 * lever * lever, limit = lever * 2.0;
  p.evaluate("rolling_epsd", "rolling_friction=0.1");
  CHECK(p.moment_i[2][0] == Approx(-stiffness * 0.5e-5));
  double dissipated = 0;
  for (int step = 0; step < 100000; ++step) {
    p.evaluate("rolling_epsd", "rolling_friction=0.1");
    dissipated += p.batch.power_sum[1] * 1e-5;
    if (p.batch.power_sum[1] > 0) break;
  }
  p.evaluate("rolling_epsd", "rolling_friction=0.1");
  CHECK(p.moment_i[2][0] == Approx(-limit));
  CHECK(p.batch.power_sum[1] == Approx(limit * 1.0).epsilon(1e-6));
  p.spin_i[2][0] = -1.0;  // turning back: the spring unloads before it slides the other way
  p.evaluate("rolling_epsd", "rolling_friction=0.1");
  p.evaluate("rolling_epsd", "rolling_friction=0.1");
  CHECK(p.moment_i[2][0] > -limit);
  CHECK(p.batch.power_sum[1] == 0.0);
}

TEST_CASE("a bead of another shape rocks and tips over as its ellipse does") {
  // Height of an ellipse's centre over the plane that carries it, and its slope, in radii of the sphere of the same volume.
  const double alpha = 1.3, a = std::pow(alpha, 2.0 / 3), b = std::pow(alpha, -1.0 / 3), radius = 5e-3, force = 2.0;
  const auto height = [&](double phi) { return std::hypot(b * std::cos(phi), a * std::sin(phi)); };
  OnePair p;
  p.radius_j[0] = 0.0, p.radius[0] = radius;  // a wall
  const double spin = 100.0, step = 1e-5;
  p.spin_i[2][0] = spin;
  p.evaluate("bead_shape", "aspect_ratio=1.3");
  const double turned = 0.5 * spin * step;
  CHECK(p.moment_i[2][0] == Approx(-force * radius * (height(turned) - b) / (0.5 * turned)).epsilon(1e-4));
  // Half a turn at the limit loses one lift of the centre: summed from the ellipse, upwards only.
  double lift = 0;
  const int parts = 10000;
  for (int k = 0; k < parts; ++k) lift += std::max(0.0, height(M_PI * (k + 1) / parts) - height(M_PI * k / parts));
  const auto lost_in = [&](OnePair& q, double turn) {
    double dissipated = 0;
    for (int k = 0; k < 1000; ++k) q.evaluate("bead_shape", "aspect_ratio=1.3");
    for (double done = 0; done < turn; done += spin * step) {
      q.evaluate("bead_shape", "aspect_ratio=1.3");
      dissipated += q.batch.power_sum[1] * step;
    }
    return dissipated;
  };
  CHECK(lost_in(p, M_PI) == Approx(force * radius * lift).epsilon(1e-3));
  CHECK(p.moment_j[2][0] == -p.moment_i[2][0]);
  // Two equal beads that roll on each other turn by half the angle each: every one does as at a wall.
  OnePair two;
  two.spin_i[2][0] = spin / 2, two.spin_j[2][0] = -spin / 2;
  two.evaluate("bead_shape", "aspect_ratio=1.3");
  CHECK(two.moment_i[2][0] == Approx(-force * radius * (height(turned / 2) - b) / (0.25 * turned)).epsilon(1e-4));
  CHECK(lost_in(two, 2 * M_PI) == Approx(2 * force * radius * lift).epsilon(1e-3));
  // Without a load no angle is held.
  two.force[0] = -1;
  two.evaluate("bead_shape", "aspect_ratio=1.3");
  two.force[0] = force;
  two.evaluate("bead_shape", "aspect_ratio=1.3");
  CHECK(two.moment_i[2][0] == Approx(-force * radius * (height(turned) - b) / (0.5 * turned)).epsilon(0.01));
  OnePair sphere;
  sphere.spin_i[2][0] = spin;
  sphere.evaluate("bead_shape", "aspect_ratio=1");
  CHECK(sphere.moment_i[2][0] == 0.0);
}

TEST_CASE("cohesion is the energy density times the area of the circle of contact") {
  OnePair p;
  p.evaluate("cohesion_sjkr", "cohesion_energy_density=20000");
  const double half = 5e-3 - 0.5e-5, area = 3.14159265358979 * (25e-6 - half * half);
  CHECK(p.added_force[0] == Approx(-20000 * area).epsilon(1e-9));
  CHECK(p.added_cap[0] == 0.0);
  OnePair wall;
  wall.radius_j[0] = 0.0;
  wall.evaluate("cohesion_sjkr", "cohesion_energy_density=20000 friction=net");
  const double depth = 5e-3 - 1e-5;
  CHECK(wall.added_force[0] == Approx(-20000 * 3.14159265358979 * (25e-6 - depth * depth)).epsilon(1e-9));
  CHECK(wall.added_cap[0] == wall.added_force[0]);
  // −∂U/∂δ
  for (double* radius_j : {p.radius_j, wall.radius_j}) {
    OnePair low, high;
    low.radius_j[0] = high.radius_j[0] = radius_j[0] == 0.0 ? 0.0 : 3e-3;
    low.overlap[0] = 0.999e-5, high.overlap[0] = 1.001e-5;
    low.evaluate("cohesion_sjkr", "cohesion_energy_density=20000");
    high.evaluate("cohesion_sjkr", "cohesion_energy_density=20000");
    const double slope = (high.batch.elastic_sum - low.batch.elastic_sum) / 2e-8;
    CHECK(slope == Approx(0.5 * (low.added_force[0] + high.added_force[0])).epsilon(1e-6));
  }
}

TEST_CASE("restitution falls with the speed of impact, which is kept while the beads touch") {
  const Descriptor& d = plugin("restitution_by_speed");
  const auto& table = *static_cast<const PairParameterTable*>(d.table);
  for (const char* form : {"viscoelastic", "plastic"}) {
    ValueSet values(d);
    values.set("form", form).set("reference_restitution", 0.8);
    const Held<PairParameterTable> held(table, values.view(), bead_pair());
    OnePair p;
    double restitution[8];
    PairParameterBatch b{};
    b.count = 8;
    b.time_step = 1e-5;
    b.overlap = p.overlap, b.radius = p.radius, b.mass = p.mass, b.restitution = restitution;
    for (int a = 0; a < 3; ++a) b.normal[a] = p.normal[a], b.velocity[a] = p.velocity[a];
    for (int h = 0; h < kMaxHistory; ++h) b.history[h] = p.history[h];
    p.velocity[0][0] = -3.0;
    table.evaluate(held.get(), &b);
    const double expected = form[0] == 'v' ? 1.0 - 0.2 * std::pow(3.0, 0.2) : 0.8 * std::pow(3.0, -0.25);
    CHECK(restitution[0] == Approx(expected));
    p.velocity[0][0] = 0.5;
    table.evaluate(held.get(), &b);
    CHECK(restitution[0] == Approx(expected));
    p.overlap[0] = -1e-6;
    table.evaluate(held.get(), &b);
    p.overlap[0] = 1e-6;
    p.velocity[0][0] = -1.0;
    table.evaluate(held.get(), &b);
    CHECK(restitution[0] == Approx(0.8));
  }
}

TEST_CASE("friction falls with the speed of sliding") {
  const Descriptor& d = plugin("friction_by_speed");
  const auto& table = *static_cast<const PairParameterTable*>(d.table);
  ValueSet values(d);
  values.set("static_friction", 0.5).set("kinetic_ratio", 0.6).set("decay_speed", 0.2);
  const Held<PairParameterTable> held(table, values.view(), bead_pair());
  OnePair p;
  double friction[8];
  PairParameterBatch b{};
  b.count = 8;
  b.time_step = 1e-5;
  b.overlap = p.overlap, b.radius = p.radius, b.mass = p.mass, b.friction = friction;
  for (int a = 0; a < 3; ++a) b.normal[a] = p.normal[a], b.velocity[a] = p.velocity[a];
  p.velocity[0][0] = 7.0;  // along the normal: no sliding
  table.evaluate(held.get(), &b);
  CHECK(friction[0] == Approx(0.5));
  p.velocity[1][0] = 0.2;
  table.evaluate(held.get(), &b);
  CHECK(friction[0] == Approx(0.3 + 0.2 * std::exp(-1.0)));
}
