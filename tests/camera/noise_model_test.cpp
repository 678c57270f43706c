// The likelihood from which the camera's noise is read: it must not take slow noise for a bead that wanders.
#include "studies/camera/noise_model.hpp"

#include <numeric>

#include "millscope/observation_adapter.hpp"
#include "studies/camera/stretch_wide.hpp"
#include "support.hpp"

using namespace camera_test;
using namespace camera;

namespace {

constexpr double kWhite = 0.29e-3, kCorrelated = 0.21e-3, kTime = 8e-3;  // m, m, s

/// A bead that rests, or goes straight ahead, seen 24 times, 5 ms apart.
camera::Stretch straight(Random& random) {
  camera::Stretch s;
  std::array<double, 3> slow{}, speed{};
  for (std::size_t axis = 0; axis < 3; ++axis) slow[axis] = kCorrelated * random.normal(), speed[axis] = 0.1 * random.normal();
  for (int i = 0; i < 24; ++i) {
    const double t = 5e-3 * i, kept = i > 0 ? std::exp(-5e-3 / kTime) : 1;
    s.time.push_back(t);
    s.distance.push_back(0.02);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      slow[axis] = kept * slow[axis] + kCorrelated * std::sqrt(1 - kept * kept) * random.normal();
      s.value[axis].push_back(speed[axis] * t + slow[axis] + kWhite * random.normal());
    }
  }
  return s;
}

struct Tried {
  camera::NoiseStrength noise;
  double time, memory;  // s
};

double log_likelihood(const std::vector<camera::Stretch>& stretches, const Tried& tried) {
  std::vector<camera::Rungs> rungs;
  for (const camera::Stretch& s : stretches) {
    const camera::Steps steps(s, tried.time, tried.memory, 0);
    for (const camera::Rungs& axis : camera::rung_likelihoods(s, steps, {tried.noise, tried.noise, tried.noise})) rungs.push_back(axis);
  }
  const std::vector<double> each = camera::averaged_over_ladder(rungs);
  return std::accumulate(each.begin(), each.end(), 0.0);
}

}  // namespace

TEST_CASE("of beads that do not wander it makes no difference how quickly they would forget it") {
  Random random(11);
  std::vector<camera::Stretch> stretches;
  for (int k = 0; k < 300; ++k) stretches.push_back(straight(random));
  const camera::NoiseStrength truth{kWhite, kCorrelated};
  const double best = log_likelihood(stretches, {truth, kTime, 0.02});
  // With rungs that are equally likely a memory of 3 ms would be more likely by a hundred, and with it slow noise too small and too short.
  // A wandering that is forgotten at once can stand in for slow noise, but must not be preferred.
  CHECK(std::fabs(log_likelihood(stretches, {truth, kTime, 3e-3}) - best) < 5);
  CHECK(std::fabs(log_likelihood(stretches, {truth, kTime, 0.06}) - best) < 5);
  CHECK(log_likelihood(stretches, {{kWhite, 0.8 * kCorrelated}, 0.5 * kTime, 3e-3}) < best + 2);
  CHECK(log_likelihood(stretches, {{0.9 * kWhite, kCorrelated}, kTime, 0.02}) < best - 20);
  CHECK(log_likelihood(stretches, {{1.1 * kWhite, kCorrelated}, kTime, 0.02}) < best - 20);
}

TEST_CASE("the axes of a stretch go side by side without touching one another, and every machine has the same bits") {
  Random random(12);
  const camera::Stretch s = straight(random);
  const camera::Steps steps(s, kTime, 0.02, 11);
  const std::array<camera::NoiseStrength, 3> noise{{{0.2e-3, 0.1e-3}, {0.3e-3, 0.2e-3}, {0.5e-3, 0.4e-3}}};
  const std::array<camera::Rungs, 3> all = camera::rung_likelihoods(s, steps, noise);
  camera::Stretch turned = s;
  turned.value = {s.value[1], s.value[2], s.value[0]};
  CHECK(camera::rung_likelihoods(turned, steps, {noise[1], noise[2], noise[0]}) == std::array{all[1], all[2], all[0]});
  CHECK(all[0] != all[1]);
  CHECK(all[1] != all[2]);
  if (!__builtin_cpu_supports("x86-64-v3")) return;
  const camera::StretchView view{s.time.data(),     s.value[0].data(),   s.value[1].data(),   s.value[2].data(), steps.dt.data(),
                                 steps.kept.data(), steps.slowed.data(), steps.factor.data(), steps.memory,      s.time.size()};
  const double white[3] = {0.2e-3, 0.3e-3, 0.5e-3}, correlated[3] = {0.1e-3, 0.2e-3, 0.4e-3};
  std::array<double, 3> v2{}, v3{};
  camera::wide_v2::stretch_likelihood(view, {white, correlated}, 0.3, v2.data());
  camera::wide_v3::stretch_likelihood(view, {white, correlated}, 0.3, v3.data());
  CHECK(v2 == v3);
  CHECK(std::isfinite(v2[0]));
}

TEST_CASE("the weights of the ladder are those of its rungs among the stretches") {
  // Three in four can only be on the first rung, the others only on the last: averages are 3/4 and 1/4 of their likelihoods.
  camera::Rungs low, high;
  low.fill(-1000), high.fill(-1000);
  low.front() = -10, high.back() = -12;
  const std::vector<double> each = camera::averaged_over_ladder({low, low, high, low});
  CHECK(each[0] == Approx(-10 + std::log(0.75)));
  CHECK(each[2] == Approx(-12 + std::log(0.25)));
  // Where rungs are nearly alike their weights settle slowly, and must all the same: two in five are likelier by e on the last rung, the
  // rest by e^(1/2) on the first. With weight w on the last the mean of ln(1 + w (e - 1)) and ln(e^(1/2) + w (1 - e^(1/2))) is largest at
  // w = 2/5 / (e^(1/2) - 1) * e^(1/2) - 3/5 / (e - 1).
  camera::Rungs late{}, early{};
  late.fill(-1000), early.fill(-1000);
  late.front() = 0, late.back() = 1, early.front() = 0.5, early.back() = 0;
  const double e = std::exp(1.0), root = std::exp(0.5), w = 0.4 * root / (root - 1) - 0.6 / (e - 1);
  const std::vector<double> mixed = camera::averaged_over_ladder({late, early, early, late, early});
  CHECK(mixed[0] == Approx(std::log(1 + w * (e - 1))).margin(0.03));
  CHECK(mixed[1] == Approx(std::log(root + w * (1 - root))).margin(0.03));
  // Where all rungs serve a stretch equally well, the weights do not matter.
  camera::Rungs any;
  any.fill(-7);
  CHECK(camera::averaged_over_ladder({any, low, low})[0] == Approx(-7));
}
