// A tracer on a rotor at stepped speeds.
#include <catch2/catch.hpp>
#include <cmath>

#include "inspect/synthetic.hpp"
#include "studies/inspect/inspect.hpp"

using namespace millscope;

TEST_CASE("a rotor is recognised with its radius, axis and plateaus") {
  const test::SyntheticRotor truth;
  const auto rotor = inspect::recognise_rotor(make_recording(truth));
  REQUIRE(rotor);
  CHECK_THAT(rotor->radius.value, Catch::Matchers::WithinAbs(truth.radius, 5e-5));
  CHECK(rotor->radius.low <= truth.radius);
  CHECK(rotor->radius.high >= truth.radius);
  CHECK_THAT(rotor->scatter, Catch::Matchers::WithinRel(truth.noise, 0.1));
  double along = 0, length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    along += rotor->axis[k] * truth.axis[k];
    length += truth.axis[k] * truth.axis[k];
    CHECK_THAT(rotor->centre[k], Catch::Matchers::WithinAbs(0.01, 1e-4));
  }
  CHECK_THAT(along / std::sqrt(length), Catch::Matchers::WithinAbs(1, 1e-3));
  REQUIRE(rotor->plateaus.size() == truth.speeds.size());
  for (std::size_t p = 0; p < truth.speeds.size(); ++p)
    CHECK_THAT(rotor->plateaus[p].speed.value, Catch::Matchers::WithinRel(truth.speeds[p], 0.005));
}

TEST_CASE("a tumbling tracer is no rotor") { CHECK_FALSE(inspect::recognise_rotor(make_recording(test::SyntheticMill{}))); }

TEST_CASE("a rotor that only speeds up has no plateau") {
  test::SyntheticRotor truth;
  truth.speeds.clear();
  for (double speed = 1; speed < 5; speed += 1) truth.speeds.push_back(speed);
  recording::Recording recording = make_recording(truth);
  recording::Run& run = recording.runs[0];
  for (std::size_t i = 0; i < run.size(); ++i) run.time[i] = std::sqrt(run.time[i]);  // an ever faster clock
  const auto rotor = inspect::recognise_rotor(recording);
  REQUIRE(rotor);
  CHECK(rotor->plateaus.empty());
}

TEST_CASE("an inspection of a rotor says so and leaves out what belongs to a mill") {
  const inspect::Inspection i = inspect::inspect(make_recording(test::SyntheticRotor{}));
  REQUIRE(i.rotor);
  CHECK(i.motion.sense == 0);
  REQUIRE_FALSE(i.verdicts.empty());
  CHECK(i.verdicts[0].support == inspect::Support::yes);
  CHECK(i.verdicts[0].reason.find("3 plateaus") != std::string::npos);
}
