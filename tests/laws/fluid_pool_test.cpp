// A pool of liquid: what it does to one bead, by formula.
#include <catch2/catch.hpp>

#include "laws/forces.hpp"

using namespace laws_test;

namespace {

constexpr double kPi = 3.14159265358979323846, kRadius = 2.5e-3, kLevel = -0.02;
constexpr double kVolume = 4.0 / 3.0 * kPi * kRadius * kRadius * kRadius;

ValueSet pool_values() {
  ValueSet values(plugin("fluid_pool"));
  values.set("level", kLevel);
  return values;
}

}  // namespace

TEST_CASE("buoyancy is the weight of the liquid displaced, half of it where the bead is half submerged") {
  const Force pool(pool_values());
  const double weight = 1000 * kVolume * 9.81;
  CHECK(pool.on({0.01, -0.1, 0}, {}, kRadius)[1] == Approx(weight));
  CHECK(pool.on({0.01, kLevel, 0}, {}, kRadius)[1] == Approx(0.5 * weight));
  const double depth = 0.5 * kRadius, cap = kPi * depth * depth * (3 * kRadius - depth) / 3;
  CHECK(pool.on({0, kLevel + kRadius - depth, 0}, {}, kRadius)[1] == Approx(1000 * cap * 9.81));
  const auto submerged = pool.on({0.01, -0.1, 0}, {}, kRadius);
  CHECK(submerged[0] == 0.0);
  CHECK(submerged[4] == Approx(0.5 * 1000 * kVolume));
  CHECK(pool.on({0.01, kLevel, 0}, {}, kRadius)[4] == Approx(0.25 * 1000 * kVolume));
}

TEST_CASE("above its level, and without density, the pool does nothing at all") {
  const std::array<double, 5> nothing{};
  CHECK(Force(pool_values()).on({0, kLevel + 1.001 * kRadius, 0}, {1, -2, 3}, kRadius) == nothing);
  ValueSet null = pool_values();
  null.set("fluid_density", 0.0);
  for (const double y : {-0.1, kLevel}) CHECK(Force(null).on({0.1, y, 0}, {1, -2, 3}, kRadius) == nothing);
  null.set("fluid_density", 1e-6);  // and it vanishes in proportion
  CHECK(std::fabs(Force(null).on({0.1, -0.1, 0}, {1, -2, 3}, kRadius)[0]) < 1e-9);
}

TEST_CASE("force, added mass and power change without a jump as a bead crosses the surface") {
  const Force pool(pool_values());
  const auto at = [&](double height) { return pool.on({0, kLevel + height, 0}, {0.4, -1.5, 0.2}, kRadius); };
  const double step = 1e-9 * kRadius;
  for (const double height : {kRadius, 0.3 * kRadius, 0.0, -kRadius}) {
    const auto above = at(height + step), below = at(height - step);
    for (std::size_t k = 0; k < 5; ++k) {
      INFO("height " << height << ", result " << k);
      CHECK(above[k] == Approx(below[k]).margin(1e-6 * std::fabs(at(0.0)[k])));
    }
  }
}

TEST_CASE("a submerged bead is dragged as a single sphere is, and more among neighbours") {
  ValueSet values = pool_values();
  const double speed = 0.05, reynolds = speed * 2 * kRadius / 1e-6;
  const double schiller = 3 * kPi * 1e-3 * 2 * kRadius * (1 + 0.15 * std::pow(reynolds, 0.687)) * speed;
  CHECK(Force(values).on({0, -0.1, 0}, {speed, 0, 0}, kRadius)[0] == Approx(-schiller));
  CHECK(Force(values).on({0, kLevel, 0}, {speed, 0, 0}, kRadius)[0] == Approx(-0.5 * schiller));
  values.set("kinematic_viscosity", 1e-5);
  CHECK(Force(values).on({0, -0.1, 0}, {1e-5, 0, 0}, kRadius)[0] == Approx(-6 * kPi * 1e-2 * kRadius * 1e-5).epsilon(0.01));  // Stokes
  values.set("kinematic_viscosity", 1e-6).set("porosity", 0.4);
  const double slow = 0.4 * reynolds, exponent = 3.7 - 0.65 * std::exp(-0.5 * std::pow(1.5 - std::log10(slow), 2));
  const double di_felice = 3 * kPi * 1e-3 * 2 * kRadius * (1 + 0.15 * std::pow(slow, 0.687)) * speed * std::pow(0.4, -exponent);
  CHECK(Force(values).on({0, -0.1, 0}, {speed, 0, 0}, kRadius)[0] == Approx(-di_felice));
  CHECK(di_felice > 5 * schiller);
}

TEST_CASE("a bead that dives in hands momentum to the liquid. What it leaves behind is lost") {
  const Force pool(pool_values());
  const double growth = 0.5 * 1000 * kPi * kRadius * kRadius * 1.0;  // dm_a/dt at the waterline of a great circle, kg/s
  const auto down = pool.on({0, kLevel, 0}, {0, -1, 0}, kRadius), up = pool.on({0, kLevel, 0}, {0, 1, 0}, kRadius);
  const double buoyancy = 0.5 * 1000 * kVolume * 9.81;
  CHECK(down[1] + up[1] == Approx(2 * buoyancy + growth));  // drag cancels
  CHECK(down[3] == Approx(down[1] - 0.5 * growth));
  CHECK(up[3] == Approx(-up[1] + 0.5 * growth));
}

TEST_CASE("a liquid that turns with the mill carries a bead of its own density along") {
  ValueSet values = pool_values();
  values.set("flow", "turning").set("angular_velocity", -6.0).set("gravity", 0.0);
  const Force pool(values);
  const auto f = pool.on({0.03, -0.08, 0}, {-0.48, -0.18, 0}, kRadius);
  const double carried = 1000 * kVolume + f[4];  // (m + m_a) a with a = -Omega^2 r
  CHECK(f[0] == Approx(-36 * 0.03 * carried));
  CHECK(f[1] == Approx(36 * 0.08 * carried));
  values.set("flow", "at_rest");
  CHECK_THROWS_WITH(Force(values), Catch::Contains("flow: turning"));
  values.set("flow", "turning").set("angular_velocity", 0.0);
  CHECK_THROWS_WITH(Force(values), Catch::Contains("flow: at_rest"));
}

TEST_CASE("the hypothesis of a pool needs its own parameter only") {
  const Descriptor& d = plugin("fluid_pool");
  REQUIRE(d.hypothesis_count == 1);
  CHECK(std::string(d.hypotheses[0].parameter) == "fluid_density");
  for (std::uint64_t k = 0; k < d.parameter_count; ++k) CHECK_FALSE(std::isnan(d.parameters[k].fallback));
}
