#include <catch2/catch.hpp>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

TEST_CASE("beads that lag behind the shell slip by what they lag") {
  const double sense = GENERATE(1.0, -1.0);
  const AnalyzerContext context = study(sense);
  const Motion lagging = [&](std::int64_t id, double t) {
    Sample s = turning_disc(20000, 0.15, 0)(id, t);
    const double r = std::hypot(s.position[0], s.position[1]), turning = context.omega * (1 - 2 * r);
    s.velocity = {-turning * s.position[1], turning * s.position[0], 0};
    return s;
  };
  const Outcome o = Analyzer("slip", context).of(all_beads(lagging, 20000, {0.0}, {0.01}, context.omega));
  for (std::size_t ring = 1; ring < 25; ++ring) {
    const double middle = 0.006 * (static_cast<double>(ring) + 0.5);
    CHECK(values(o, "slip")[ring] == Approx(2 * middle).margin(0.002));
    CHECK(values(o, "angular_velocity_ratio")[ring] == Approx(1 - 2 * middle).margin(0.002));
    CHECK(values(o, "spread")[ring] < 0.006);
    CHECK(values(o, "time_share")[ring] == Approx((2 * static_cast<double>(ring) + 1) / 625).margin(0.002));
  }
  CHECK(o.count("slip_by_lifter_phase") == 0);
}

TEST_CASE("only the sector counts") {
  const double sense = GENERATE(1.0, -1.0);
  const AnalyzerContext context = study(sense);
  Frames frames;
  const auto add = [&](double degrees, double slip) {  // from 6 o'clock in the turning sense
    const double a = degrees * kPi / 180, x = sense * 0.1 * std::sin(a), y = -0.1 * std::cos(a), turning = context.omega * (1 - slip);
    frames.add_sample(0, {{x, y, 0.1}, {-turning * y, turning * x, 0}}, 0.1);
  };
  for (const double degrees : {1.0, 30.0, 59.0}) add(degrees, 0.1);
  for (const double degrees : {-1.0, -90.0, 61.0, 180.0}) add(degrees, 2.0);
  frames.end_frame(0, context.omega);
  CHECK(values(Analyzer("slip", context).of(frames), "slip")[16] == Approx(0.1));
  CHECK(values(Analyzer("slip", context, "sector_from=1.0471976 sector_to=1.2").of(frames), "slip")[16] == Approx(2.0));
  CHECK(std::isnan(values(Analyzer("slip", context).of(frames), "slip")[0]));
}

TEST_CASE("slip by the place between lifters, whatever the angle of the shell") {
  const double sense = GENERATE(1.0, -1.0);
  const AnalyzerContext context = study(sense);
  Frames frames;  // beads turn with the shell; those in the quarter that follows a lifter lag by half
  for (int f = 0; f < 40; ++f) {
    const double t = 0.013 * f, shell = context.omega * t;
    for (int i = 0; i < 20 * 16; ++i) {
      const double place = (i + 0.5) / 16, a = sense * place * 2 * kPi / 20 + shell + 0.3;
      const double turning = context.omega * (place - std::floor(place) < 0.25 ? 0.5 : 1);
      const double x = 0.14 * std::cos(a), y = 0.14 * std::sin(a);
      frames.add_sample(i, {{x, y, 0.1}, {-turning * y, turning * x, 0}}, 0.013);
    }
    frames.end_frame(t, context.omega);
  }
  const Outcome o = Analyzer("slip", context, "lifters=20 lifter_angle=0.3 bins_phase=8").of(frames);
  CHECK(o.at("slip_by_lifter_phase").axes == std::vector<std::string>{"r_edges", "lifter_phase_edges"});
  for (std::size_t p = 0; p < 8; ++p) CHECK(values(o, "slip_by_lifter_phase")[23 * 8 + p] == Approx(p < 2 ? 0.5 : 0).margin(1e-9));
}

TEST_CASE("a recording without the shell's angle gives slip by radius alone") {
  AnalyzerContext context = study();
  context.has = kHasVelocity;
  Frames frames = all_beads(turning_disc(500, 0.15, context.omega), 500, {0.0}, {0.01}, context.omega);
  FrameBlock block = frames.block();
  block.omega = block.phase = nullptr;
  const Outcome o = Analyzer("slip", context, "lifters=20").of(block);
  CHECK(o.count("slip_by_lifter_phase") == 0);
  CHECK(values(o, "slip")[24] == Approx(0).margin(1e-12));
}
