#include <catch2/catch.hpp>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

namespace {

/// The part of a turning disc that lies right of `from`, as if a bed rose there and nothing came down: beads at one instant.
Frames rising_half(double sense, double omega) {
  const Motion disc = turning_disc(20000, 0.14, sense * omega);
  Frames frames;
  for (std::int64_t id = 0; id < 20000; ++id) {
    const Sample s = disc(id, 0);
    if (sense * s.position[0] > 0.02) frames.add_sample(id, s, 0.01, id % 2 == 0 ? 1e-4 : 3e-4);
  }
  frames.end_frame(0, sense * omega);
  return frames;
}

}  // namespace

TEST_CASE("in a rigid rotation Bbosa's sum is M g <x> Omega, whichever way the mill turns") {
  const double sense = GENERATE(1.0, -1.0);
  AnalyzerContext context = study(sense);
  const double omega = std::fabs(context.omega);
  const Frames frames = rising_half(sense, omega);
  double mass = 0, lever = 0;
  for (std::size_t s = 0; s < frames.id.size(); ++s) mass += frames.mass[s], lever += frames.mass[s] * frames.position[0][s];
  const Outcome o = Analyzer("power", context).of(frames);
  const double exact = 9.81 * lever / mass * context.omega;
  CHECK(exact > 0);
  CHECK(number(o, "centre_of_mass_x") == Approx(lever / mass));
  CHECK(number(o, "turning_speed") == Approx(context.omega));
  CHECK(number(o, "specific_power_gravity") == Approx(exact));
  CHECK(number(o, "power_gravity") == Approx(context.charge_mass * exact));
  for (const char* name : {"power_bbosa", "power_bbosa_of_mean", "power_bbosa_signed"}) {
    INFO(name);
    CHECK(number(o, name) == Approx(context.charge_mass * exact).epsilon(0.005));  // a cell stands for its middle
  }
  double map = 0, lift = 0;
  for (const double v : values(o, "power_map_bbosa")) map += std::isnan(v) ? 0 : v;
  for (const double v : values(o, "power_map_gravity")) lift += std::isnan(v) ? 0 : v;
  CHECK(map == Approx(number(o, "power_bbosa")));
  CHECK(lift == Approx(number(o, "power_gravity")));
}

TEST_CASE("a layer that runs back tells the three forms of Bbosa's sum apart") {
  const AnalyzerContext context = study();
  Frames frames;  // two cells at x = 0.063: one rises at Ω, one runs back at 2 Ω; and one whose beads go both ways
  const double omega = context.omega;
  const auto add = [&](double x, double y, double turning) { frames.add_sample(0, {{x, y, 0.1}, {-turning * y, turning * x, 0}}, 0.25); };
  add(0.063, 0.003, omega);
  add(0.063, 0.063, -2 * omega);
  add(-0.063, 0.003, omega);
  add(-0.063, 0.003, -omega);
  frames.end_frame(0, omega);
  const Outcome o = Analyzer("power", context).of(frames);
  const double unit = context.charge_mass * 9.81 * 0.063 * omega * 0.25;
  CHECK(number(o, "power_bbosa") == Approx(unit * (1 + 2 - 2)));
  CHECK(number(o, "power_bbosa_of_mean") == Approx(unit * (1 + 2 - 0)));
  CHECK(number(o, "power_bbosa_signed") == Approx(unit * (1 - 2 - 0)));
  CHECK(number(o, "power_gravity") == Approx(0).margin(1e-12));
}

TEST_CASE("the shell's work and the losses per time") {
  const double sense = GENERATE(1.0, -1.0);
  const AnalyzerContext context = study(sense);
  Frames frames;
  for (int f = 0; f < 50; ++f) {
    frames.add_sample(0, {{0.05, 0, 0.1}, {0, 0, 0}}, 0.01);
    frames.end_frame(3 + 0.01 * f, context.omega, 7.3);
  }
  for (double& lost : frames.lost) lost *= 0.5;
  const Outcome o = Analyzer("power", context).of(frames);
  CHECK(number(o, "power_shell") == Approx(7.3));
  CHECK(number(o, "power_dissipation") == Approx(3.65));
  CHECK(number(o, "shell_torque") == Approx(7.3 / context.omega));
}

TEST_CASE("a tracer of a mill whose charge is unknown gives power per mass, and no shell") {
  AnalyzerContext context = study();
  context.charge_mass = context.charge_count = 0;
  context.is_recording = 1;
  context.has = kHasVelocity;
  Frames frames = rising_half(1, context.omega);
  FrameBlock block = frames.block();
  block.omega = block.phase = block.wall_work = block.dissipation = block.mass = nullptr;
  const Outcome o = Analyzer("power", context).of(block);
  CHECK(o.count("power_gravity") == 0);
  CHECK(o.count("power_shell") == 0);
  CHECK(o.count("power_dissipation") == 0);
  CHECK(number(o, "specific_power_gravity") == Approx(9.81 * number(o, "centre_of_mass_x") * context.omega));
  CHECK(o.at("specific_power_map_bbosa").unit == "W/kg");
}
