// A published velocity profile in the place of a recording.
#include "studies/calibrate/velocity_profile.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/calibrate/methods.hpp"
#include "studies/calibrate/observe.hpp"
#include "studies/calibrate/validate.hpp"
#include "tests/calibrate/figure_drum.hpp"

using namespace millscope;
using calibrate::RecordedCondition;
using Catch::WithinAbs;
using Catch::WithinRel;
using testing::kDrumRadius;
using testing::registry;

namespace {

constexpr double kSurface = -0.02;  // m

/// Positions in mm and velocities in mm/s, in no order.
const std::string kPoints = "# digitised\np,v\n-90,180\n-30,-120\n-80,150\n-70,110\n-60,60\n-50,0\n-40,-60\n";
const std::string kRecording =
    "profile:\n  file: points.csv\n  position: {column: p, unit: mm}\n  velocity: {column: v, unit: mm/s}\n  position_error: 1 mm\n"
    "  velocity_error: 0.01 m/s\n";

struct Drum : testing::FigureDrum {
  explicit Drum(const std::string& recording = kRecording, const std::string& points = kPoints, const std::string& more = "")
      : FigureDrum(recording, more) {
    folder.write("points.csv", points);
  }
};

/// Beads of a segment that move along its surface as fast as their depth says; gravity's side is down.
template <class Flow>
void write_run(const testing::Folder& folder, const Flow& flow) {
  testing::FrozenBeads beads{{}, {}, 0.002};
  for (double p = -kDrumRadius; p <= kSurface; p += 0.0005) {
    for (double s = -0.1; s <= 0.1; s += 0.001) {
      if (std::hypot(p, s) > kDrumRadius) continue;
      beads.position.insert(beads.position.end(), {s, p, 0.025});
      beads.velocity.insert(beads.velocity.end(), {flow(p), 0.0, 0.0});
    }
  }
  testing::write_run(folder, beads);
}

}  // namespace

TEST_CASE("a profile is its points by position, in SI, with the errors that are stated") {
  const Drum drum;
  const auto figure = drum.figure();
  const auto* profile = dynamic_cast<const calibrate::VelocityProfile*>(figure.get());
  REQUIRE(profile);
  CHECK(profile->position.size() == 7);
  CHECK_THAT(profile->position.front(), WithinRel(-0.09, 1e-12));
  CHECK_THAT(profile->velocity.front(), WithinRel(0.18, 1e-12));
  CHECK_THAT(profile->velocity.back(), WithinRel(-0.12, 1e-12));
  const RecordedCondition r = drum.look();
  REQUIRE(r.observation.value.size() == 7);
  CHECK(r.observation.observables[5].name == "velocity at -40.0 mm");
  CHECK_THAT(r.observation.value[5], WithinRel(-0.06, 1e-12));
  CHECK_THAT(std::sqrt(r.observation.covariance(5, 5)), WithinRel(std::hypot(0.01, 6 * 0.001), 1e-9));  // 6 m/s per m on both sides
  CHECK_FALSE(r.observation.of_tracks());
  CHECK(std::isnan(r.observation.power.value));
}

TEST_CASE("neighbours are taken together where there are more than twelve points, and their error is smaller") {
  std::string points = "p,v\n";
  for (int i = 0; i < 36; ++i) points += fmt::format("{},{}\n", -90 + i, 2 * i);
  const RecordedCondition r = Drum(kRecording, points).look();
  REQUIRE(r.observation.value.size() == 12);
  CHECK_THAT(r.observation.value[0], WithinRel(2e-3, 1e-12));
  CHECK_THAT(std::sqrt(r.observation.covariance(4, 4)), WithinRel(std::hypot(0.01, 2 * 0.001) / std::sqrt(3.0), 1e-9));
}

TEST_CASE("a simulation is seen between the analyzer's places, where the measured points lie") {
  const auto flow = [](double p) { return -6 * (p + 0.05) + 20 * (p + 0.05) * (p + 0.05); };
  std::string points = "p,v\n";
  for (const double p : {-0.0873, -0.0712, -0.0555, -0.0491, -0.0337}) points += fmt::format("{},{}\n", 1e3 * p, 1e3 * flow(p));
  const Drum drum(kRecording, points);
  write_run(drum.folder, flow);
  const RecordedCondition r = drum.look();
  const auto seen = drum.seen(r);
  REQUIRE(seen.value.size() == r.observation.value.size());
  for (Eigen::Index i = 0; i < seen.value.size(); ++i) CHECK_THAT(seen.value[i], WithinAbs(r.observation.value[i], 0.002));
}

TEST_CASE("what a run shows of a profile is kept in a cache that is not there yet") {
  const Drum drum;
  write_run(drum.folder, [](double p) { return -6 * (p + 0.05); });
  drum.folder.write("summary.json", R"({"power_W": {"com": 1.5, "com_sem": 0.1}})");
  const calibrate::Observer observer(drum.study, registry(), calibrate::read_recordings(drum.study),
                                     {drum.folder.path / "cache" / "observations", 1, {}});
  campaign::Outcome run;
  run.folder = drum.folder.path, run.key = "key";
  const calibrate::Observation seen = observer.simulated(0, run);
  CHECK_THAT(seen.value[0], WithinAbs(0.24, 0.003));
  CHECK(seen.power.value == 1.5);
  run.folder = "gone";
  CHECK(observer.simulated(0, run).value == seen.value);  // from the cache
}

TEST_CASE("an error of the origin is shared by all points, by their slopes") {
  std::string text = kRecording + "  origin_error: 2 mm\n";
  const RecordedCondition with = Drum(text).look(), without = Drum().look();
  const Eigen::MatrixXd shared = with.observation.covariance - without.observation.covariance;
  CHECK_THAT(shared(5, 6), WithinRel(6 * 6 * 4e-6, 1e-9));
  CHECK_THAT(shared(5, 5), WithinRel(6 * 6 * 4e-6, 1e-9));
  CHECK(without.observation.covariance(5, 6) == 0);
}

TEST_CASE("the part of the length is left out of a periodic slice and refused beyond the ends of a closed mill") {
  std::string text = kRecording + "  z: [100 mm, 260 mm]\n";
  const RecordedCondition slice = Drum(text).look();
  CHECK(slice.analyzers.find("z_from") == std::string::npos);
  CHECK(slice.observation.notes.front().find("periodic along z") != std::string::npos);
  Drum closed(text);
  std::string drum = testing::drum_case(10, 1);
  drum.replace(drum.find("domain:"), drum.find('\n', drum.find("domain:")) + 1 - drum.find("domain:"), "");
  drum.replace(drum.find("end_faces: false"), 16, "end_faces: true");
  closed.folder.write("drum.yaml", drum);
  CHECK(testing::message_of([&] { closed.look(); }).find("'z' of") != std::string::npos);
}

TEST_CASE("a simulation without enough beads where a point was measured says so") {
  const Drum drum(kRecording, "p,v\n-90,1\n-70,1\n-50,1\n20,1\n");
  write_run(drum.folder, [](double) { return 0.1; });
  const RecordedCondition r = drum.look();
  const std::string said = testing::message_of([&] { drum.seen(r); });
  CHECK(said.find("'velocity at 20.0 mm' is undefined") != std::string::npos);
}

TEST_CASE("a recording of tracks is no profile") {
  const testing::Folder folder;
  CHECK_FALSE(calibrate::read_figure(folder.write("r.yaml", "files: [a.a]\n")));
  CHECK_FALSE(calibrate::read_figure(folder.write("r.a", "1 2 3\n")));
}

TEST_CASE("what is wrong with a profile is said with its place") {
  const auto said = [](const std::string& from, const std::string& to) {
    std::string text = kRecording;
    text.replace(text.find(from), from.size(), to);
    const Drum drum(text);
    return testing::message_of([&] { drum.figure(); });
  };
  CHECK(said("column: p", "column: q").find("r.yaml:3") != std::string::npos);
  CHECK(said("column: p", "column: q").find("no column of") != std::string::npos);
  CHECK(said("unit: mm/s", "unit: mm").find("not a unit like m/s") != std::string::npos);
  CHECK(said("unit: mm/s", "unit: furlong").find("furlong") != std::string::npos);
  CHECK(said("  position_error: 1 mm\n", "").find("position_error") != std::string::npos);
  CHECK(said("position_error: 1 mm", "position_error: 0 mm").find("standard error") != std::string::npos);
  CHECK(said("file: points.csv", "file: points.csv\n  from: -60 mm\n  to: -45 mm").find("2 points between") != std::string::npos);
  CHECK(said("file: points.csv", "file: points.csv\n  z: [20 mm, 10 mm]").find("must rise") != std::string::npos);
  CHECK(said("file: points.csv", "file: points.csv\n  shade: 1").find("unknown key 'shade'") != std::string::npos);
}

TEST_CASE("points outside the case's mill, another mill's speed and an objective of tracks are refused") {
  const Drum wide(kRecording, "p,v\n-130,1\n-70,1\n-50,1\n-40,1\n");
  CHECK(testing::message_of([&] { wide.look(); }).find("130 mm from the axis") != std::string::npos);
  const auto checked = [](const Drum& drum) {
    return testing::message_of([&] {
      calibrate::check_study(drum.study, registry());
      calibrate::check_recordings(drum.study, calibrate::read_recordings(drum.study), registry());
    });
  };
  CHECK(checked(Drum()).empty());
  CHECK(checked(Drum(kRecording + "condition: {speed: 3 rad/s}\n")).find("turning speed") != std::string::npos);
  CHECK(checked(Drum(kRecording, kPoints, "objective: chagas2015\n")).find("velocity profile") != std::string::npos);
}

TEST_CASE("calibration and validation go on without distributions and without a power") {
  const testing::Folder folder;
  const calibrate::Study study = testing::study_of(folder, "  a.mu: {range: [0.1, 0.8]}\n  a.e: {range: [0.3, 0.9]}\n",
                                                   "method: emulator\nbudget: {simulations: 16}\n");
  testing::MadeUpMill mill(study, Eigen::Vector2d(0.42, 0.7), 0.02);
  std::vector<calibrate::Observation> recorded = mill.recorded();
  for (calibrate::Observation& o : recorded) {
    o.x = {}, o.speed = {}, o.bead_seconds = 0;
    o.power.value = std::numeric_limits<double>::quiet_NaN();
  }
  calibrate::Evaluator evaluator(study, mill.machinery(), recorded);
  const calibrate::Calibration c = calibrate::calibrate(evaluator);
  CHECK(mill.computed() == 16);
  CHECK(c.best[0] == Approx(0.42).margin(0.06));
  REQUIRE(c.at_best);
  CHECK(c.at_best->chagas.value() == 0);
  const std::string text =
      calibrate::validation_text(calibrate::validate(evaluator, c.best, study.with_role(calibrate::Role::fit)), evaluator);
  CHECK(text.find("nan") == std::string::npos);
  CHECK(text.find("at once: misfit") != std::string::npos);
}
