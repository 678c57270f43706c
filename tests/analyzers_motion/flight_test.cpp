// free_flight on arcs with gravity and drag that are known.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

struct World {
  std::array<double, 3> gravity{0, -9.81, 0};
  double drag = 0;
};

/// One step of a = g − k |v| v (Runge–Kutta).
void advance(const World& world, Sample& s, double dt) {
  using Six = std::array<double, 6>;
  const auto slope = [&](const Six& y) {
    const double speed = std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5]);
    Six d;
    for (std::size_t i = 0; i < 3; ++i) d[i] = y[i + 3], d[i + 3] = world.gravity[i] - world.drag * speed * y[i + 3];
    return d;
  };
  const auto plus = [](const Six& y, const Six& d, double h) {
    Six out;
    for (std::size_t i = 0; i < 6; ++i) out[i] = y[i] + h * d[i];
    return out;
  };
  Six y;
  for (std::size_t i = 0; i < 3; ++i) y[i] = s.position[i], y[i + 3] = s.velocity[i];
  const Six a = slope(y), b = slope(plus(y, a, dt / 2)), c = slope(plus(y, b, dt / 2)), d = slope(plus(y, c, dt));
  for (std::size_t i = 0; i < 3; ++i) {
    s.position[i] += dt / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    s.velocity[i] += dt / 6 * (a[i + 3] + 2 * b[i + 3] + 2 * c[i + 3] + d[i + 3]);
  }
}

/// Rests, flies for 0.25 s, rests … each bead with a start of its own; every flight in a piece of its own frame sequence.
Frames flights(const World& world, std::int64_t beads, double step, Random& random) {
  Frames frames;
  const auto rest = static_cast<std::size_t>(0.1 / step), fly = static_cast<std::size_t>(0.25 / step);
  std::vector<Sample> now(static_cast<std::size_t>(beads));
  for (Sample& s : now) {
    s.position = {-0.05 * random.uniform(), 0.1 * random.uniform(), 0.1 * random.uniform()};
    s.velocity = {0.2 + 1.3 * random.uniform(), 0.6 - 1.2 * random.uniform(), 0.6 * (random.uniform() - 0.5)};
  }
  for (std::size_t f = 0; f < 2 * rest + fly; ++f) {
    const bool flying = f >= rest && f < rest + fly;
    for (std::int64_t bead = 0; bead < beads; ++bead) {
      Sample s = now[bead];
      if (!flying) s.velocity = {0, 0, 0};
      frames.add_sample(bead, s, step);
    }
    frames.end_frame(static_cast<double>(f) * step, 6);
    if (!flying) continue;
    for (Sample& s : now) {
      for (int k = 0; k < 8; ++k) advance(world, s, step / 8);
    }
  }
  return frames;
}

AnalyzerContext mill(std::int64_t beads) {
  AnalyzerContext c = study();
  c.omega = 6;
  c.largest_id = beads - 1;
  return c;
}

}  // namespace

TEST_CASE("gravity and drag of exact flights come out") {
  Random random(3);
  for (const double drag : {0.0, 0.04, 0.3}) {
    World world;
    world.drag = drag;
    const Outcome o = Analyzer("free_flight", mill(40)).of(flights(world, 40, 0.005, random));
    CHECK(number(o, "arcs") == 40);
    CHECK_THAT(values(o, "gravity")[0], WithinAbs(0, 2e-3));
    CHECK_THAT(values(o, "gravity")[1], WithinAbs(-9.81, 2e-3));
    CHECK_THAT(values(o, "gravity")[2], WithinAbs(0, 2e-3));
    CHECK_THAT(number(o, "drag"), WithinAbs(drag, 2e-4 + 3e-3 * drag));
    CHECK_THAT(number(o, "drag_at_known_gravity"), WithinAbs(drag, 2e-4 + 3e-3 * drag));
    CHECK_THAT(number(o, "mean_duration"), WithinAbs(0.25, 0.03));
  }
}

TEST_CASE("a camera that is tilted and wrong in scale shows in gravity, not in drag") {
  Random random(4);
  World world;
  world.gravity = {0.3, -9.6, 0.1};
  world.drag = 0.05;
  const Outcome o = Analyzer("free_flight", mill(40)).of(flights(world, 40, 0.005, random));
  for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(values(o, "gravity")[i], WithinAbs(world.gravity[i], 3e-3));
  CHECK_THAT(number(o, "drag"), WithinAbs(0.05, 5e-4));
  CHECK_THAT(number(o, "gravity_tilt"), WithinAbs(std::atan2(0.3, 9.6) / kRadians, 0.02));
  CHECK_THAT(number(o, "gravity_size"), WithinAbs(std::sqrt(0.3 * 0.3 + 9.6 * 9.6 + 0.01), 3e-3));
}

TEST_CASE("noise leaves the fit true within its stated error") {
  constexpr double kNoise = 7e-4;
  Random random(5);
  World world;
  world.drag = 0.5;
  Frames frames = flights(world, 400, 0.005, random);
  std::vector<double> time, variance;
  std::vector<std::int64_t> id;
  std::array<std::vector<double>, 3> place;
  for (std::size_t f = 0; f < frames.time.size(); ++f) {
    for (auto s = static_cast<std::size_t>(frames.first[f]); s < static_cast<std::size_t>(frames.first[f + 1]); ++s) {
      time.push_back(frames.time[f]);
      id.push_back(frames.id[s]);
      variance.push_back(kNoise * kNoise);
      for (std::size_t axis = 0; axis < 3; ++axis) place[axis].push_back(frames.position[axis][s] + kNoise * random.normal());
    }
  }
  FrameBlock block = frames.block();
  block.has |= kHasLocations;
  block.location_count = static_cast<std::int64_t>(time.size());
  block.location_time = time.data();
  block.location_id = id.data();
  block.location_variance = variance.data();
  for (std::size_t axis = 0; axis < 3; ++axis) block.location_position[axis] = place[axis].data();
  const Outcome o = Analyzer("free_flight", mill(400)).of(block);
  CHECK(number(o, "arcs") == 400);
  CHECK_THAT(number(o, "residual"), WithinAbs(1, 0.02));
  const auto& error = values(o, "gravity_standard_error");
  for (std::size_t i = 0; i < 3; ++i) CHECK_THAT(values(o, "gravity")[i], WithinAbs(world.gravity[i], 3.5 * error[i]));
  CHECK(number(o, "drag_standard_error") < 0.05);
  CHECK_THAT(number(o, "drag"), WithinAbs(0.5, 3.5 * number(o, "drag_standard_error")));
}

TEST_CASE("only free motion is taken for flight") {
  const auto times = even_times(200, 0.005);
  const Outcome o = Analyzer("free_flight", mill(50)).of(all_beads(turning_disc(50, 0.14, 6), 50, times, even_weights(200, 0.005), 6));
  CHECK(number(o, "arcs") == 0);
  CHECK(std::isnan(number(o, "drag")));
}

TEST_CASE("launches and landings of Davis's charge are where his theory puts them, in both senses") {
  const Davis davis{6};
  const Motion motion = davis_charge(davis, 40, 0.139, 0.141);
  const auto times = even_times(400, 0.005);
  for (const double sense : {1.0, -1.0}) {
    AnalyzerContext c = mill(40);
    c.omega = sense * 6;
    const Outcome o =
        Analyzer("free_flight", c).of(all_beads(sense > 0 ? motion : mirrored(motion), 40, times, even_weights(400, 0.005), sense * 6));
    CHECK(number(o, "arcs") > 60);
    CHECK_THAT(number(o, "launch_median"), WithinAbs(davis.departure(0.14) / kRadians, 8));
    CHECK_THAT(number(o, "landing_median"), WithinAbs(davis.landing(0.14) / kRadians, 8));
    CHECK_THAT(values(o, "gravity")[1], WithinAbs(-9.81, 0.01));
  }
}

TEST_CASE("equations of arcs add up over blocks") {
  Random random(6);
  World world;
  world.drag = 0.1;
  const Frames a = flights(world, 20, 0.005, random), b = flights(world, 20, 0.005, random);
  const Analyzer analyzer("free_flight", mill(20));
  Sums sums = analyzer.zero(), other = analyzer.zero();
  analyzer.add(a.block(), sums);
  analyzer.add(b.block(), sums);
  analyzer.add(b.block(), other);
  analyzer.add(a.block(), other);
  CHECK(difference(analyzer.finish(sums), analyzer.finish(other)) < 1e-6);
  CHECK(number(analyzer.finish(sums), "arcs") == 40);
}
