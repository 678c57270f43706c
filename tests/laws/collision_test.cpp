// Central collisions: restitution, contact time, momentum, order of convergence.
#include <catch2/catch.hpp>

#include "laws/two_bodies.hpp"

using namespace laws_test;

namespace {

std::string linear(double restitution) {
  return "restitution=" + std::to_string(restitution) + " static_friction=0.3 normal_stiffness=20000";
}
std::string hertz(double restitution) { return "restitution=" + std::to_string(restitution) + " static_friction=0.3"; }

double rebound(const Law& law, double speed, double dt) {
  Collision c = head_on(law, speed);
  c.run(dt);
  return (c.i().half_velocity[0] - c.j().half_velocity[0]) / speed;
}

}  // namespace

TEST_CASE("with tension allowed a collision gives back the nominal restitution") {
  for (const double e : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0}) {
    for (const double speed : {0.1, 1.0, 5.0}) {
      INFO("e = " << e << ", v = " << speed);
      CHECK(rebound(make_law("hertz_mindlin", hertz(e)), speed, 2e-7) == Approx(e).epsilon(0.005));
      CHECK(rebound(make_law("linear_spring_dashpot", linear(e)), speed, 2e-7) == Approx(e).epsilon(0.005));
    }
  }
}

TEST_CASE("without tension the bodies keep more of their speed, and never pull") {
  for (const char* name : {"hertz_mindlin", "linear_spring_dashpot"}) {
    const std::string text = name[0] == 'h' ? hertz(0.5) : linear(0.5);
    const Law law = make_law(name, text + " allow_tension=0");
    Collision c = head_on(law, 1.0);
    const Outcome out = c.run(2e-7);
    INFO(name);
    CHECK(out.lowest_force == 0.0);
    // Schwager & Pöschel 2007, for a linear spring; Hertz's with damping ∝ √S_n moves along the same curve.
    const double share = -std::log(0.5) / std::hypot(std::log(0.5), std::acos(-1.0)), rest = std::sqrt(1 - share * share);
    const double turned = std::acos(-1.0) - std::atan(2 * share * rest / (1 - 2 * share * share));
    CHECK(c.i().half_velocity[0] - c.j().half_velocity[0] == Approx(std::exp(-share / rest * turned)).epsilon(5e-4));  // 0.5503
  }
}

TEST_CASE("while damping pulls parting beads friction does nothing, or as much as mu |F_n| where it is told to") {
  for (const char* name : {"hertz_mindlin", "hertz_mindlin_deresiewicz"}) {
    for (const bool told : {false, true}) {
      const Law law = make_law(name, std::string("restitution=0.5 static_friction=0.3 friction_in_tension=") + (told ? "1" : "0"));
      Contacts c(1);
      c.own_friction = true;
      c.radius[0] = 2.5e-3, c.mass[0] = bead_pair().largest_mass, c.overlap[0] = 1e-7;
      Contacts::put(c.normal, 0, {1, 0, 0});
      Contacts::put(c.velocity, 0, {0.5, 1, 0});  // parting fast, sliding faster
      for (int k = 0; k < 1000; ++k) c.step(law, 1e-6);
      INFO(name << ", " << told);
      REQUIRE(c.normal_force[0] < 0);
      CHECK(-c.force[1][0] == Approx(told ? -0.3 * c.normal_force[0] : 0.0).margin(1e-12));
    }
  }
}

TEST_CASE("a JKR collision without adhesion is a Hertz collision") {
  CHECK(rebound(make_law("jkr", hertz(0.7) + " surface_energy=0"), 1.0, 2e-7) == Approx(0.7).epsilon(0.005));
}

TEST_CASE("the time of contact is that of theory") {
  const double radius = 2.5e-3, mass = 0.5 * bead().mass;
  for (const double speed : {0.1, 1.0}) {
    const Law law = make_law("hertz_mindlin", hertz(1.0));
    const double expected = law.table().contact_time(law.get(), radius, mass, speed);
    CHECK(head_on(law, speed).run(1e-7).contact_time == Approx(expected).epsilon(0.005));
  }
  for (const double e : {0.3, 0.9}) {
    const Law law = make_law("linear_spring_dashpot", "static_friction=0.3 contact_time=2.5e-4 restitution=" + std::to_string(e));
    CHECK(law.table().contact_time(law.get(), radius, mass, 1.0) == Approx(2.5e-4).epsilon(1e-9));
  }
  // With tension the dashpot pulls until the overlap is gone: t_c = √(m* (π² + ln² e)/k_n) ends where the overlap does.
  const Law law = make_law("linear_spring_dashpot", "static_friction=0.3 contact_time=2.5e-4 restitution=0.5");
  CHECK(head_on(law, 1.0).run(1e-7).contact_time == Approx(2.5e-4).epsilon(0.005));
}

TEST_CASE("the largest overlap that a linear law was derived from is reached") {
  const Law law = make_law("linear_spring_dashpot", "restitution=1 static_friction=0.3 largest_overlap=0.05");
  CHECK(head_on(law, 1.0).run(1e-7).largest_overlap == Approx(0.05 * 2.5e-3).epsilon(0.005));
}

TEST_CASE("momentum and angular momentum of two beads are kept") {
  for (const Case& c : kCases) {
    const Law law = make_law(c.law, c.values);
    Body a = bead(5e-3), b = bead(3e-3, 7800.0);
    a.position = {7.9e-3, 1.5e-3, 0.0};
    a.velocity = {-1.0, 0.3, 0.2};
    a.spin = {30.0, -20.0, 50.0};
    Collision collision(law, a, b);
    const auto momentum = [&](const Body& p) { return plus({}, p.mass, p.half_velocity); };
    const Vector before = plus(momentum(collision.i()), 1.0, momentum(collision.j()));
    collision.run(1e-6);
    const Vector after = plus(momentum(collision.i()), 1.0, momentum(collision.j()));
    INFO(c.law << " " << c.values);
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(std::fabs(after[axis] - before[axis]) < 1e-12 * bead().mass * 1.0);
  }
}

TEST_CASE("the rebound converges with an order of 1.5 and more: force and touch begin and end within a step") {
  for (const char* name : {"hertz_mindlin", "linear_spring_dashpot"}) {
    const Law law = make_law(name, name[0] == 'h' ? hertz(0.8) : linear(0.8));
    // Root mean square over where the first touch falls within a step: the mean itself nearly vanishes.
    const auto error = [&](double dt) {
      double sum = 0;
      for (int k = 0; k < 16; ++k) {
        Collision c = head_on(law, 1.0, 0.0, dt * 1e5 * (k + 0.5) / 16);
        c.run(dt);
        const double off = c.i().half_velocity[0] - c.j().half_velocity[0] - 0.8;
        sum += off * off / 16;
      }
      return std::sqrt(sum);
    };
    const double coarse = error(2e-5), fine = error(5e-6);
    INFO(name << ": " << coarse << " " << fine);
    CHECK(coarse < 0.007);
    CHECK(std::log(coarse / fine) / std::log(4.0) > 1.5);
  }
}
