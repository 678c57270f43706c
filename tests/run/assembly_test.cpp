// From a case to a system: time step and its limits, domain, pairs.
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"
#include "kernel/host/registry.hpp"

using namespace dem_test;

TEST_CASE("the time step is a fraction of the Rayleigh time of the smallest and softest bead") {
  const double shear = 26e6, time = std::numbers::pi * 2.5e-3 * std::sqrt(2500 / shear) / (0.1631 * 0.23 + 0.8766);
  CHECK(run::rayleigh_time(2.5e-3, 2500, 2 * 1.23 * shear, 0.23) == Approx(time));
  Setup s;
  Assembly a = assembled(s);
  CHECK(a.rayleigh_time == Approx(run::rayleigh_time(2.5e-3, 2500, 63.96e6, 0.23)));
  CHECK(a.time_step == Approx(0.2 * a.rayleigh_time));
  s.beads = "{all: {material: glass, sizes: [{diameter: 5 mm, fraction: 50 %}, {diameter: 1 mm, fraction: 50 %}]}}";
  CHECK(assembled(s).rayleigh_time == Approx(0.2 * a.rayleigh_time));
  s.time = "{end_s: 1, step_s: 1e-6}";
  CHECK(assembled(s).time_step == 1e-6);
}

TEST_CASE("an unstable step is refused at its line, a step that hardly resolves a contact too") {
  Setup s;
  s.time = "{end_s: 1, step_fraction: 0.7}";
  CHECK_THROWS_WITH(assembled(s), Catch::Contains("test.yaml:") && Catch::Contains("70 %") && Catch::Contains("60 %"));
  s.run = "{allow_unstable: true}";
  CHECK_NOTHROW(assembled(s));
  s.run = "{}";
  s.time = "{end_s: 1, step_fraction: 0.2}";
  s.law = "{kind: linear_spring_dashpot}";
  s.pairs = "restitution: 0.8, static_friction: 0.3, contact_time: 1e-4 s";
  CHECK_THROWS_WITH(assembled(s), Catch::Contains("fewer than 10 steps"));
}

TEST_CASE("whether a law takes its stiffness from Young's modulus is seen from its contact time") {
  Setup s;
  CHECK(assembled(s).stiffness_from_young);
  s.law = "{kind: linear_spring_dashpot}";
  s.time = "{end_s: 1, step_s: 1e-6}";
  for (const std::string own : {"contact_time: 1e-4 s", "normal_stiffness: 1e4 N/m", "largest_overlap: 0.01"}) {
    INFO(own);
    s.pairs = "restitution: 0.8, static_friction: 0.3, " + own;
    CHECK_FALSE(assembled(s).stiffness_from_young);
  }
}

TEST_CASE("a law that gives no contact time is checked against that of Hertz") {
  host::RegistryOptions options;
  options.directories = {std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins", TEMPLATE_LAW};
  options.own = false;
  const host::Registry registry(options);
  Setup s;
  const double hertz = assembled(s).hertz_contact_time;
  s.law = "{kind: template_law}";
  s.pairs = "static_friction: 0.3, damping: 0.2, tangential_stiffness: 1e4";
  const auto of_template = [&] { return run::assemble(config::parse_case(s.text(), "test.yaml"), registry, {1, ""}); };
  CHECK(of_template().hertz_contact_time == Approx(hertz));
  s.time = "{end_s: 1, step_fraction: 0.5}";
  CHECK_THROWS_WITH(of_template(), Catch::Contains("test.yaml:") && Catch::Contains("fewer than 10 steps"));
}

TEST_CASE("every pair that can meet has its own law, walls among themselves none") {
  Setup s;
  s.beads = "{light: {material: glass, diameter: 5 mm, share: 50 %}, dense: {material: heavy, diameter: 3 mm, share: 50 %}}";
  s.geometry = kFloor;
  const Assembly a = assembled(s);
  std::vector<std::string> names;
  for (const dem::PairPhysics& p : a.system->physics()) names.push_back(p.name);
  CHECK(names == std::vector<std::string>{"glass~glass", "glass~heavy", "glass~wall (wall)", "heavy~heavy", "heavy~wall (wall)"});
}

TEST_CASE("the domain holds what the walls may sweep") {
  Setup s;
  s.domain = "{}";
  s.geometry = "{box: {kind: box, low: [10 mm, 0, 0], high: [40 mm, 20 mm, 30 mm], material: wall}}";
  {
    const dem::Settings d = assembled(s).system->settings();
    CHECK(d.low[0] == Approx(5e-3));
    CHECK(d.high[1] == Approx(25e-3));
  }
  s.geometry =
      "{box: {kind: box, low: [10 mm, 0, 0], high: [40 mm, 20 mm, 30 mm], material: wall, "
      "motion: {translation: {velocity: [0, 0, 0.001], oscillation: {amplitude: [0, 30 mm, 0], frequency: 5 Hz}}}}}";
  {
    const dem::Settings d = assembled(s).system->settings();  // 100 s
    CHECK(d.low[1] <= -30e-3);
    CHECK(d.high[1] >= 50e-3);
    CHECK(d.high[2] >= 130e-3);
  }
  s.geometry = "{box: {kind: box, low: [10 mm, 0, 0], high: [40 mm, 20 mm, 30 mm], material: wall, motion: {rotation: {speed: 1 rad/s}}}}";
  {
    const dem::Settings d = assembled(s).system->settings();
    const double far = std::hypot(40e-3, 20e-3);
    CHECK(d.low[0] <= -far);
    CHECK(d.high[1] >= far);
    CHECK(d.low[2] >= -6e-3);
  }
  // A plane has no end: the square that pictures show bounds nothing.
  s.geometry = kFloor;
  CHECK(assembled(s).system->settings().high[1] > 10);
}
