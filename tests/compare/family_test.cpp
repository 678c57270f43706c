// The error rate of the comparison where truth is known: false alarms when nothing differs, power when something does.
#include "studies/compare/family_test.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "simulated.hpp"

using namespace millscope::studies;
using compare_test::Design;
using compare_test::simulate;

namespace {

double smallest_p(const std::vector<ObservableVerdict>& verdicts) {
  double p = 1;
  for (const ObservableVerdict& v : verdicts) p = std::min(p, v.adjusted_p);
  return p;
}

/// Of `repeats` comparisons without any difference, how many find one at 5 %.
int false_alarms(const Design& design, int repeats, std::uint64_t seed) {
  int alarms = 0;
  for (int i = 0; i < repeats; ++i)
    alarms += smallest_p(judge(simulate(design, seed + static_cast<std::uint64_t>(i)), 0.9, 3000)) <= 0.05 ? 1 : 0;
  return alarms;
}

}  // namespace

TEST_CASE("where nothing differs, one comparison in twenty says that something does") {
  // 463 elements in six observables. Of 200 repeats, 4 to 17 lie in the central 95 % of the binomial distribution at 5 %.
  const int equal = false_alarms({.blocks_a = 40, .blocks_b = 40}, 200, 1000);
  INFO("40 and 40 blocks: " << equal << " of 200");
  CHECK((equal >= 4 && equal <= 17));
  const int few = false_alarms({.blocks_a = 60, .blocks_b = 12}, 200, 5000);
  INFO("60 and 12 blocks: " << few << " of 200");
  CHECK((few >= 4 && few <= 17));
}
