// The noise of the points, found apart from the motion.
#include <catch2/catch.hpp>

#include <random>

#include "recording/support.hpp"
#include "studies/recording/noise.hpp"
#include "studies/trajectory/trajectory.hpp"

using namespace millscope;
using namespace recording_test;

TEST_CASE("noise is found under impacts, flights and rides, at each rate") {
  for (const double rate : {60.0, 220.0, 800.0}) {
    for (const double noise : {0.3e-3, 1e-3}) {
      const recording::Run run = see(Motion(), {.rate = rate, .noise = noise, .duration = 40});
      const trajectory::NoiseEstimate found = trajectory::estimate_noise_model(run, 10 / rate);
      INFO(rate << " per s, " << 1e3 * noise << " mm");
      for (const double each : found.standard_deviation) CHECK(each == Approx(noise).epsilon(0.12));
      CHECK(found.correlation < 0.1);
    }
  }
}

TEST_CASE("the correlation of the noise is found, and the noise is not underestimated for it") {
  for (const double correlation : {0.2, 0.5, 0.7}) {
    const recording::Run run = see(Motion(), {.correlation = correlation, .duration = 60});
    const trajectory::NoiseEstimate found = trajectory::estimate_noise_model(run, 0.05);
    INFO(correlation);
    CHECK(found.correlation == Approx(correlation).margin(0.1));
    // Noise that hardly changes from point to point looks like motion, so some of it is missed.
    for (const double each : found.standard_deviation) CHECK(each == Approx(0.7e-3).epsilon(correlation < 0.6 ? 0.12 : 0.25));
    CHECK(recording::difference_noise(run, 0.05)[0] < 0.65e-3);  // which is why differences alone do not do
  }
}

TEST_CASE("each coordinate has its own noise") {
  recording::Run run = see(Motion(), {.duration = 40});
  std::mt19937_64 generator(9);
  std::normal_distribution<double> normal;
  for (double& z : run.position[2]) z += 2.4e-3 * normal(generator);
  const auto found = trajectory::estimate_noise_model(run, 0.05).standard_deviation;
  CHECK(found[0] == Approx(0.7e-3).epsilon(0.12));
  CHECK(found[2] == Approx(2.5e-3).epsilon(0.12));
}

TEST_CASE("outliers and gaps hardly change the noise that is found") {
  recording::Run run = see(Motion(), {.duration = 40});
  const auto before = trajectory::estimate_noise_model(run, 0.05).standard_deviation;
  for (std::size_t i = 100; i < run.size(); i += 500) run.position[0][i] += 0.08;
  for (std::size_t i = run.size() / 2; i < run.size(); ++i) run.time[i] += 60;
  const auto after = trajectory::estimate_noise_model(run, 0.05).standard_deviation;
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(after[axis] == Approx(before[axis]).epsilon(0.15));
}

TEST_CASE("a tracer at rest has the noise of its points") {
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal(0, 0.45e-3);
  recording::Run run;
  for (int k = 0; k < 4000; ++k) {
    run.time.push_back(0.005 * k);
    for (auto& component : run.position) component.push_back(normal(generator));
  }
  for (const double each : trajectory::estimate_noise_model(run, 0.05).standard_deviation) CHECK(each == Approx(0.45e-3).epsilon(0.06));
}

TEST_CASE("too few points have a noise all the same, or none") {
  recording::Run run = see(Motion(), {.duration = 0.05});
  REQUIRE(run.size() > 5);
  CHECK(trajectory::estimate_noise_model(run, 0.05).standard_deviation[0] > 0);
  run.time.resize(2);
  for (auto& component : run.position) component.resize(2);
  CHECK(trajectory::estimate_noise_model(run, 0.05).standard_deviation[0] == 0);
}

TEST_CASE("a noise that is given leaves its correlation to the points") {
  const recording::Run run = see(Motion(), {.correlation = 0.5, .duration = 20});
  const double found = trajectory::fit_trajectory(run, {}).noise_correlation;
  CHECK(found > 0.3);
  const trajectory::Trajectory given = trajectory::fit_trajectory(run, {.noise = {0.7e-3, 0.7e-3, 0.7e-3}});
  CHECK(given.noise[0] == 0.7e-3);
  CHECK(given.noise_correlation == found);
  CHECK(trajectory::fit_trajectory(run, {.noise = {0.7e-3, 0.7e-3, 0.7e-3}, .noise_correlation = 0.1}).noise_correlation == 0.1);
  CHECK(trajectory::fit_trajectory(run, {.noise_correlation = 0.1}).noise_correlation == 0.1);
}

TEST_CASE("several runs together give one steadier noise") {
  std::vector<recording::Run> runs;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) runs.push_back(see(Motion(), {.correlation = 0.3, .duration = 10, .seed = seed}));
  const trajectory::NoiseEstimate found = trajectory::estimate_noise_model(runs, 0.05);
  CHECK(found.correlation == Approx(0.3).margin(0.06));
  for (const double each : found.standard_deviation) CHECK(each == Approx(0.7e-3).epsilon(0.08));
}
