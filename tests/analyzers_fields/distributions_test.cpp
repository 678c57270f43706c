#include <catch2/catch.hpp>

#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

TEST_CASE("a uniform disc has the distributions of a disc") {
  constexpr std::int64_t kBeads = 90000;
  const AnalyzerContext context = study();
  const Outcome o =
      Analyzer("distributions", context).of(all_beads(turning_disc(kBeads, 0.15, context.omega), kBeads, {0.0}, {0.01}, context.omega));
  // Share left of x: ½ + (x √(R² − x²) + R² asin(x/R))/(π R²).
  const auto below = [](double x) {
    return 0.5 + (x * std::sqrt(std::fmax(0, 0.0225 - x * x)) + 0.0225 * std::asin(std::clamp(x / 0.15, -1.0, 1.0))) / (kPi * 0.0225);
  };
  for (const std::string axis : {"x", "y"}) {
    for (std::size_t i = 0; i < 50; ++i) {
      const double left = values(o, axis + "_edges")[i], right = values(o, axis + "_edges")[i + 1];
      CHECK(right - left == Approx(0.006));
      CHECK(values(o, axis + "_percent")[i] == Approx(100 * (below(right) - below(left))).margin(0.04));
      CHECK(values(o, axis + "_cumulative")[i + 1] == Approx(100 * below(right)).margin(0.04));
    }
    CHECK(sum(values(o, axis + "_percent")) == Approx(100));
    CHECK(number(o, axis + "_outside_percent") == 0);
  }
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK(values(o, "z_percent")[i] == Approx(2));
    CHECK(values(o, "radial_density")[i] == Approx(1 / (kPi * 0.0225)).epsilon(0.002));
    CHECK(values(o, "radial_number_density")[i] == Approx(context.charge_count / (kPi * 0.0225)).epsilon(0.002));
  }
  // A rigid rotation: speed over shell speed is r/R, distributed as 2 r/R.
  for (std::size_t i = 0; i < 20; ++i)
    CHECK(values(o, "speed_ratio_percent")[i] == Approx(100 * (2 * static_cast<double>(i) + 1) / 400).margin(0.01));
  CHECK(values(o, "speed_ratio_cumulative").back() == Approx(100));
  CHECK(number(o, "shell_speed") == Approx(0.15 * context.omega));
}

TEST_CASE("what is beyond the bins stays outside and counts in the whole") {
  const AnalyzerContext context = study();
  Frames frames;
  frames.add_sample(0, {{-0.2, 0.01, 0.1}, {0, 0, 0}}, 0.1);
  frames.add_sample(1, {{0.01, 0.2, 0.1}, {10, 0, 0}}, 0.1);
  frames.add_sample(2, {{0.01, 0.01, 0.3}, {0, 0.1, 0}}, 0.3);
  frames.add_sample(3, {{0.01, 0.01, 0.1}, {0, 0, 0.1}}, 0.5);
  frames.end_frame(0, context.omega);
  const Outcome o = Analyzer("distributions", context).of(frames);
  CHECK(number(o, "x_outside_percent") == Approx(10));
  CHECK(values(o, "x_cumulative").front() == Approx(10));
  CHECK(values(o, "x_cumulative").back() == Approx(100));
  CHECK(number(o, "y_outside_percent") == Approx(10));
  CHECK(values(o, "y_cumulative").back() == Approx(90));
  CHECK(number(o, "z_outside_percent") == Approx(30));
  CHECK(number(o, "r_outside_percent") == Approx(20));
  CHECK(number(o, "speed_ratio_outside_percent") == Approx(10));
  const Outcome trimmed = Analyzer("distributions", context, "z_from=0.05 z_to=0.2").of(frames);
  CHECK(number(trimmed, "x_outside_percent") == Approx(100.0 / 7));
}

TEST_CASE("distributions whose scale is unknown are left out") {
  AnalyzerContext context = study();
  context.omega = 0;
  context.mill_high = context.mill_low = 0;
  context.charge_count = 0;
  const Outcome o = Analyzer("distributions", context).of(all_beads(turning_disc(100, 0.1, 1), 100, {0.0}, {0.01}, 0));
  CHECK(o.count("x_percent") == 1);
  CHECK(o.count("speed_ratio_percent") == 0);
  CHECK(o.count("z_percent") == 0);
  CHECK(o.count("radial_number_density") == 0);
}
