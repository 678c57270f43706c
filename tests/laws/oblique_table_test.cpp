// Chung & Ooi's test 4: 5 mm alumina at 3.9 m/s on a hard plate, from 5° to 85°, against what is published, measured and exact.
//
// kPublished: Chung & Ooi 2011, doi:10.1007/s10035-011-0277-0, as digitised in Kratos Multiphysics, DEM3D_chung_ooi_tests/test4_data. It is
// the curve of a DEM program, the same for two materials, and its spring is one without slip: see the last test. From its e_t and spin
// follows a rebound angle that is up to 0.66° from the one read off its own plot.
// kMeasured: Kharaz, Gorham & Salman 2001, doi:10.1016/S0032-5910(01)00283-2, alumina on glass, from the same file ("Experiment").
#include <catch2/catch.hpp>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "laws/oblique.hpp"
#include "laws/row_of_springs.hpp"

using namespace laws_test;

namespace {

constexpr double kRadius = 2.5e-3, kDensity = 4000, kSpeed = 3.9, kFriction = 0.092, kYoung = 380e9, kPoisson = 0.23;
constexpr const char* kLaws[] = {"hertz_mindlin", "hertz_mindlin_deresiewicz"};

struct Row {
  double angle, restitution, spin, patch;  // degrees, e_t, rad/s, degrees
};
constexpr Row kPublished[] = {{5, 0.948, 19.3, 3.76},  {10, 0.687, 213, -1.56}, {15, 0.624, 378, -5.54}, {20, 0.616, 511, -7.54},
                              {25, 0.634, 599, -7.54}, {30, 0.684, 617, -3.55}, {35, 0.737, 582, 3.43},  {40, 0.781, 545, 11.57},
                              {50, 0.845, 457, 29.35}, {60, 0.893, 357, 47.79}, {70, 0.932, 246, 64.58}, {80, 0.966, 126, 78.70},
                              {85, 0.983, 63.1, 84.52}};
constexpr double kMeasured[][2] = {{2.10, 0.77}, {3.94, 0.77}, {9.72, -1.06}, {20.31, -8.53}, {30.16, -2.55}};  // degrees: in, patch out

/// The plate is 1000 times as stiff as the sphere.
PairContext alumina() {
  PairContext pair = wall_pair(kYoung, kPoisson, kRadius, kDensity);
  pair.effective_young = 1.0 / ((1 - kPoisson * kPoisson) / kYoung * 1.001);
  pair.effective_shear = 1.0 / ((2 - kPoisson) * 2 * (1 + kPoisson) / kYoung * 1.001);
  return pair;
}

double rayleigh_time() { return kPi * kRadius * std::sqrt(kDensity * 2 * (1 + kPoisson) / kYoung) / (0.1631 * kPoisson + 0.8766); }

Row impact(const std::string& name, double degrees, double share, const char* restitution = "0.98") {
  const Law law = make_law(name, std::string("static_friction=0.092 restitution=") + restitution, alumina());
  const double angle = degrees * kDegree;
  const Rebound r = mean_hit(law, bead(kRadius, kDensity), kSpeed, angle, share * rayleigh_time());
  return {degrees, r.tangential / (kSpeed * std::sin(angle)), r.spin, std::atan2(r.surface(kRadius), r.normal) / kDegree};
}

/// Maw's: without damping an impulse J turns and brakes, ψ₂ − ψ₁ ∝ −7/2 J.
Row exact(double degrees) {
  const double stiffness = 2 * (1 - kPoisson) / (2 - kPoisson), angle = degrees * kDegree;
  const double in = stiffness / kFriction * std::tan(angle), out = maw_rebound(in, stiffness);
  const double lost = (1 - out / in) / 3.5;
  return {degrees, 1 - lost, 2.5 * lost * kSpeed * std::sin(angle) / kRadius, std::atan(out * kFriction / stiffness) / kDegree};
}

/// The rebound angle that a published e_t and spin give, e = 0.98.
double implied_patch(const Row& row) {
  const double along = row.restitution * kSpeed * std::sin(row.angle * kDegree) - kRadius * row.spin;
  return std::atan(along / (0.98 * kSpeed * std::cos(row.angle * kDegree))) / kDegree;
}

double spin_margin(const Row& row) { return std::max(8.0, 0.03 * row.spin); }

std::string line(const char* format, const Row& a, const Row& b, const Row& c, const Row& d, const Row& e, const Row& f) {
  char text[400];
  std::snprintf(text, sizeof text, format, a.angle, a.restitution, b.restitution, c.restitution, d.restitution, e.restitution,
                f.restitution, a.spin, b.spin, c.spin, d.spin, e.spin, f.spin, a.patch, b.patch, c.patch, d.patch, e.patch, f.patch);
  return text;
}

/// The table of docs/theory.md: in each cell published; Maw's; both laws at 2 %; both at 20 % of the Rayleigh time.
std::string table() {
  std::string text;
  for (const Row& p : kPublished) {
    text += line(
        "| %.0f | %.3f | %.3f | %.3f, %.3f | %.3f, %.3f | %.0f | %.0f | %.0f, %.0f | %.0f, %.0f | %.1f | %.1f | %.1f, %.1f | %.1f, %.1f "
        "|\n",
        p, exact(p.angle), impact(kLaws[0], p.angle, 0.02), impact(kLaws[1], p.angle, 0.02), impact(kLaws[0], p.angle, 0.2),
        impact(kLaws[1], p.angle, 0.2));
  }
  return text;
}

}  // namespace

TEST_CASE("test 4 of Chung & Ooi from 10 degrees on, at 2 % and at 20 % of the Rayleigh time") {
  for (const char* name : kLaws) {
    for (const double share : {0.02, 0.2}) {
      for (const Row& published : kPublished) {
        const bool partial_slip = name == kLaws[1];
        if (published.angle < (partial_slip ? 30 : 10)) continue;  // the published spring does not slip in part
        const Row found = impact(name, published.angle, share);
        INFO(name << " at " << published.angle << " degrees, " << 100 * share << " % of the Rayleigh time");
        CHECK(found.restitution == Approx(published.restitution).epsilon(0.03));
        CHECK(found.spin == Approx(published.spin).margin(published.angle == 10 ? 10.5 : spin_margin(published)));  // 1° is 35 rad/s there
        CHECK(found.patch == Approx(implied_patch(published)).margin(0.7));
        CHECK(found.patch == Approx(published.patch).margin(published.angle < 20 ? 1.1 : 0.7));  // the plot's own: see above
      }
    }
  }
}

TEST_CASE("the same impacts undamped against Maw's solution") {
  for (const double share : {0.02, 0.2}) {
    for (const Row& published : kPublished) {
      const Row maw = exact(published.angle), found = impact(kLaws[1], published.angle, share, "1");
      INFO(published.angle << " degrees, " << 100 * share << " % of the Rayleigh time: " << found.restitution << " for "
                           << maw.restitution);
      CHECK(found.restitution == Approx(maw.restitution).epsilon(published.angle < 10 ? 0.02 : 0.01));
      CHECK(found.spin == Approx(maw.spin).margin(std::max(4.0, 0.0175 * maw.spin)));
      CHECK(found.patch == Approx(maw.patch).margin(0.3));
    }
  }
}

TEST_CASE("measured impacts tell partial slip from none") {
  double squares[2] = {};
  for (const auto& [degrees, patch] : kMeasured) {
    for (int k : {0, 1}) {
      const double off = impact(kLaws[k], degrees, 0.02).patch - patch;
      INFO(kLaws[k] << " at " << degrees << " degrees: " << off);
      if (k == 1) CHECK(std::fabs(off) < 1.4);
      squares[k] += off * off / 5;
    }
  }
  CHECK(std::sqrt(squares[1]) == Approx(0.66).margin(0.03));
  CHECK(std::sqrt(squares[0]) == Approx(1.70).margin(0.05));
}

TEST_CASE("what is published as test 4 is a spring without slip: Maw's own solution misses it, and not by a little") {
  CHECK(exact(10).restitution / 0.687 == Approx(0.932).margin(0.005));
  CHECK(exact(15).restitution / 0.624 == Approx(0.952).margin(0.005));
  CHECK(exact(20).restitution / 0.616 == Approx(0.966).margin(0.005));
  CHECK(impact("hertz_mindlin", 10, 0.02, "1").restitution / 0.687 == Approx(1.011).margin(0.005));
}

TEST_CASE("the table of oblique impacts in the theory is what the laws give") {
  std::ifstream page(MILLSCOPE_SOURCE_DIR "/docs/theory.md");
  std::stringstream text;
  text << page.rdbuf();
  const std::string rows = table();
  std::puts(rows.c_str());
  CHECK(text.str().find(rows) != std::string::npos);
}
