// What a recording tells of its camera's frame by itself, and what that does for a diagnosis.
#include "studies/diagnose/bank/frame_readings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "inspect/synthetic.hpp"
#include "made_up_study.hpp"
#include "studies/diagnose/verdict/diagnosis.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinAbs;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

const std::string kDoubts =
    "nuisances:\n"
    "  fill.filling: {range: [30 %, 32.6 %], mean: 31.3 %, sigma: 0.4 %, name: filling}\n"
    "  camera.frame_error.offset_x: {range: [-5 mm, 5 mm], sigma: 1 mm, name: axis_x}\n"
    "  camera.frame_error.offset_y: {range: [-5 mm, 5 mm], sigma: 1 mm, name: axis_y}\n"
    "  camera.frame_error.tilt_z: {range: [-0.1, 0.1], sigma: 0.01, name: tilt}\n"
    "  camera.frame_error.clock: {range: [-0.05, 0.05], sigma: 0.005, name: clock}\n"
    "  camera.frame_error.scale: {range: [-0.02, 0.02], sigma: 0.005, name: scale}\n"
    "hypotheses: {rolling_resistance: {}}\n";

const ExpectedMill kMill{0.145, 0.005, true};

/// A recording whose statements are wrong by what a study may doubt.
recording::Recording misread() {
  test::SyntheticMill mill;
  mill.gravity_degrees = 3;
  recording::Recording recording = test::make_recording(mill);
  recording.frame = recording::MillFrame{{mill.axis[0] - 0.004, mill.axis[1] + 0.003}};
  recording.condition.speed = 1.03 * std::fabs(mill.angular_velocity);
  return recording;
}

const FrameReading& named(const std::vector<FrameReading>& readings, const Question& q, const std::string& name) {
  for (const FrameReading& r : readings) {
    if (q.nuisances[r.nuisance].name == name) return r;
  }
  FAIL("no reading of " << name);
  return readings.front();
}

}  // namespace

TEST_CASE("rides and flights tell where the axis stands, which way is down and whether the clock is right") {
  const Scratch folder;
  const Question q = question_of(folder, kDoubts);
  const std::vector<FrameReading> readings = read_frame(q, kMill, calibrate::Recorded(misread()));
  REQUIRE(readings.size() == 4);  // neither the filling nor the scale
  const auto close = [&](const std::string& name, double truth, double most) {
    INFO(name);
    const FrameReading& r = named(readings, q, name);
    CHECK_THAT(r.value, WithinAbs(truth, 3 * r.sem));
    CHECK(r.sem < most);
  };
  close("axis_x", 0.004, 0.5e-3);
  close("axis_y", -0.003, 0.5e-3);
  close("tilt", 3 * std::numbers::pi / 180, 0.02);
  close("clock", 0.03, 0.01);
  CHECK_THAT(text_of(readings), Contains("axis_x by rides along the shell 3.96 mm (3.4") && Contains(" mrad ("));
}

TEST_CASE("what is not stated cannot be read against") {
  const Scratch folder;
  const Question q = question_of(folder, kDoubts);
  recording::Recording recording = misread();
  recording.frame.reset();
  recording.condition.speed.reset();
  const std::vector<FrameReading> readings = read_frame(q, kMill, calibrate::Recorded(recording));
  REQUIRE(readings.size() == 1);
  CHECK(q.nuisances[readings[0].nuisance].name == "tilt");
  CHECK(read_frame(question_of(folder, "hypotheses: {rolling_resistance: {}}\n"), kMill, calibrate::Recorded(misread())).empty());
}

TEST_CASE("rides on another circle than the shell's, a gravity that leans and a tilt about another axis are not read against") {
  const Scratch folder;
  const Question q = question_of(folder, kDoubts);
  const std::vector<FrameReading> inner = read_frame(q, {0.152, 0.005, true}, calibrate::Recorded(misread()));
  REQUIRE(inner.size() == 1);
  CHECK(q.nuisances[inner[0].nuisance].name == "tilt");
  CHECK(read_frame(q, {0.145, 0.005, false}, calibrate::Recorded(misread())).size() == 3);
  std::string more = kDoubts;
  more.insert(more.find("hypotheses"), "  camera.frame_error.tilt_x: {range: [-0.1, 0.1], sigma: 0.01, name: roll}\n");
  CHECK(read_frame(question_of(folder, more), kMill, calibrate::Recorded(misread())).size() == 2);
}

TEST_CASE("the case says on which circle beads ride and whether its gravity leans") {
  const Scratch folder;
  const ExpectedMill mill = expected_mill(question_of(folder, kDoubts), 0, registry());
  CHECK_THAT(mill.path_radius, WithinAbs(0.145, 1e-12));
  CHECK_THAT(mill.bead_radius, WithinAbs(0.005, 1e-12));
  CHECK(mill.upright);
  std::string leaning = kDoubts;
  leaning.insert(leaning.find("hypotheses"), "  body_forces.gravity.angle: {range: [-0.1, 0.1], sigma: 0.01, name: slope}\n");
  CHECK_FALSE(expected_mill(question_of(folder, leaning), 0, registry()).upright);
}

TEST_CASE("what is wrong in all recordings alike does not average out") {
  std::vector<std::vector<FrameReading>> readings(4);
  for (std::size_t c = 0; c < 4; ++c) readings[c].push_back({0, {}, 1, 0.001, 0.0005});
  readings[1].push_back({1, {}, 1, 0.01, 0.02});
  share_errors(readings);
  for (const auto& of : readings) CHECK_THAT(of[0].sem, WithinAbs(0.001, 1e-15));
  CHECK(readings[1][1].sem == 0.02);
}

TEST_CASE("a simulation's reading is its own frame, the recording's is what it tells") {
  const Scratch folder;
  const Question q = question_of(folder, kDoubts);
  const std::vector<FrameReading> readings = read_frame(q, kMill, calibrate::Recorded(misread()));
  calibrate::Observation recorded, simulated;
  recorded.value = simulated.value = VectorXd::Constant(1, 7);
  recorded.covariance = simulated.covariance = MatrixXd::Constant(1, 1, 0.5);
  recorded.observables = simulated.observables = {{"power", "W", calibrate::ObservableKind::power}};
  add_readings(readings, recorded);
  VectorXd theta(8);
  theta << 0.3, 0.4, 0.313, 0.001, -0.002, 0.05, 0.01, 0.005;
  add_readings(q, readings, theta, simulated);
  REQUIRE(recorded.value.size() == 5);
  REQUIRE(recorded.observables.size() == 5);
  const FrameReading& x = named(readings, q, "axis_x");
  CHECK(recorded.value[0] == 7);
  CHECK(recorded.value[1] == 1e3 * x.value);
  CHECK_THAT(std::sqrt(recorded.covariance(1, 1)), WithinAbs(1e3 * x.sem, 1e-9));
  CHECK(recorded.covariance(0, 1) == 0);
  CHECK_THAT(simulated.value[1], WithinAbs(1, 1e-12));
  CHECK_THAT(simulated.value[2], WithinAbs(-2, 1e-12));
  CHECK_THAT(simulated.value[3], WithinAbs(50, 1e-12));
  CHECK(simulated.covariance(1, 1) < 1e-5 * recorded.covariance(1, 1));
  CHECK(simulated.observables[3].kind == calibrate::ObservableKind::frame);
}

TEST_CASE("a reading names a tilt that the charge alone leaves open") {
  const Scratch folder;
  const Question q = question_of(folder,
                                 "nuisances: {camera.frame_error.tilt_z: {range: [-0.1, 0.1], sigma: 0.01, name: tilt}}\n"
                                 "hypotheses: {rolling_resistance: {}}\nbank: {base: 24, each: 8}\n");
  const auto diagnosed = [&](bool read) {
    // A recording so noisy that the charge says nothing of so small a tilt.
    MadeUpMill mill(
        q, {}, {"pairs.glass~glass.static_friction=0.3", "pairs.glass~liner.static_friction=0.4", "camera.frame_error.tilt_z=0.06"}, 15);
    Evidence evidence = mill.evidence();
    for (std::size_t c = 0; read && c < 3; ++c) {
      evidence.readings.push_back({{0, {"tilt by free flights", "mrad", calibrate::ObservableKind::frame}, 1e3, 0.06, 0.012}});
      add_readings(evidence.readings.back(), evidence.recorded[c]);
    }
    naming::Options options;
    options.draws = 400, options.comparison_draws = 100;
    return diagnose::diagnose(q, mill.machinery(), evidence, options);
  };
  CHECK(diagnosed(false).named.empty());
  const Diagnosis d = diagnosed(true);
  INFO(d.sentence);
  REQUIRE(d.named == std::vector<std::string>{"tilt"});
  const base::Interval90& tilt = d.naming.judged.at(1).theta.at(2);
  CHECK(tilt.known());
  CHECK(tilt.holds(0.06));
  CHECK(tilt.low > 0.03);
}
