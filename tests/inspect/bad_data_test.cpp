// Recordings that cannot say: no figure without a reason, never a guess, never a crash.
#include <catch2/catch.hpp>
#include <cmath>

#include "inspect/synthetic.hpp"
#include "millscope/random.hpp"
#include "studies/inspect/report.hpp"

using namespace millscope;

namespace {

recording::Recording cut(recording::Recording recording, std::size_t points) {
  recording::Run& run = recording.runs[0];
  run.time.resize(points);
  for (auto& component : run.position) component.resize(points);
  return recording;
}

void check_all_say_why(const inspect::Inspection& i) {
  for (const inspect::Finding* f : {&i.motion.speed, &i.motion.path_radius, &i.motion.axis[0], &i.motion.axis[1], &i.flight.magnitude,
                                    &i.circulations.time, &i.mean_offset}) {
    CHECK_FALSE(f->estimate);
    CHECK_FALSE(f->note.empty());
  }
  for (const inspect::Verdict& v : i.verdicts) {
    CHECK(v.support == inspect::Support::no);
    CHECK_FALSE(v.reason.empty());
  }
  CHECK(inspect::inspection_text(i).find("cannot be said") != std::string::npos);
}

}  // namespace

TEST_CASE("a single point, two points and a moment support nothing, and say so") {
  for (const std::size_t points : {1UL, 2UL, 5UL, 40UL}) {
    INFO(points);
    check_all_say_why(inspect::inspect(cut(make_recording(test::SyntheticMill{}), points)));
  }
}

TEST_CASE("a tracer at rest supports nothing but its noise") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  Random random(3);
  for (auto& component : recording.runs[0].position) {
    for (double& x : component) x = 0.1 + 1e-3 * (random.uniform() - 0.5);
  }
  const inspect::Inspection i = inspect::inspect(recording);
  CHECK_FALSE(i.rotor);
  CHECK(i.motion.sense == 0);
  CHECK_FALSE(i.flight.magnitude.estimate);
  CHECK_THAT(i.noise[0].estimate->value, Catch::Matchers::WithinRel(1e-3 / std::sqrt(12.0), 0.15));
}

TEST_CASE("points without order are no mill") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  Random random(3);
  for (auto& component : recording.runs[0].position) {
    for (double& x : component) x = 0.3 * (random.uniform() - 0.5);
  }
  const inspect::Inspection i = inspect::inspect(recording);
  CHECK_FALSE(i.rotor);
  CHECK_FALSE(i.flight.magnitude.estimate);
  CHECK(i.motion.rides < 5);
}

TEST_CASE("a bead that only oscillates on the floor has no speed of the mill") {
  recording::Recording recording = make_recording(test::SyntheticMill{});
  recording::Run& run = recording.runs[0];
  for (std::size_t i = 0; i < run.size(); ++i) {
    run.position[0][i] = 0.05 * std::sin(3 * run.time[i]);
    run.position[1][i] = -0.1;
  }
  const inspect::Inspection i = inspect::inspect(recording);
  CHECK_FALSE(i.flight.magnitude.estimate);
  CHECK_FALSE((i.motion.speed.estimate && i.motion.speed.bound == inspect::Bound::both));
}
