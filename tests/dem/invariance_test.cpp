// The physics does not depend on where the axes point nor on where a period begins.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>

#include "dem/support.hpp"

using namespace dem_test;

namespace {

/// A quarter turn about z.
Vector turned(const Vector& v) { return {-v[1], v[0], v[2]}; }

std::vector<Bead> pile(double period) {
  std::vector<Bead> beads;
  for (int layer = 0; layer < 4; ++layer) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        Bead b;
        b.position = {kRadius * (1.2 + 2.15 * i + 0.2 * (layer % 2)), kRadius * (1.1 + 2.1 * layer),
                      (0.1 + (k + 0.3 * (layer % 3)) / 3.0) * period};
        b.velocity = {0.3 * (i - 1), -0.5, 0.2 * (k - 1)};
        b.spin = {10.0 * i, 5.0 * k, -20};
        beads.push_back(b);
      }
    }
  }
  return beads;
}

/// Beads fall into a vessel open at the top, 17.5 mm wide and 20 mm deep along z.
Setup vessel(const std::string& box, const std::string& gravity, const std::string& domain) {
  Setup s;
  s.pairs = "restitution: 0.5, static_friction: 0.4, rolling_friction: 0.05";
  s.interactions = "{rolling: {kind: rolling_epsd}}";
  s.geometry = "{vessel: {kind: box, " + box + ", material: wall}}";
  s.body_forces = "{gravity: {kind: gravity, direction: " + gravity + "}}";
  s.domain = domain;
  s.run = "{partitions: 3}";
  return s;
}

constexpr int kSteps = 1500;
constexpr double kPeriod = 20e-3;

}  // namespace

TEST_CASE("a quarter turn of everything about z turns the result") {
  Assembly upright =
      assembled(vessel("low: [0, 0, 0], high: [17.5 mm, 40 mm, 20 mm]", "[0.2, -1, 0]", "{low: [-1, -1, -1], high: [1, 1, 1]}"));
  Assembly lying =
      assembled(vessel("low: [-40 mm, 0, 0], high: [0, 17.5 mm, 20 mm]", "[1, 0.2, 0]", "{low: [-1, -1, -1], high: [1, 1, 1]}"));
  std::vector<Bead> beads = pile(0.8 * kPeriod), other = beads;
  for (Bead& b : other) {
    b.position = turned(b.position);
    b.velocity = turned(b.velocity);
    b.spin = turned(b.spin);
  }
  start(upright, beads);
  start(lying, other);
  advance(upright, kSteps);
  advance(lying, kSteps);
  double worst = 0;
  for (std::uint32_t id = 0; id < beads.size(); ++id) {
    worst = std::max(worst, length(minus(turned(position(upright, id)), position(lying, id))));
    worst = std::max(worst, 1e-2 * kRadius * length(minus(turned(spin(upright, id)), spin(lying, id))));
  }
  CHECK(worst < 1e-6 * kRadius);  // rounding, grown by the collisions
  CHECK(upright.system->ledger().pairs[0].collisions > 20);
  CHECK(upright.system->ledger().pairs[1].collisions > 20);
}

TEST_CASE("where a period begins does not matter, nor in which image a bead starts") {
  const auto domain = [](double from) {
    return fmt::format("{{low: [-1, -1, {0}], high: [1, 1, {1}], periodic: {{z: [{0}, {1}]}}}}", from, from + kPeriod);
  };
  const std::string box = "low: [0, 0, -1], high: [17.5 mm, 40 mm, 1], open: -z +z";
  Assembly a = assembled(vessel(box, "[0.2, -1, 0.1]", domain(0))), b = assembled(vessel(box, "[0.2, -1, 0.1]", domain(-0.0073)));
  const std::vector<Bead> beads = pile(kPeriod);
  std::vector<Bead> images = beads;
  for (std::size_t i = 0; i < images.size(); ++i) images[i].position[2] += kPeriod * (static_cast<double>(i % 5) - 2);
  start(a, beads);
  start(b, images);
  advance(a, kSteps);
  advance(b, kSteps);
  double worst = 0;
  for (std::uint32_t id = 0; id < beads.size(); ++id) {
    Vector d = minus(position(a, id), position(b, id));
    d[2] -= kPeriod * std::round(d[2] / kPeriod);
    worst = std::max(worst, length(d));
  }
  CHECK(worst < 1e-6 * kRadius);  // rounding, grown by the collisions
}

TEST_CASE("a bead slides along a periodic mesh without noticing where the period ends") {
  Setup s;
  s.pairs = "restitution: 0.3, static_friction: 0.01";
  s.geometry = "{liner: {kind: mesh, file: " MILLSCOPE_BINARY_DIR "/tests/liner.stl, unit: m, period: 20 mm, material: wall}}";
  s.body_forces = kWithGravity;
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  Assembly a = assembled(s);
  Bead b;
  // Between two lifters the shell is lowest somewhere near the foot of gravity: let the bead fall in first.
  b.position = {0.0, -0.1425, 0.004};
  start(a, {b});
  advance(a, std::llround(0.6 / a.time_step));
  const std::size_t i = index_of(a, 0);
  for (double& v : a.system->particles.half[i].v) v = 0;
  a.system->particles.half[i].v[2] = a.system->particles.motion[i].v[2] = 1.0;
  const double y = position(a, 0)[1];
  double worst = 0, force_low = 1e9, force_high = 0;
  const std::int64_t fresh = a.system->ledger().pairs[1].collisions;
  for (int k = 0; k < 4000; ++k) {  // more than three periods
    a.system->advance();
    worst = std::max(worst, std::abs(position(a, 0)[1] - y));
    const double force = -a.system->ledger().bodies[0].force[1];
    force_low = std::min(force_low, force);
    force_high = std::max(force_high, force);
  }
  const double weight = bead_mass() * kGravity;
  CHECK(worst < 1e-4 * kRadius);
  CHECK(force_low > 0.98 * weight);
  CHECK(force_high < 1.02 * weight);
  CHECK(a.system->ledger().pairs[1].collisions == fresh);
  CHECK(velocity(a, 0)[2] < 1 - 0.8 * 0.01 * kGravity * 4000 * a.time_step * 5 / 7);
}
