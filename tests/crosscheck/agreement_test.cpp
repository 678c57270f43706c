#include "studies/crosscheck/agreement.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "kernel/base/random.hpp"

namespace millscope::crosscheck {
namespace {

using Runs = std::vector<std::vector<Quantity>>;

Runs runs_of(const std::string& name, const std::vector<double>& values) {
  Runs runs;
  for (const double v : values) runs.push_back({{name, "m", v}});
  return runs;
}

std::vector<Compared> compared(const Runs& ours, const Runs& theirs) { return agreement(ours, theirs, {}); }

}  // namespace

TEST_CASE("a difference has the error of the starts' differences, not of the starts") {
  // Differences 1, 2, 3: mean 2, error 1/√3, t = 3.464 with 2 degrees of freedom: p = 0.0742 (table of t).
  const Compared c = compared(runs_of("speed", {10, 20, 30}), runs_of("speed", {11, 22, 33}))[0];
  CHECK(c.difference.value == Approx(2));
  CHECK(c.difference.error == Approx(1 / std::sqrt(3)));
  CHECK(c.p == Approx(0.0742).epsilon(0.001));
  CHECK(c.ours.error == Approx(10 / std::sqrt(3)));
  CHECK_FALSE(c.limit);
}

TEST_CASE("a limit is kept, broken or not resolved, and few starts have to be surer") {
  // The centre's limit is 0.3 mm. Six starts: 97.5 % point of t with 5 degrees of freedom 2.571.
  const auto centre = [](double difference, double spread) {
    std::vector<double> theirs;
    for (const double sign : {-1, 1, -1, 1, -1, 1}) theirs.push_back(difference + sign * spread);
    return compared(runs_of(kCentre[1], std::vector<double>(6, 0.0)), runs_of(kCentre[1], theirs))[0];
  };
  const double error = 1e-5 * std::sqrt(6.0 / 5.0 / 6.0);  // of a spread of 0.01 mm
  CHECK(centre(0.3e-3 - 2.58 * error, 1e-5).judgement == Judgement::agree);
  CHECK(centre(0.3e-3 - 2.56 * error, 1e-5).judgement == Judgement::unresolved);
  CHECK(centre(-(0.3e-3 + 2.56 * error), 1e-5).judgement == Judgement::unresolved);
  CHECK(centre(-(0.3e-3 + 2.58 * error), 1e-5).judgement == Judgement::differ);
  // A third of the limit's distance left: nine times the reach squared.
  const double far = 3 * 0.2e-3 / 2.5706 / std::sqrt(6.0 / 5.0 / 6.0);
  CHECK(centre(0.1e-3, far).seeds_needed == Approx(9 * 6).epsilon(1e-4));
  CHECK(centre(0.5e-3, far).seeds_needed == Approx(9 * 6).epsilon(1e-4));
}

TEST_CASE("limits of power and energy are parts of our value") {
  const Compared power = compared(runs_of(kPowerByCentre, {-2, -2, -2}), runs_of(kPowerByCentre, {-2, -2, -2}))[0];
  CHECK(*power.limit == Approx(0.01));
  CHECK(power.judgement == Judgement::agree);
  CHECK(power.p == 1);
  CHECK(*compared(runs_of(kTranslation, {3, 3, 3}), runs_of(kTranslation, {3, 3, 3}))[0].limit == Approx(0.03));
}

TEST_CASE("engines that say the same differ in one of twenty tries, all quantities together") {
  constexpr int kTries = 2000, kQuantities = 30, kSeeds = 4;
  base::RandomStream random(7);
  int alarms = 0, real = 0;
  for (int trial = 0; trial < kTries; ++trial) {
    Runs ours, theirs;
    for (int s = 0; s < kSeeds; ++s) {
      ours.emplace_back(), theirs.emplace_back();
      for (int q = 0; q < kQuantities; ++q) {
        const double start = random.normal();  // both begin at the same places
        ours.back().push_back({std::to_string(q), "1", start + random.normal()});
        theirs.back().push_back({std::to_string(q), "1", start + random.normal()});
      }
    }
    const auto any = [&](double& smallest) {
      for (const Compared& c : compared(ours, theirs)) smallest = std::min(smallest, c.adjusted_p);
    };
    double smallest = 1;
    any(smallest);
    alarms += smallest <= 0.05;
    for (auto& run : theirs) run[3].value += 200;
    smallest = 1;
    any(smallest);
    real += smallest <= 0.05;
  }
  // Holm's level is 5 % at most, and nearly that for independent quantities: 100 ± 10 of 2000.
  CHECK(alarms > 60);
  CHECK(alarms < 131);
  CHECK(real == kTries);
}

}  // namespace millscope::crosscheck
