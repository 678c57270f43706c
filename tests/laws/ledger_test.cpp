// The energy ledger of a collision: what the bodies lose is what the channels book.
#include <catch2/catch.hpp>

#include "laws/two_bodies.hpp"

using namespace laws_test;

namespace {

struct Balance {
  double error, spread;
};

/// Mean and standard deviation of (lost − booked)/kinetic over where the first touch falls within a step.
Balance balance(const Law& law, double speed, double sideways, double dt) {
  constexpr int n = 32;
  double sum = 0, squares = 0;
  for (int k = 0; k < n; ++k) {
    Collision c = head_on(law, speed, sideways, speed * dt * 1e5 * (k + 0.5) / n);
    const Outcome out = c.run(dt);
    const double error = (out.kinetic_before - out.kinetic_after - out.total_lost()) / out.kinetic_before;
    sum += error / n;
    squares += error * error / n;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum))};
}

}  // namespace

TEST_CASE("the ledger of a head-on collision closes within 0.1 % at 20 % of the Rayleigh time") {
  for (const double e : {1.0, 0.9, 0.8}) {
    for (const char* name : {"hertz_mindlin", "linear_spring_dashpot", "jkr"}) {
      std::string text = "static_friction=0.34 restitution=" + std::to_string(e);
      if (name[0] == 'l') text += " normal_stiffness=20000";
      if (name[0] == 'j') text += " surface_energy=0.5";
      const Balance b = balance(make_law(name, text), 1.0, 0.0, rayleigh_step());
      INFO(name << ", e = " << e << ": " << b.error << " +- " << b.spread);
      CHECK(std::fabs(b.error) < 1e-3);
    }
  }
}

TEST_CASE("the ledger of any collision closes within 0.45 % at 20 % of the Rayleigh time and within 0.1 % at 10 %") {
  // The tangential spring swings 1.7 times as fast as the normal one, and a sliding surface moves by the whole slip in one step of 17 µm.
  for (const Case& c : kCases) {
    const Law law = make_law(c.law, c.values);
    // A linear force that is clipped ends with a jump, somewhere within a step.
    const bool jumps = std::string(c.law) == "linear_spring_dashpot" && std::string(c.values).find("allow_tension=0") != std::string::npos;
    for (const double sideways : {0.0, 0.2, 1.0}) {
      const Balance coarse = balance(law, 1.0, sideways, rayleigh_step()), fine = balance(law, 1.0, sideways, 0.5 * rayleigh_step());
      INFO(c.law << " " << c.values << ", sideways " << sideways << ": " << coarse.error << ", " << fine.error);
      CHECK(std::fabs(coarse.error) < (jumps ? 0.016 : 0.0045));
      CHECK(std::fabs(fine.error) < 0.001);
    }
  }
}

TEST_CASE("the ledger closes within 0.002 % at 1 % of the Rayleigh time") {
  for (const Case& c : kCases) {
    const Balance fine = balance(make_law(c.law, c.values), 1.0, 0.5, 0.05 * rayleigh_step());
    INFO(c.law << " " << c.values << ": " << fine.error);
    CHECK(std::fabs(fine.error) < 2e-5);
  }
}

TEST_CASE("the change of stiffness is a channel of its own and may give energy back") {
  const Law law = make_law("hertz_mindlin", "restitution=1 static_friction=10");
  Collision c = head_on(law, 1.0, 0.2);
  const Outcome out = c.run(1e-7);
  CHECK(std::string(law.table().info.channels[3].name) == "stiffness_change");
  CHECK(std::fabs(out.lost[3]) > 1e-4 * out.kinetic_before);
  CHECK(out.lost[0] == Approx(0.0).margin(1e-9 * out.kinetic_before));
}

TEST_CASE("of partial slip the edge takes its share as friction, and little is left for the change of stiffness") {
  // The row of springs that the law stands for has no change of stiffness at all.
  const Law law = make_law("hertz_mindlin_deresiewicz", "restitution=1 static_friction=0.34");
  for (const double sideways : {0.05, 0.2}) {
    Collision c = head_on(law, 1.0, sideways);
    const Outcome out = c.run(1e-7);
    INFO("friction " << out.lost[2] / out.kinetic_before << ", change " << out.lost[3] / out.kinetic_before);
    CHECK(out.lost[2] > 0.2 * sideways * sideways * out.kinetic_before);
    CHECK(std::fabs(out.lost[3]) < 0.1 * out.lost[2]);
    CHECK(out.kinetic_before - out.kinetic_after == Approx(out.lost[2] + out.lost[3]).epsilon(1e-5));
  }
}
