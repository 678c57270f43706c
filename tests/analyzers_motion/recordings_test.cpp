// Features, circulation and flights of real and realistic recordings, where these are present.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"
#include "studies/trajectory/trajectory.hpp"
#include "tests/skip.hpp"

using namespace analyzers_test;
using namespace millscope;
using Catch::Matchers::WithinAbs;

namespace {

/// Splined samples of a recording as blocks, with its measured points.
struct Recorded {
  Frames frames;
  trajectory::Trajectory trajectory;
  std::vector<double> variance;
  std::vector<std::int64_t> location_id;

  Recorded(const std::string& file, std::array<double, 2> axis, double omega) {
    const recording::Recording recording = recording::read_recording(testing::recording(file));
    trajectory::TrajectoryOptions options;
    options.axis = axis;
    options.step = 2e-3;
    trajectory = trajectory::fit_trajectory(recording.runs.at(0), options);
    std::int32_t number = 0;
    for (const trajectory::Piece& piece : trajectory.pieces) {
      for (std::size_t i = 0; i < piece.size(); ++i) {
        Sample s;
        for (std::size_t axis_number = 0; axis_number < 3; ++axis_number) {
          s.position[axis_number] = piece.position[axis_number][i];
          s.velocity[axis_number] = piece.velocity[axis_number][i];
        }
        frames.add_sample(0, s, piece.weight[i]);
        frames.end_frame(piece.start + static_cast<double>(i) * piece.step, omega, 0, number);
      }
      ++number;
    }
    double noise = 0;
    for (const double n : trajectory.noise) noise += n * n / 3;
    variance.assign(trajectory.location_time.size(), noise);
    location_id.assign(variance.size(), 0);
  }

  FrameBlock block(std::size_t from = 0, std::size_t to = static_cast<std::size_t>(-1)) const {
    FrameBlock b = frames.block(from, to);
    b.has |= kHasLocations;
    b.location_count = static_cast<std::int64_t>(variance.size());
    b.location_time = trajectory.location_time.data();
    for (std::size_t axis = 0; axis < 3; ++axis) b.location_position[axis] = trajectory.location_position[axis].data();
    b.location_variance = variance.data();
    b.location_id = location_id.data();
    return b;
  }
};

AnalyzerContext recorded_mill(double radius, double bead_radius, double omega) {
  AnalyzerContext c{};
  c.mill_radius = radius;
  c.bead_radius = bead_radius;
  c.omega = omega;
  c.gravity = 9.81;
  c.is_recording = 1;
  c.has = kHasVelocity | kHasOmega | kHasLocations;
  return c;
}

}  // namespace

TEST_CASE("shoulder, toe, eye and cataract of a real mill are found, and both halves of the recording agree") {
  if (testing::absent("uct_mill_part1.a")) return;
  // 230 mm: radius of the tracer's centre next to the shell; clockwise, 36 rpm.
  const double omega = -3.75;
  const Recorded recorded("uct_mill_part1.a", {-0.002, 0.013}, omega);
  const Analyzer analyzer("charge_features", recorded_mill(0.2325, 0, omega));
  const std::size_t n = recorded.frames.time.size();
  const Outcome whole = analyzer.of(recorded.block()), first = analyzer.of(recorded.block(0, n / 2)),
                second = analyzer.of(recorded.block(n / 2, n));

  CHECK_THAT(number(first, "departure_shoulder"), WithinAbs(number(second, "departure_shoulder"), 3));
  CHECK_THAT(number(first, "bulk_toe"), WithinAbs(number(second, "bulk_toe"), 3));
  CHECK_THAT(number(whole, "departure_shoulder"), WithinAbs(117, 6));
  CHECK_THAT(number(whole, "bulk_toe"), WithinAbs(-41, 4));
  for (const char* part : {"centre_of_circulation_x", "centre_of_circulation_y"}) {
    CHECK_THAT(number(first, part), WithinAbs(number(second, part), 3e-3));
  }
  CHECK_THAT(number(whole, "centre_of_circulation_x"), WithinAbs(-0.110, 5e-3));
  CHECK_THAT(number(whole, "centre_of_circulation_y"), WithinAbs(-0.104, 5e-3));
  CHECK_THAT(number(whole, "free_surface_angle"), WithinAbs(47, 4));
  CHECK(number(whole, "cataracting_share") > 0.005);
  CHECK(number(whole, "flights_landed") >= 3);
  CHECK_THAT(number(whole, "head_height"), WithinAbs(0.19, 0.01));

  const Outcome turns = Analyzer("circulation", recorded_mill(0.2325, 0, omega)).of(recorded.block());
  CHECK_THAT(number(turns, "circulations_per_turn"), WithinAbs(1.7, 0.15));
  const Outcome flight = Analyzer("free_flight", recorded_mill(0.2325, 0, omega)).of(recorded.block());
  CHECK(number(flight, "arcs") >= 3);
  CHECK_THAT(number(flight, "gravity_size"), WithinAbs(9.7, 0.4));
  CHECK_THAT(number(flight, "gravity_tilt"), WithinAbs(0, 2.5));
}

TEST_CASE("features of five tracer runs of one mill agree") {
  const auto file_of = [](int run) { return "mill10_A_75_" + std::to_string(run) + ".a"; };
  for (int run = 1; run <= 5; ++run) {
    if (testing::absent(file_of(run))) return;
  }
  std::vector<double> shoulder, toe;
  for (int run = 1; run <= 5; ++run) {
    const std::string file = file_of(run);
    const Recorded recorded(file, {0.0014, -0.0009}, -6.17);
    const Outcome o = Analyzer("charge_features", recorded_mill(0.15, 0.005, -6.17)).of(recorded.block());
    shoulder.push_back(number(o, "departure_shoulder"));
    toe.push_back(number(o, "bulk_toe"));
    CHECK_THAT(number(o, "centre_of_circulation_radius"), WithinAbs(0.087, 0.006));
    CHECK(number(o, "cataracting_share") > 0.03);
  }
  for (const double s : shoulder) CHECK_THAT(s, WithinAbs(123, 12));
  for (const double t : toe) CHECK_THAT(t, WithinAbs(-24, 15));
}
