// Each observation against what it says it does; bounds are four standard errors of the figure tested, seeds are fixed.
#include "support.hpp"

#include "millscope/random.hpp"

using namespace camera_test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// The distance moved, in the direction of no axis: for outliers.
double moved(const recording::Run& run, std::size_t i) { return std::hypot(run.position[0][i], run.position[1][i], run.position[2][i]); }

}  // namespace

TEST_CASE("an observation whose effect is zero gives back the track, to the bit") {
  const output::TrackSamples track = circling(2, 2000, 0.1, -6);
  for (const char* link :
       {"{kind: sampling}", "{kind: sampling, rate: 0}", "{kind: location_blur}", "{kind: noise}",
        "{kind: noise, correlation_time: 8 ms, growth: 5}", "{kind: error_cut}",
        "{kind: error_cut, spread: 4 mm, per_speed: 2 ms, scatter: 1 mm}", "{kind: gaps}", "{kind: gaps, mean_length: 1 s}",
        "{kind: outliers}", "{kind: outliers, distance: 2 m}", "{kind: frame_error}"}) {
    const recording::Run run = camera::observe(track, chain_of(link), context_of(1));
    INFO(link);
    CHECK(run.time == track.time);
    CHECK(run.position == track.position);
    CHECK(run.spread.empty());
  }
}

TEST_CASE("sampling has its rate, its dead time and its evenness") {
  const output::TrackSamples track = resting(400, 500);
  for (const double shape : {1.0, 4.0, 250.0}) {
    for (const double dead : {0.0, 0.002}) {
      const recording::Run run = camera::observe(
          track, chain_of(fmt::format("{{kind: sampling, rate: 220 Hz, dead_time: {}, shape: {}}}", dead, shape)), context_of(3));
      const std::vector<double> d = intervals(run);
      const double expected = (1.0 / 220 - dead) / std::sqrt(shape), n = static_cast<double>(d.size());
      INFO("shape " << shape << " dead time " << dead);
      CHECK_THAT(mean(d), WithinAbs(1.0 / 220, 4 * expected / std::sqrt(n)));
      CHECK_THAT(deviation(d), WithinRel(expected, 4 * std::sqrt((2.0 + 6.0 / shape) / (4 * n))));  // excess kurtosis 6/k
      CHECK(*std::min_element(d.begin(), d.end()) >= dead);
      CHECK(run.time.front() < 0.05);
    }
  }
}

TEST_CASE("sampled positions lie on the path, and a pause of the track stays one") {
  output::TrackSamples track = circling(20, 2000, 0.1, -6);
  const auto cut = [&](std::vector<double>& v) { v.erase(v.begin() + 10000, v.begin() + 14000); };  // 5 to 7 s
  cut(track.time);
  for (auto& p : track.position) cut(p);
  const recording::Run run = camera::observe(track, chain_of("{kind: sampling, rate: 300 Hz}"), context_of(5));
  REQUIRE(run.size() > 5000);
  for (std::size_t i = 0; i < run.size(); ++i) {
    CHECK_FALSE((run.time[i] > 5.0 && run.time[i] < 6.9995));
    CHECK_THAT(run.position[0][i], WithinAbs(0.1 * std::cos(-6 * run.time[i]), 2e-7));  // chord of 0.5 ms
  }
}

TEST_CASE("location_blur draws a circle in by sin(wT/2)/(wT/2) and leaves a straight path") {
  const double window = 0.02, omega = 40;
  const recording::Run circle =
      camera::observe(circling(2, 5000, 0.1, omega), chain_of("{kind: location_blur, window: 20 ms}"), context_of(1));
  const double factor = std::sin(omega * window / 2) / (omega * window / 2);
  for (std::size_t i = 100; i + 100 < circle.size(); i += 97) {
    CHECK_THAT(std::hypot(circle.position[0][i], circle.position[1][i]), WithinRel(0.1 * factor, 1e-5));
  }
  output::TrackSamples line = resting(1, 2000);
  for (std::size_t i = 0; i < line.size(); ++i) line.position[1][i] = 3 + 1.5 * line.time[i];
  const recording::Run straight = camera::observe(line, chain_of("{kind: location_blur, window: 20 ms}"), context_of(1));
  for (std::size_t i = 0; i < straight.size(); i += 50) CHECK_THAT(straight.position[1][i], WithinAbs(line.position[1][i], 1e-12));
  CHECK_THROWS_WITH(camera::observe(resting(10, 20), chain_of("{kind: location_blur, window: 5 ms}"), context_of(1)),
                    Catch::Contains("camera.yaml:3") && Catch::Contains("before sampling"));
}

TEST_CASE("noise has its deviation on each axis, its memory, and grows with distance") {
  const double rate = 500, time = 0.01;
  const auto run_at = [&](std::array<double, 3> at, std::uint64_t seed) {
    return camera::observe(resting(400, rate, at),
                           chain_of("{kind: noise, white: [0.4, 0.5, 0.6, mm], correlated: [0.3, 0.2, 0, mm], "
                                    "correlation_time: 10 ms, growth: 8}"),
                           context_of(seed));
  };
  const double white[] = {4e-4, 5e-4, 6e-4}, correlated[] = {3e-4, 2e-4, 0};
  for (const double distance : {0.0, 0.1}) {
    const recording::Run run = run_at({distance, 0, 0.03}, 7);  // the mill's axis goes from z = 0 to 60 mm
    const double factor = 1 + 8 * distance, n = static_cast<double>(run.size()), independent = n / (rate * 2 * time);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double expected = factor * std::hypot(white[axis], correlated[axis]);
      CHECK_THAT(deviation(run.position[axis]), WithinRel(expected, 4 / std::sqrt(2 * independent)));
      const double m = mean(run.position[axis]);
      for (const std::size_t lag : {1UL, 5UL, 10UL}) {
        double product = 0;
        for (std::size_t i = lag; i < run.size(); ++i) product += (run.position[axis][i] - m) * (run.position[axis][i - lag] - m);
        const double wanted = factor * factor * correlated[axis] * correlated[axis] * std::exp(-static_cast<double>(lag) / rate / time);
        CHECK_THAT(product / n, WithinAbs(wanted, 4 * expected * expected / std::sqrt(independent)));
      }
    }
  }
  CHECK_THROWS_WITH(chain_of("{kind: noise, correlated: [1, 1, 1, mm]}"), Catch::Contains("correlation_time"));
}

TEST_CASE("error_cut loses beads by speed and distance as the normal integral says") {
  const auto kept = [](double radius, double speed) {
    const output::TrackSamples track = circling(100, 400, radius, speed / radius);
    const recording::Run run =
        camera::observe(track,
                        chain_of("{kind: error_cut, cut: 9 mm, spread: 4 mm, per_distance: 0.02, per_speed: 2 ms, scatter: 0.8 mm, "
                                 "speed_window: 0.02}"),
                        context_of(11));
    for (const double u : run.spread) CHECK(u <= 9e-3);
    return static_cast<double>(run.size()) / static_cast<double>(track.size());
  };
  for (const double radius : {0.05, 0.14}) {
    for (const double speed : {0.0, 0.6, 1.2, 2.0}) {
      // The slope over the window is a chord's, a little less than the speed.
      const double half = speed / radius * 0.01,
                   seen = speed * 3 * (std::sin(half) - half * std::cos(half)) / std::max(half * half * half, 1e-30);
      const double v = half > 0.02 ? seen : speed;
      const double p = 0.5 * std::erfc(-(9e-3 - 4e-3 - 0.02 * radius - 2e-3 * v) / 0.8e-3 / std::numbers::sqrt2);
      INFO("radius " << radius << " speed " << speed);
      CHECK_THAT(kept(radius, speed), WithinAbs(p, 4 * std::sqrt(p * (1 - p) / 40000) + 0.01));
    }
  }
}

TEST_CASE("error_cut takes the speed from a straight line through the locations in its window, however uneven their times") {
  constexpr double kWindow = 0.02, kBegin = 1e9;
  output::TrackSamples track;
  millscope::Random random(13);
  double t = kBegin;
  for (int i = 0; i < 400; ++i) {
    t += i % 50 < 2 ? 0.1 : random.exponential() / 220;  // every fiftieth stands alone: the speed before holds
    track.time.push_back(t);
    for (auto& x : track.position) x.push_back(random.between(-0.01, 0.01) + 0.8 * (t - kBegin));
  }
  const recording::Run run = camera::observe(
      track, chain_of(fmt::format("{{kind: error_cut, cut: 9 m, spread: 4 mm, per_speed: 2 ms, speed_window: {}}}", kWindow)),
      context_of(1));
  REQUIRE(run.size() == track.size());
  double speed = 0;
  int alone = 0;
  for (std::size_t i = 0; i < track.size(); ++i) {
    std::vector<std::size_t> near;
    for (std::size_t k = 0; k < track.size(); ++k) {
      if (std::fabs(track.time[k] - track.time[i]) <= kWindow / 2) near.push_back(k);
    }
    double mean = 0, square = 0, slope[3] = {};
    for (const std::size_t k : near) mean += (track.time[k] - kBegin) / static_cast<double>(near.size());
    for (const std::size_t k : near) {
      const double off = track.time[k] - kBegin - mean;
      square += off * off;
      for (std::size_t axis = 0; axis < 3; ++axis) slope[axis] += off * track.position[axis][k];
    }
    alone += near.size() == 1;
    if (near.size() > 1) speed = std::hypot(slope[0], slope[1], slope[2]) / square;
    INFO("location " << i << " of " << near.size() << " in its window");
    CHECK_THAT(run.spread[i], WithinRel(4e-3 + 2e-3 * speed, 1e-6));
  }
  CHECK(alone >= 8);
}

TEST_CASE("in a periodic slice a bead is as far from the middle as its nearest image, however far it has wandered") {
  TrackContext context = context_of(11);  // ends at 0 and 60 mm
  context.period = context.mill_high - context.mill_low;
  const auto kept = [&](double z, const std::string& middle) {
    const camera::Camera camera = chain_of("{kind: error_cut, cut: 5 mm, spread: 4 mm, per_distance: 0.1, scatter: 0" + middle + "}");
    return camera::observe(resting(1, 100, {0, 0, z}), camera, context).size() == 100;  // within 10 mm of the middle
  };
  for (const double image : {-30, -1, 0, 1, 7}) {
    INFO(image);
    CHECK(kept(0.030 + 0.06 * image, ""));
    CHECK(kept(0.037 + 0.06 * image, ""));
    CHECK_FALSE(kept(0.045 + 0.06 * image, ""));
    CHECK(kept(0.003 + 0.06 * image, ", middle: [0, 0, 0]"));
  }
  context.period = 0;
  CHECK_FALSE(kept(0.090, ""));
}

TEST_CASE("gaps come at their rate with their mean length") {
  const recording::Run run =
      camera::observe(resting(20000, 100), chain_of("{kind: gaps, rate: 0.1 Hz, mean_length: 0.9 s}"), context_of(13));
  std::vector<double> gaps;
  for (const double d : intervals(run)) {
    if (d > 0.015) gaps.push_back(d - 0.01);
  }
  // Gaps shorter than a step are not seen; the length beyond a step is as long as before (no memory).
  const double seen = 0.1 * std::exp(-0.01 / 0.9), live = 20000 / (1 + 0.1 * 0.9), n = static_cast<double>(gaps.size());
  CHECK_THAT(n, WithinAbs(seen * live, 4 * std::sqrt(seen * live)));
  CHECK_THAT(mean(gaps), WithinRel(0.9, 4 / std::sqrt(n)));
  CHECK_THAT(deviation(gaps), WithinRel(0.9, 4 * std::sqrt(2 / n)));
  CHECK_THROWS_WITH(chain_of("{kind: gaps, rate: 1 Hz}"), Catch::Contains("mean_length"));
}

TEST_CASE("outliers have their share and their distance") {
  const recording::Run run =
      camera::observe(resting(400, 500), chain_of("{kind: outliers, fraction: 0.01, distance: 2 m}"), context_of(17));
  std::vector<double> far;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (moved(run, i) > 0) far.push_back(moved(run, i));
  }
  const double n = static_cast<double>(run.size());
  CHECK_THAT(static_cast<double>(far.size()), WithinAbs(0.01 * n, 4 * std::sqrt(0.01 * n)));
  CHECK_THAT(mean(far), WithinRel(2.0, 4 / std::sqrt(0.01 * n)));
}

TEST_CASE("frame_error shifts, turns and stretches, and its clock goes wrong") {
  const output::TrackSamples track = resting(0.1, 100, {0.1, 0.02, 0.03});
  const auto at = [&](const std::string& values) {
    const recording::Run run = camera::observe(track, chain_of("{kind: frame_error, " + values + "}"), context_of(1));
    return std::array<double, 3>{run.position[0][0], run.position[1][0], run.position[2][0]};
  };
  CHECK(at("offset_x: 1.4 mm, offset_y: -0.9 mm") == std::array<double, 3>{0.1 + 1.4e-3, 0.02 - 0.9e-3, 0.03});
  const auto turned = at("tilt_z: 90 deg");
  CHECK_THAT(turned[0], WithinAbs(-0.02, 1e-15));
  CHECK_THAT(turned[1], WithinAbs(0.1, 1e-15));
  const auto about_x = at("tilt_x: 90 deg");
  CHECK_THAT(about_x[1], WithinAbs(-0.03, 1e-15));
  CHECK_THAT(about_x[2], WithinAbs(0.02, 1e-15));
  const auto about_y = at("tilt_y: 90 deg");
  CHECK_THAT(about_y[2], WithinAbs(-0.1, 1e-15));
  CHECK_THAT(about_y[0], WithinAbs(0.03, 1e-15));
  CHECK_THAT(at("scale: 0.5 %")[0], WithinAbs(0.1005, 1e-15));
  const recording::Run late = camera::observe(track, chain_of("{kind: frame_error, clock: 2 %}"), context_of(1));
  for (std::size_t i = 0; i < late.size(); ++i) CHECK_THAT(late.time[i], WithinRel(1.02 * track.time[i], 1e-14) || WithinAbs(0, 1e-300));
}
