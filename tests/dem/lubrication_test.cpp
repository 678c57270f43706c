// Impacts through a viscous film: restitution against the Stokes number.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "dem/support.hpp"

using namespace dem_test;

TEST_CASE("restitution through a film falls as the Stokes number does, and below a critical one nothing comes back") {
  const double viscosity = 0.02, cut = 1e-3, range = 0.25, dry = 0.9, range_gap = range * 0.5 * kRadius;
  const double logarithm = std::log(range / cut), front = 6 * std::numbers::pi * viscosity * 0.25 * kRadius * kRadius;
  Setup s;
  s.pairs = fmt::format("restitution: {}, static_friction: 0", dry);
  s.interactions = fmt::format("{{film: {{kind: lubrication, viscosity: {}, cut: {}, range: {}}}}}", viscosity, cut, range);
  double last_restitution = 1;
  for (const double stokes : {1000.0, 200.0, 50.0, 20.0, 4.0}) {
    const double speed = stokes * front / (0.5 * bead_mass());
    Assembly a = assembled(s);
    Bead p, q;
    p.position = {2 * kRadius + 1.2 * range_gap, 0, 0};
    p.velocity = {-0.5 * speed, 0, 0};
    q.velocity = {0.5 * speed, 0, 0};
    start(a, {p, q});
    const Energy first = observed(a);
    double gap = range_gap, parting = -speed;
    for (int k = 0; k < 400000 && !(parting > 0 && gap > 1.1 * range_gap) && !(std::fabs(parting) < 1e-3 * speed); ++k) {
      advance(a, 1);
      gap = position(a, 0)[0] - position(a, 1)[0] - 2 * kRadius;
      parting = velocity(a, 0)[0] - velocity(a, 1)[0];
    }
    const Energy last = observed(a);
    const double restitution = parting / speed, expected = std::max(dry - (1 + dry) * logarithm / stokes, 0.0);
    INFO("St " << stokes << ", " << speed << " m/s: e " << restitution << " against " << expected);
    CHECK(restitution == Approx(expected).margin(0.01));
    CHECK(restitution < last_restitution);
    CHECK(last.dissipated == Approx(first.kinetic - last.stored()).epsilon(0.01));
    last_restitution = restitution + 1e-3;
  }
}
