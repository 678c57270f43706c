// Pieces, even times, weights, trimming.
#include "studies/trajectory/trajectory.hpp"

#include <catch2/catch.hpp>

#include <numeric>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

namespace {

double weights(const trajectory::Trajectory& trajectory) {
  double sum = 0;
  for (const trajectory::Piece& piece : trajectory.pieces) sum = std::accumulate(piece.weight.begin(), piece.weight.end(), sum);
  return sum;
}

recording::Run without(const recording::Run& run, double from, double to) {
  recording::Run rest;
  rest.source = run.source;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (run.time[i] > from && run.time[i] < to) continue;
    rest.time.push_back(run.time[i]);
    for (std::size_t k = 0; k < 3; ++k) rest.position[k].push_back(run.position[k][i]);
  }
  return rest;
}

}  // namespace

TEST_CASE("no spline crosses a gap, and the weights add up to the covered time") {
  recording::Run run = without(see(Motion(), {.duration = 10}), 4, 6);
  for (const trajectory::SplineKind kind : {trajectory::SplineKind::cubic, trajectory::SplineKind::smoothing}) {
    const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, {.kind = kind});
    CHECK(trajectory.pieces.size() >= 2);
    CHECK(trajectory.covered < 8.2);
    CHECK(trajectory.span > 9.9);
    CHECK(weights(trajectory) == Approx(trajectory.covered).margin(1e-3 * static_cast<double>(trajectory.pieces.size())));
    for (const trajectory::Piece& piece : trajectory.pieces) {
      const double end = piece.start + static_cast<double>(piece.size() - 1) * piece.step;
      CHECK_FALSE((piece.start < 4.9 && end > 5.1));
      REQUIRE(piece.position_variance.size() == piece.size());
      REQUIRE(piece.velocity[2].size() == piece.size());
    }
  }
}

TEST_CASE("short pieces are left out and counted, and nothing left is an error") {
  recording::Run run = see(Motion(), {.duration = 2});
  const double end = run.time.back();
  for (int k = 0; k < 4; ++k) {
    run.time.push_back(end + 1 + 0.005 * k);
    for (auto& component : run.position) component.push_back(0.1);
  }
  const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, {});
  CHECK(trajectory.points_left_out >= 4);
  std::size_t points = 0;
  for (const trajectory::Piece& piece : trajectory.pieces) points += piece.size();
  CHECK(points > 1900);
  CHECK_THAT(refusal([&] { trajectory::fit_trajectory(run, {.gap_limit = 1e-5}); }),
             Contains("seen") && Contains("no trajectory") && Contains("gap_limit"));
  CHECK_THAT(refusal([&] { trajectory::fit_trajectory(run, {.step = 0}); }), Contains("step"));
}

TEST_CASE("a jump that no bead can do ends a piece") {
  recording::Run run;
  run.source = "slice";
  for (int k = 0; k < 4000; ++k) {
    const double t = k / 2000.0;
    run.time.push_back(t);
    run.position[0].push_back(0.1 * std::cos(6 * t));
    run.position[1].push_back(0.1 * std::sin(6 * t));
    run.position[2].push_back(std::fmod(0.015 + 0.02 * t, 0.02));  // comes back at the other end of a periodic slice
  }
  const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, {.kind = trajectory::SplineKind::cubic});
  CHECK(trajectory.pieces.size() == 3);
  for (const trajectory::Piece& piece : trajectory.pieces) {
    for (const double v : piece.velocity[2]) REQUIRE(v == Approx(0.02).margin(1e-3));
  }
}

TEST_CASE("the values at a time do not depend on the step or on where the clock starts") {
  const recording::Run run = see(Motion(), {.duration = 3});
  const trajectory::TrajectoryOptions options{.noise = {0.7e-3, 0.7e-3, 0.7e-3}, .noise_correlation = 0};
  trajectory::TrajectoryOptions fine = options;
  fine.step = 0.5e-3;
  const trajectory::Trajectory coarse = trajectory::fit_trajectory(run, options), half = trajectory::fit_trajectory(run, fine);
  REQUIRE(coarse.pieces.size() == half.pieces.size());
  for (std::size_t p = 0; p < coarse.pieces.size(); ++p) {
    const trajectory::Piece &a = coarse.pieces[p], &b = half.pieces[p];
    const auto offset = static_cast<std::size_t>(std::llround((a.start - b.start) / b.step));
    for (std::size_t k = 0; k < a.size(); ++k) {
      REQUIRE(b.position[0][offset + 2 * k] == Approx(a.position[0][k]).margin(1e-10));
      REQUIRE(b.velocity_variance[offset + 2 * k] == Approx(a.velocity_variance[k]).epsilon(1e-6));
    }
  }
  recording::Run later = run;
  for (double& t : later.time) t += 1000;
  const trajectory::Trajectory shifted = trajectory::fit_trajectory(later, options);
  REQUIRE(shifted.pieces.size() == coarse.pieces.size());
  for (std::size_t p = 0; p < coarse.pieces.size(); ++p) {
    REQUIRE(shifted.pieces[p].size() == coarse.pieces[p].size());
    CHECK(shifted.pieces[p].start == Approx(coarse.pieces[p].start + 1000));
    for (std::size_t k = 0; k < coarse.pieces[p].size(); ++k) {
      REQUIRE(shifted.pieces[p].position[1][k] == Approx(coarse.pieces[p].position[1][k]).margin(1e-7));
    }
  }
}

TEST_CASE("a search for the roughness that begins near it finds the same motion") {
  const recording::Run run = see(Motion(), {.duration = 3});
  trajectory::TrajectoryOptions options{.noise = {0.7e-3, 0.7e-3, 0.7e-3}, .noise_correlation = 0};
  const trajectory::Trajectory wide = trajectory::fit_trajectory(run, options);
  const std::array<double, 3> found = trajectory::estimate_roughness({&run, 1}, options);
  CHECK(found[0] > 0);
  for (const double beside : {0.3, 1.0, 4.0}) {
    for (std::size_t axis = 0; axis < 3; ++axis) options.roughness[axis] = beside * found[axis];
    const std::array<double, 3> again = trajectory::estimate_roughness({&run, 1}, options);
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(again[axis] == Approx(found[axis]).epsilon(0.03));
    const trajectory::Trajectory near = trajectory::fit_trajectory(run, options);
    REQUIRE(near.pieces.size() == wide.pieces.size());
    const trajectory::Piece &p = near.pieces[0], &q = wide.pieces[0];
    REQUIRE(p.size() == q.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
      REQUIRE(p.position[0][k] == Approx(q.position[0][k]).margin(1e-5));
      REQUIRE(p.velocity_variance[k] == Approx(q.velocity_variance[k]).epsilon(0.03));
    }
  }
  CHECK(trajectory::estimate_roughness({}, options) == std::array<double, 3>{});
}

TEST_CASE("lengths scale, and the axis is subtracted") {
  const recording::Run run = see(Motion(), {.duration = 3});
  recording::Run larger = run;
  for (auto& component : larger.position) {
    for (double& x : component) x *= 4;
  }
  const trajectory::Trajectory a = trajectory::fit_trajectory(run, {.noise = {1e-3, 1e-3, 1e-3}, .noise_correlation = 0});
  const trajectory::Trajectory b =
      trajectory::fit_trajectory(larger, {.noise = {4e-3, 4e-3, 4e-3}, .noise_correlation = 0, .axis = {0.01, -0.02}});
  REQUIRE(a.pieces.size() == b.pieces.size());
  const trajectory::Piece &p = a.pieces[0], &q = b.pieces[0];
  for (std::size_t k = 0; k < p.size(); ++k) {
    REQUIRE(q.position[0][k] == Approx(4 * p.position[0][k] - 0.01).margin(1e-4));
    REQUIRE(q.position[1][k] == Approx(4 * p.position[1][k] + 0.02).margin(1e-4));
    REQUIRE(q.velocity[2][k] == Approx(4 * p.velocity[2][k]).margin(1e-2));
  }
  CHECK(b.location_position[0][5] == Approx(larger.position[0][5] - 0.01));
  CHECK(b.location_time == run.time);
}

TEST_CASE("samples beyond the end faces are left out, counted, and end a piece") {
  const recording::Run run = see(Motion(), {.duration = 10});
  const trajectory::Trajectory all = trajectory::fit_trajectory(run, {});
  const trajectory::Trajectory part = trajectory::fit_trajectory(run, {.low = 0.002, .high = 0.02});
  CHECK(all.samples_trimmed == 0);
  std::uint64_t outside = 0, kept = 0;
  double inside = 0, weight = 0;
  for (const trajectory::Piece& piece : all.pieces) {
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const bool in = piece.position[2][k] >= 0.002 && piece.position[2][k] <= 0.02;
      outside += !in;
      inside += in ? piece.weight[k] : 0;
    }
  }
  for (const trajectory::Piece& piece : part.pieces) {
    kept += piece.size();
    REQUIRE(piece.velocity_variance.size() == piece.size());
    for (std::size_t k = 0; k < piece.size(); ++k) {
      REQUIRE(piece.position[2][k] >= 0.002);
      REQUIRE(piece.position[2][k] <= 0.02);
      weight += piece.weight[k];
    }
  }
  CHECK(part.samples_trimmed == outside);
  CHECK(outside > 1000);
  CHECK(kept > 1000);
  CHECK(part.pieces.size() > all.pieces.size());  // the bead leaves and comes back: no track goes across
  CHECK(weight == Approx(inside));
  CHECK(part.covered == Approx(inside));
  CHECK(trajectory::fit_trajectory(run, {.low = 10, .high = 50}).pieces.empty());
}

TEST_CASE("a simulated bead without noise is followed exactly") {
  const Motion motion;
  recording::Run run;
  run.source = "exact";
  for (int k = 0; k < 8000; ++k) {
    const double t = k / 2000.0;
    run.time.push_back(t);
    const auto x = motion.position(t);
    for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(x[axis]);
  }
  for (const trajectory::SplineKind kind : {trajectory::SplineKind::cubic, trajectory::SplineKind::smoothing}) {
    const trajectory::Trajectory trajectory = trajectory::fit_trajectory(run, {.kind = kind, .gap_limit = 0.01});
    double worst = 0;
    std::size_t far = 0, count = 0;
    for (const trajectory::Piece& piece : trajectory.pieces) {
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const double t = piece.start + static_cast<double>(k) * piece.step;
        const auto x = motion.position(t), v = motion.velocity(t);
        worst = std::max(worst, std::fabs(piece.position[0][k] - x[0]));
        far += std::fabs(piece.velocity[0][k] - v[0]) > 0.02;
        ++count;
      }
    }
    CHECK(worst < 2e-4);
    CHECK(static_cast<double>(far) < 0.02 * static_cast<double>(count));  // only around impacts, where the velocity jumps
  }
}
