// What is stated of a recording's mill against what its tracer shows, and what the reader set aside.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "analysis/support.hpp"
#include "inspect/synthetic.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/analysis/recorded_mill.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;

namespace {

/// A clockwise mill of 6 rad/s: its bead rides on a circle of 145 mm about (2.1, −3.4) mm.
const recording::Recording& clockwise() {
  static const recording::Recording recording = millscope::test::make_recording(millscope::test::SyntheticMill{});
  return recording;
}

std::string why(const recording::Condition& condition) {
  recording::Recording recording = clockwise();
  recording.condition = condition;
  recording.file = "recording.yaml";
  return refusal([&] { analysis::know_mill(recording, {}); });
}

std::string notes(const analysis::RecordedMill& known) {
  std::string all;
  for (const std::string& note : known.notes) all += note + "\n";
  return all;
}

recording::Condition stated(double omega) {
  recording::Condition condition;
  condition.angular_velocity = omega;
  condition.speed = std::fabs(omega);
  return condition;
}

}  // namespace

TEST_CASE("a stated sense that the tracer contradicts is refused, and so is a speed in another unit") {
  CHECK(why(stated(-6)).empty());
  CHECK_THAT(why(stated(6)),
             Contains("recording.yaml: the mill is stated to turn counter-clockwise") && Contains("clockwise; check the axes"));
  CHECK_THAT(why(stated(-360)), Contains("3438 rpm") && Contains("check the speed and its unit"));
  CHECK_THAT(why(stated(-0.1)), Contains("check the speed and its unit"));
  recording::Condition magnitude;
  magnitude.speed = 360;
  CHECK_THAT(why(magnitude), Contains("check the speed and its unit"));
  // Also where everything is given, so that nothing has to be found.
  recording::Recording recording = clockwise();
  recording.condition = stated(6);
  recording.condition.mill_diameter = 0.3;
  recording.frame = recording::MillFrame{{0.0021, -0.0034}, 0, 0};
  CHECK_THAT(refusal([&] { analysis::know_mill(recording, {}); }), Contains("check the axes"));
}

TEST_CASE("a stated speed somewhat beside the one found is used, with a note") {
  recording::Recording recording = clockwise();
  recording.condition = stated(-6.6);
  const analysis::RecordedMill known = analysis::know_mill(recording, {});
  CHECK(known.context.omega == -6.6);
  CHECK_THAT(notes(known), Contains("is stated to turn at 63.03 rpm, but 57."));
  recording.condition = stated(-6);
  CHECK_THAT(notes(analysis::know_mill(recording, {})), !Contains("is stated to turn"));
}

TEST_CASE("a mill's length says nothing of where its ends are, but weighs the charge") {
  recording::Recording recording = clockwise();
  recording::Condition& c = recording.condition;
  c.mill_diameter = 0.3;
  c.mill_length = 0.06;
  c.filling = 0.3;
  c.porosity = 0.4;
  c.bead_diameter = 0.01;
  c.bead_density = 2500;
  const analysis::RecordedMill known = analysis::know_mill(recording, {});
  CHECK(known.context.mill_low == 0);
  CHECK(known.context.mill_high == 0);
  CHECK(known.context.mill_length == 0.06);
  CHECK(known.context.charge_mass == Approx(0.6 * 0.3 * std::numbers::pi * 0.15 * 0.15 * 0.06 * 2500));
  CHECK_THAT(notes(known), Contains("where the end faces stand along z is not known"));
  recording.frame = recording::MillFrame{{0.0021, -0.0034}, 0.01, 0.07};
  const analysis::RecordedMill with_ends = analysis::know_mill(recording, {});
  CHECK(with_ends.context.mill_low == 0.01);
  CHECK(with_ends.context.mill_high == 0.07);
  CHECK_THAT(notes(with_ends), !Contains("end faces"));
}

TEST_CASE("where only a bound is found, the note says it and the value that is used") {
  millscope::test::SyntheticMill mill;
  mill.slip = 0.4;
  const analysis::RecordedMill known = analysis::know_mill(millscope::test::make_recording(mill), {});
  CHECK_THAT(notes(known), Contains("clockwise at ") && Contains(" (at least "));
}

TEST_CASE("steps and gaps in which a motion is lost are refused") {
  const auto read = [](const std::string& text) {
    return analysis::read_trajectory_options(millscope::config::parse_document(text, "settings.yaml"));
  };
  CHECK(read("{step: 5 ms, gap_limit: 1 s, noise: 1 mm, noise_correlation: 0.2}").noise_correlation == 0.2);
  CHECK_FALSE(read("{noise: 1 mm}").noise_correlation);
  CHECK_THAT(refusal([&] { read("{step: 10 s}"); }), Contains("settings.yaml:1:") && Contains("give e.g. 1 ms"));
  CHECK_THAT(refusal([&] { read("{gap_limit: 40}"); }), Contains("give e.g. 50 ms"));
  CHECK_THAT(refusal([&] { read("{noise_correlation: 0.95}"); }), Contains("noise_correlation"));
}

TEST_CASE("rows that were set aside are told in notes and in the results") {
  const Scratch scratch;
  const recording::Recording& seen = clockwise();
  const recording::Run& run = seen.runs[0];
  std::string text = "t_s,x_m,y_m,z_m\n";
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i == 10) text += "lost,1,2,3\n";
    if (i == 20) text += fmt::format("{},nan,0,0\n", run.time[i] - 1e-5);
    text += fmt::format("{},{},{},{}\n", run.time[i], run.position[0][i], run.position[1][i], run.position[2][i]);
  }
  spill(scratch / "run.csv", text);
  analysis::SourceRequest request;
  request.path = scratch / "run.csv";
  request.trajectory.gap_limit = 0;
  const analysis::OpenedSource opened = analysis::open_source(request, testing::registry());
  std::string all;
  for (const std::string& note : opened.meta.notes) all += note + "\n";
  CHECK_THAT(all, Contains("run read as table, comma: t s (column 1)"));
  CHECK_THAT(all, Contains("rows are used; set aside: 1 unreadable, 1 not finite"));
  REQUIRE(opened.meta.runs.size() == 1);
  CHECK(opened.meta.runs[0]["rows"] == run.size() + 2);
  CHECK(opened.meta.runs[0]["rows_set_aside"]["unreadable"] == 1);
  CHECK(opened.meta.runs[0]["rows_set_aside"]["duplicates"] == 0);
}
