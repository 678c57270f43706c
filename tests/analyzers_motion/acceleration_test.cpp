// mean_acceleration where the acceleration is known: rigid rotation, free fall with drag.
#include <catch2/catch.hpp>

#include "analyzers_motion/motions.hpp"

using namespace analyzers_test;
using Catch::Matchers::WithinAbs;

namespace {

AnalyzerContext mill(std::int64_t beads) {
  AnalyzerContext c = study();
  c.omega = 6;
  c.largest_id = beads - 1;
  return c;
}

}  // namespace

TEST_CASE("beads that turn with the shell are accelerated towards the axis by omega squared times their radius") {
  const double omega = 6, step = 0.002;
  std::vector<double> times;
  for (int k = 0; k < 2000; ++k) times.push_back(k * step);
  const Frames frames = all_beads(turning_disc(60, 0.14, omega), 60, times, even_weights(times.size(), step), omega);
  const Outcome o = Analyzer("mean_acceleration", mill(60)).of(frames);
  const auto vx = values(o, "velocity_x"), vy = values(o, "velocity_y");
  const auto x = values(o, "x"), y = values(o, "y"), time = values(o, "time"), angle = values(o, "angle_edges"), r = values(o, "r_edges");
  const std::size_t sectors = angle.size() - 1;
  int looked = 0;
  for (std::size_t ring = 2; ring + 1 < r.size(); ++ring) {
    for (std::size_t s = 0; s < sectors; ++s) {
      const std::size_t i = ring * sectors + s;
      if (time[i] < 0.5) continue;
      const double radius = 0.5 * (r[ring] + r[ring + 1]), from_six = 0.5 * (angle[s] + angle[s + 1]) * kRadians;
      const double half = 0.5 * (angle[s + 1] - angle[s]) * kRadians, mean = std::sin(half) / half;  // of the direction over the sector
      CHECK_THAT(x[i], WithinAbs(-omega * omega * radius * std::sin(from_six) * mean, 0.12 * omega * omega * radius));
      CHECK_THAT(y[i], WithinAbs(omega * omega * radius * std::cos(from_six) * mean, 0.12 * omega * omega * radius));
      CHECK_THAT(vx[i], WithinAbs(omega * radius * std::cos(from_six) * mean, 0.12 * omega * radius));
      CHECK_THAT(vy[i], WithinAbs(omega * radius * std::sin(from_six) * mean, 0.12 * omega * radius));
      ++looked;
    }
  }
  CHECK(looked >= 20);
  for (const double a : values(o, "along_motion")) {
    if (std::isfinite(a)) CHECK_THAT(a, WithinAbs(0, 1e-3));
  }
}

TEST_CASE("a bead that gravity pulls and a drag brakes shows both, whatever the noise of its velocities") {
  const double step = 0.002, gravity = 9.81;
  Random random(5);
  Frames frames;
  for (int k = 0; k < 200; ++k) {
    const double t = k * step;
    Sample s{{0.05, 0.1 - 0.5 * gravity * t * t + 0.2 * t, 0.1}, {0.02 * random.normal(), 0.2 - gravity * t + 0.02 * random.normal(), 0}};
    frames.add_sample(0, s, step);
    frames.end_frame(t, 6);
  }
  const Outcome o = Analyzer("mean_acceleration", mill(1)).of(frames);
  const auto y = values(o, "y"), x = values(o, "x"), time = values(o, "time");
  double force = 0, sideways = 0, sum = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (time[i] > 0) force += y[i] * time[i], sideways += x[i] * time[i], sum += time[i];
  }
  CHECK_THAT(force / sum, WithinAbs(-gravity, 0.2));
  CHECK_THAT(sideways / sum, WithinAbs(0, 0.2));
}
