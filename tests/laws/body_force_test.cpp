// Gravity and air drag.
#include <catch2/catch.hpp>

#include "laws/forces.hpp"

using namespace laws_test;

TEST_CASE("gravity points down, where it is told, and turns about z") {
  const Descriptor& d = plugin("gravity");
  CHECK(Force(ValueSet(d)).uniform() == std::array<double, 3>{0.0, -9.81, 0.0});
  ValueSet tilted(d);
  tilted.set("angle", 0.5);
  CHECK(Force(tilted).uniform()[0] == Approx(9.81 * std::sin(0.5)));
  ValueSet aside(d);
  aside.set("direction", 2.0);  // (2, 2, 2)
  CHECK(Force(aside).uniform()[2] == Approx(9.81 / std::sqrt(3.0)));
  ValueSet nowhere(d);
  nowhere.set("direction", 0.0);
  CHECK_THROWS_WITH(Force(nowhere), Catch::Contains("no length"));
}

TEST_CASE("air drag is Stokes's at low speed, Schiller and Naumann's above, Newton's at high") {
  const Descriptor& d = plugin("air_drag");
  const Force drag{ValueSet(d)};
  const double stokes = 6 * 3.14159265358979 * 1.82e-5 * 1e-5 * 1e-4;
  CHECK(drag.on({}, {1e-4, 0, 0}, 1e-5)[0] == Approx(-stokes).epsilon(1e-3));
  const double reynolds = 1.204 * 1.0 * 0.005 / 1.82e-5;
  CHECK(drag.on({}, {0, 1, 0}, 2.5e-3)[1] == Approx(-3 * 3.14159265358979 * 1.82e-5 * 0.005 * (1 + 0.15 * std::pow(reynolds, 0.687))));
  const double newton = 0.44 * 0.5 * 1.204 * 100 * 3.14159265358979 * 25e-6;
  CHECK(drag.on({}, {0, 0, 10}, 5e-3)[2] == Approx(-newton));
  CHECK(drag.on({}, {0, 0, 10}, 5e-3)[3] == Approx(10 * newton));
}

TEST_CASE("a fluid that turns with the mill does not brake a bead that turns with it") {
  const Descriptor& d = plugin("air_drag");
  ValueSet values(d);
  values.set("flow", "turning").set("angular_velocity", -6.0);
  const Force drag(values);
  CHECK(drag.on({0.1, 0.05, 0}, {0.3, -0.6, 0}, 2.5e-3)[0] == Approx(0.0).margin(1e-18));
  CHECK(drag.on({0.1, 0.0, 0}, {0, -0.3, 0}, 2.5e-3)[3] < 0.0);  // driven by the fluid
  values.set("flow", "at_rest");
  CHECK_THROWS_WITH(Force(values), Catch::Contains("flow: turning"));
  values.set("flow", "turning").set("angular_velocity", 0.0);
  CHECK_THROWS_WITH(Force(values), Catch::Contains("flow: at_rest"));
}
