// Filling: nothing overlaps, the numbers are those asked for, the seed decides the rest.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <numbers>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"

using namespace dem_test;

namespace {

constexpr double kLength = 20e-3;

/// A drum of 100 mm with eight lifters, 20 mm periodic.
Setup drum(const std::string& fill) {
  Setup s;
  s.fill = fill;
  s.body_forces = kWithGravity;
  s.geometry =
      "{drum: {kind: mill, diameter: 100 mm, length: 20 mm, lifters: 8, lifter_height: 8 mm, lifter_width: 20 mm, material: wall}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  return s;
}

Assembly filled(const Setup& s) {
  Assembly a = assembled(s);
  run::insert_beads(a);
  return a;
}

/// Least gap between two beads, m, over periodic images.
double least_gap(const Assembly& a) {
  const auto& p = a.system->particles.position;
  const auto& length = a.system->settings().periodic.length;
  double least = 1e9;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      const double *x = p[i].centre, *y = p[j].centre;
      double d[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]}, square = 0;
      for (int k = 0; k < 3; ++k) {
        if (length[k] > 0) d[k] -= length[k] * std::round(d[k] / length[k]);
        square += d[k] * d[k];
      }
      least = std::min(least, std::sqrt(square) - p[i].radius - p[j].radius);
    }
  }
  return least;
}

/// Contacts of any kind in the first step.
std::int64_t first_contacts(Assembly& a) {
  run::begin(a);
  a.system->advance();
  std::int64_t n = 0;
  for (const dem::PairLedger& p : a.system->ledger().pairs) n += p.contacts;
  return n;
}

std::map<double, int> count_by_diameter(const Assembly& a) {
  std::map<double, int> n;
  for (const auto& x : a.system->particles.position) ++n[std::round(2e6 * x.radius) * 1e-6];
  return n;
}

}  // namespace

TEST_CASE("count, mass and filling give the numbers asked for") {
  const double vessel = std::numbers::pi / 4 * 0.1 * 0.1 * kLength, bead = std::numbers::pi / 6 * 5e-3 * 5e-3 * 5e-3;
  struct {
    std::string fill;
    double count;
  } const cases[] = {{"{count: 321}", 321},
                     {"{mass: 50 g}", std::round(0.05 / (bead * kDensity))},
                     {"{filling: 30 %}", std::round(0.3 * vessel * (1 - 0.37) / bead)},
                     {"{filling: 30 %, porosity: 0.5}", std::round(0.3 * vessel * 0.5 / bead)},
                     {"{filling: 30 %, vessel: {diameter: 80 mm, length: 20 mm}}", std::round(0.3 * vessel * 0.64 * (1 - 0.37) / bead)}};
  for (const auto& c : cases) {
    INFO(c.fill);
    const Assembly a = filled(drum(c.fill));
    CHECK(static_cast<double>(a.bead_count) == c.count);
    CHECK(a.system->particles.count() == static_cast<std::int64_t>(a.bead_count));
  }
}

TEST_CASE("no bead overlaps another, a wall or the inside of a lifter") {
  const std::string box = "{box: {kind: box, low: [0, 0, 0], high: [40 mm, 50 mm, 30 mm], material: wall}}";
  struct {
    const char* name;
    Setup setup;
  } cases[] = {{"periodic drum", drum("{filling: 45 %}")},
               {"closed drum", drum("{count: 350}")},
               {"box", drum("{count: 250}")},
               {"box, gravity along z", drum("{count: 250}")},
               {"periodic along all axes", drum("{count: 300}")}};
  cases[1].setup.domain = "{}";
  cases[1].setup.geometry.replace(cases[1].setup.geometry.find("material"), 0, "end_faces: true, ");
  for (int k : {2, 3}) {
    cases[k].setup.geometry = box;
    cases[k].setup.domain = "{}";
  }
  cases[3].setup.body_forces = "{gravity: {kind: gravity, direction: [0, 0, 1]}}";
  cases[4].setup.geometry = "{}";
  cases[4].setup.domain = "{periodic: {x: [0, 47 mm], y: [-20 mm, 28 mm], z: [0, 33 mm]}}";
  for (auto& c : cases) {
    INFO(c.name);
    Assembly a = filled(c.setup);
    CHECK(least_gap(a) > 0);
    CHECK(first_contacts(a) == 0);
    if (c.setup.geometry.find("mill") == std::string::npos) continue;
    // Inside the free cross-section: within the shell, and above the tops of the lifters (42 mm from the axis) only between them.
    for (const auto& x : a.system->particles.position) {
      const double r = std::hypot(x.centre[0], x.centre[1]), turn = std::numbers::pi / 4;
      const double phi = std::remainder(std::atan2(x.centre[1], x.centre[0]), turn);
      CHECK(r <= 0.05 - x.radius);
      if (r > 0.042) CHECK(std::abs(r * std::sin(phi)) > 5e-3);  // a lifter is 10.8 mm wide at its top, more below
    }
  }
}

TEST_CASE("beads fill from below, against gravity") {
  for (const char* direction : {"[0, -1, 0]", "[1, 0, 0]"}) {
    Setup s = drum("{count: 200}");
    s.body_forces = std::string("{gravity: {kind: gravity, direction: ") + direction + "}}";
    const Assembly a = filled(s);
    const Vector c = a.system->centre_of_mass();
    CHECK((direction[1] == '0' ? -c[1] : c[0]) > 0.02);
  }
}

TEST_CASE("size classes appear in the proportions asked for") {
  Setup s = drum("{count: 500}");
  s.beads = "{all: {material: glass, fractions_by: number, sizes: [{diameter: 4 mm, fraction: 70 %}, {diameter: 5 mm, fraction: 30 %}]}}";
  {
    const auto n = count_by_diameter(filled(s));
    CHECK(n.at(4e-3) == 350);
    CHECK(n.at(5e-3) == 150);
  }
  s.beads = "{all: {material: glass, fractions_by: mass, sizes: [{diameter: 4 mm, fraction: 50 %}, {diameter: 5 mm, fraction: 50 %}]}}";
  {
    const auto n = count_by_diameter(filled(s));
    CHECK(n.at(4e-3) + n.at(5e-3) == 500);
    CHECK(static_cast<double>(n.at(4e-3)) / n.at(5e-3) == Approx(125.0 / 64.0).epsilon(0.01));
  }
  s.beads = "{light: {material: glass, diameter: 5 mm, share: 25 %}, dense: {material: heavy, diameter: 4 mm, share: 75 %}}";
  {
    const Assembly a = filled(s);
    double light = 0, all = 0;
    for (std::size_t i = 0; i < 500; ++i) {
      const double m = 1 / a.system->particles.motion[i].inverse_mass;
      all += m;
      if (a.materials[a.system->particles.material[i]] == "glass") light += m;
      const double r = a.system->particles.position[i].radius;
      CHECK(m == Approx(bead_mass(r, r > 2.2e-3 ? 2500 : 7800)));
      CHECK(1 / a.system->particles.motion[i].inverse_inertia == Approx(0.4 * m * r * r));
    }
    CHECK(light / all == Approx(0.25).epsilon(0.01));
  }
  s.beads = "{all: {material: glass, fractions_by: number, distribution: {kind: normal, mean: 4.5 mm, deviation: 0.2 mm}}}";
  {
    double sum = 0, square = 0;
    const Assembly a = filled(s);
    for (const auto& x : a.system->particles.position) {
      sum += 2e3 * x.radius / 500;
      square += 4e6 * x.radius * x.radius / 500;
    }
    CHECK(sum == Approx(4.5).epsilon(0.002));
    CHECK(std::sqrt(square - sum * sum) == Approx(0.2).epsilon(0.08));
  }
}

TEST_CASE("the seed decides: the same seed gives the same beads, another seed other beads of the same sizes") {
  Setup s = drum("{count: 300}");
  s.beads = "{all: {material: glass, sizes: [{diameter: 4 mm, fraction: 50 %}, {diameter: 5 mm, fraction: 50 %}]}}";
  const auto with_seed = [&s](int seed) {
    Assembly a = run::assemble(config::parse_case(s.text() + fmt::format("seed: {}\n", seed), "test.yaml"), registry(), {1, ""});
    run::insert_beads(a);
    a.system->start(0);
    return a;
  };
  const Assembly one = with_seed(1), again = with_seed(1), two = with_seed(2);
  CHECK(one.system->state_hash() == again.system->state_hash());
  CHECK(one.system->state_hash() != two.system->state_hash());
  CHECK(count_by_diameter(one) == count_by_diameter(two));
}

TEST_CASE("beads of many sizes are scattered where the sites of the largest do not suffice") {
  for (const char* beads :
       {"{all: {material: glass, distribution: {kind: normal, mean: 5 mm, deviation: 0.9 mm}}}",
        "{big: {material: glass, diameter: 8 mm, share: 50 %}, small: {material: glass, diameter: 2.5 mm, share: 50 %}}"}) {
    Setup s = drum("{filling: 35 %}");
    s.geometry =
        "{drum: {kind: mill, diameter: 100 mm, length: 40 mm, lifters: 8, lifter_height: 8 mm, lifter_width: 20 mm, material: wall}}";
    s.domain = "{periodic: {z: [0, 40 mm]}}";
    s.beads = beads;
    Assembly a = filled(s), again = filled(s);
    INFO(beads << " " << a.bead_count);
    CHECK(least_gap(a) > 0);
    CHECK(first_contacts(a) == 0);
    again.system->start(0);
    Assembly third = filled(s);
    third.system->start(0);
    CHECK(third.system->state_hash() == again.system->state_hash());
    // The lower part is filled first.
    double highest = -1;
    for (const auto& x : a.system->particles.position) highest = std::max(highest, x.centre[1]);
    CHECK(highest < 0.045);
  }
}

TEST_CASE("few beads in a large vessel take the lowest places of the lattice, whatever its size") {
  const auto lowest = [](const char* low_x) {
    Setup s;
    s.beads = "{fine: {material: glass, diameter: 2 mm}}";
    s.body_forces = kWithGravity;
    s.fill = fmt::format("{{count: 20, region: {{low: [{}, 0, 0], high: [0.2, 0.6, 0.2]}}}}", low_x);
    return filled(s);
  };
  const Assembly a = lowest("0");
  for (const auto& x : a.system->particles.position) CHECK(x.centre[1] < 2e-3);
  CHECK_THROWS_WITH(lowest("-1e5"), Catch::Contains("places for beads") && Catch::Contains("fill.region"));
}

TEST_CASE("what does not fit is refused with both numbers") {
  const auto refusal = [](const Setup& s) -> std::string {
    try {
      filled(s);
    } catch (const base::UserError& e) {
      return e.what();
    }
    return "";
  };
  CHECK_THAT(refusal(drum("{count: 5000}")), Catch::Contains("test.yaml:") && Catch::Contains("5000 beads are asked for but only"));
  CHECK_THAT(refusal(drum("{filling: 99 %}")), Catch::Contains("lower the filling"));
  Setup open = drum("{count: 10}");
  open.geometry = kFloor;
  open.domain = "{}";
  CHECK_THAT(refusal(open), Catch::Contains("fill.region"));
}
