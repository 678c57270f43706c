// Oblique impacts on a wall against rigid-body theory and against Maw, Barber & Fawcett (1976).
#include <catch2/catch.hpp>

#include "laws/oblique.hpp"
#include "laws/row_of_springs.hpp"

using namespace laws_test;

namespace {

constexpr double kPoisson = 0.23, kStiffness = 2 * (1 - kPoisson) / (2 - kPoisson);  // S_t/S_n = 4 G*/E* of like bodies: 0.870

/// ψ₂ of a glass bead at 0.005 m/s without damping, at a step of this share of the Rayleigh time. ψ has the scale of row_of_springs.hpp.
double rebound(const char* name, double incidence, double share) {
  const double friction = 0.4, speed = 0.005, radius = 5e-3;
  static const PairContext pair = wall_pair(63.96e6, kPoisson, radius, 2500);
  const Law law = make_law(name, "restitution=1 static_friction=0.4", pair);
  const double angle = std::atan(incidence * friction / kStiffness);
  const Rebound r = mean_hit(law, bead(radius, 2500), speed, angle, share / 0.2 * rayleigh_step(radius));
  return kStiffness / friction * r.surface(radius) / r.normal;
}

}  // namespace

TEST_CASE("an impact that slides throughout follows rigid-body theory exactly") {
  // Δv_t = −μ (1 + e) v_n, spin = 5/2 μ (1 + e) v_n/R while tan θ > 7/2 μ (1 + e).
  for (const char* name : {"hertz_mindlin", "hertz_mindlin_deresiewicz"}) {
    for (const char* cap : {"", " cap=sum"}) {
      const Law law = make_law(name, std::string("restitution=0.9 static_friction=0.1") + cap, wall_pair(63.96e6, kPoisson, 5e-3, 2500));
      for (const double degrees : {60.0, 75.0}) {
        const double angle = degrees * kDegree, normal = 0.1 * std::cos(angle), change = 0.1 * 1.9 * normal;
        const Rebound r = mean_hit(law, bead(5e-3, 2500), 0.1, angle, 1e-6);
        INFO(name << cap << " " << degrees);
        CHECK(r.normal == Approx(0.9 * normal).epsilon(0.001));
        // Friction never pulls, damping does in the last moments: the compressive impulse is a little more than (1 + e) m v_n.
        CHECK(0.1 * std::sin(angle) - r.tangential == Approx(1.0025 * change).epsilon(0.002));
        CHECK(std::fabs(r.spin) * 5e-3 == Approx(2.5 * (0.1 * std::sin(angle) - r.tangential)).epsilon(0.004));  // the lever is R − δ
      }
    }
  }
}

TEST_CASE("without damping the impulse of sliding is exact to the time step") {
  for (const char* name : {"hertz_mindlin", "hertz_mindlin_deresiewicz"}) {
    const Law law = make_law(name, "restitution=1 static_friction=0.1", wall_pair(63.96e6, kPoisson, 5e-3, 2500));
    const Rebound r = mean_hit(law, bead(5e-3, 2500), 1.0, 70 * kDegree, 1e-7);
    CHECK(std::sin(70 * kDegree) - r.tangential == Approx(0.2 * std::cos(70 * kDegree)).epsilon(1e-4));
  }
}

TEST_CASE("the row of springs is Mindlin and Deresiewicz's contact") {
  // At constant load (their 1953, Eq. 15, 20, 27): F = μN φ(u), unloading from u*: F = F* − 2 μN φ((u* − u)/2), and back to the curve.
  const double stiffness = 0.87, friction = 0.3, overlap = 1e-4, load = 4.0 / 3.0 * overlap * std::sqrt(overlap);
  const double whole = friction * overlap / stiffness;  // the slip at which all slides
  const auto curve = [](double u) { return 1 - std::pow(1 - u, 1.5); };
  RowOfSprings row(stiffness, friction, overlap, 4000);
  double held = 0;
  const auto go_to = [&](double slip, int steps) {
    const double step = (slip * whole - held) / steps;
    for (int k = 0; k < steps; ++k) row.pull(overlap, step);
    held = slip * whole;
    return row.pull(overlap, 0.0) / (friction * load);
  };
  CHECK(go_to(0.3, 50) == Approx(curve(0.3)).epsilon(1e-3));
  CHECK(go_to(0.8, 50) == Approx(curve(0.8)).epsilon(1e-3));
  CHECK(go_to(0.2, 50) == Approx(curve(0.8) - 2 * curve(0.3)).epsilon(1e-3));
  CHECK(go_to(-0.5, 50) == Approx(curve(0.8) - 2 * curve(0.65)).epsilon(1e-3));
  CHECK(go_to(0.1, 50) == Approx(curve(0.8) - 2 * curve(0.65) + 2 * curve(0.3)).epsilon(1e-3));
  CHECK(go_to(0.9, 80) == Approx(curve(0.9)).epsilon(1e-3));
  // Load and slip grow together and dF_t < μ dF_n: nothing slips, dF_t = 8 G* a dδ_t.
  RowOfSprings grown(stiffness, friction, overlap, 4000);
  const double slope = 0.5 * friction / stiffness;
  double force = 0;
  for (int k = 1; k <= 2000; ++k) force = grown.pull(overlap * (k - 0.5) / 2000, slope * overlap / 2000);
  CHECK(force == Approx(4.0 / 3.0 * stiffness * slope * overlap * std::sqrt(overlap)).epsilon(2e-3));
}

TEST_CASE("under a constant load two springs follow the loops of the row: loading, unloading and reloading differ") {
  const double friction = 0.3, overlap = 1e-5, radius = 5e-3;
  const PairContext pair = wall_pair(63.96e6, kPoisson, radius, 2500);
  const Law law = make_law("hertz_mindlin_deresiewicz", "restitution=1 static_friction=0.3", pair);
  Contacts c(1);
  c.own_friction = true;
  c.overlap[0] = overlap, c.radius[0] = radius, c.mass[0] = pair.largest_mass;
  Contacts::put(c.normal, 0, {1, 0, 0});
  RowOfSprings row(kStiffness, friction, overlap / radius, 2000);
  const double depth = overlap / radius, load = 4.0 / 3.0 * depth * std::sqrt(depth);  // free of units
  const double whole = friction * overlap / kStiffness;                                // the slip at which all slides, m
  double held = 0;
  // Off most where the outer spring begins to slide: by φ(2/5) − 3/2 · 2/5 = 0.065 of the friction, twice that on a reversed curve, and by
  // what it began with.
  constexpr std::pair<double, double> kWay[] = {{0.8, 0.065}, {-0.4, 0.173}, {0.2, 0.054}, {1.5, 0.112}};
  for (const auto& [target, off] : kWay) {
    const double step = (target - held) * whole / 400;
    double worst = 0;
    for (int k = 0; k < 400; ++k) {
      Contacts::put(c.velocity, 0, {0, step / 1e-6, 0});
      c.step(law, 1e-6);
      const double found = -c.force[1][0] / (friction * c.normal_force[0]), exact = row.pull(depth, step / radius) / (friction * load);
      worst = std::max(worst, std::fabs(found - exact));
    }
    INFO("to " << target << " of the whole slip");
    CHECK(worst == Approx(off).margin(0.002));
    held = target;
  }
  CHECK(-c.force[1][0] == Approx(friction * c.normal_force[0]).epsilon(1e-9));
}

TEST_CASE("between sticking and sliding the surface of the bead reverses, as Maw, Barber & Fawcett (1976) found") {
  // Sliding ends and begins at ψ₁ = 7 S_t/S_n = 6.09 in rigid-body theory; with the compliance it lasts from 4 · 7/4 S_t/S_n − 1 = 5.09 on.
  // What each spring has more than Maw's ψ₂ when the step goes to zero: two springs in the place of the row little, one much.
  struct {
    double incidence, partial_slip, no_slip;
  } const cases[] = {{0.25, 0.017, 0.192}, {0.5, 0.056, 0.414}, {1, 0.0045, 0.525},  {1.5, 0.0075, 0.368}, {2, 0.030, 0.340},
                     {2.5, 0.037, 0.336},  {3, 0.034, 0.3295},  {3.5, 0.026, 0.311}, {4, 0.0163, 0.2745},  {4.5, 0.0065, 0.210},
                     {5, 0.001, 0.095},    {5.5, 0.001, 0.001}, {6, 0.001, 0.001},   {8, 0.001, 0.001}};
  for (const auto& c : cases) {
    const double exact = maw_rebound(c.incidence, kStiffness), rough = maw_rebound(c.incidence, kStiffness, 200);
    const auto error = [&](const char* name, double share) { return rebound(name, c.incidence, share) - exact; };
    INFO("psi_1 " << c.incidence << ", Maw's psi_2 " << exact);
    CHECK(exact == Approx(rough).margin(1.5e-3));
    if (c.incidence > 5.1) CHECK(exact == Approx(c.incidence - 7 * kStiffness).margin(1e-3));
    const double finest = error("hertz_mindlin_deresiewicz", 0.0025);
    CHECK(finest == Approx(c.partial_slip).margin(2e-3));
    CHECK(error("hertz_mindlin_deresiewicz", 0.01) == Approx(finest).margin(1e-3));
    CHECK(error("hertz_mindlin_deresiewicz", 0.02) == Approx(finest).margin(2.5e-3));
    CHECK(error("hertz_mindlin_deresiewicz", 0.2) == Approx(finest).margin(0.026));
    const double converged = error("hertz_mindlin", 0.0025);
    CHECK(converged == Approx(c.no_slip).margin(2e-3));
    CHECK(error("hertz_mindlin", 0.02) == Approx(converged).margin(1e-3));
    CHECK(error("hertz_mindlin", 0.2) == Approx(converged).margin(7.5e-3));
  }
  CHECK(maw_rebound(3.85, kStiffness) == Approx(-1.503).margin(2e-3));  // the least of all
}
