// The error rate of the comparison where truth is known: false alarms when nothing differs, power when something does.
#include "studies/compare/family_test.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "millscope/observation_adapter.hpp"
#include "simulated.hpp"

using namespace millscope;
using compare_test::Design;
using compare_test::simulate;

namespace {

double smallest_p(const std::vector<compare::ObservableVerdict>& verdicts) {
  double p = 1;
  for (const compare::ObservableVerdict& v : verdicts) p = std::min(p, v.adjusted_p);
  return p;
}

/// Of `repeats` comparisons without any difference, how many find one at 5 %.
int false_alarms(const Design& design, int repeats, std::uint64_t seed) {
  int alarms = 0;
  for (int i = 0; i < repeats; ++i)
    alarms += smallest_p(compare::judge(simulate(design, seed + static_cast<std::uint64_t>(i)), 0.9, 2000)) <= 0.05 ? 1 : 0;
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

TEST_CASE("a difference that is there is found and placed") {
  int number = 0, cell = 0, elsewhere = 0;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto verdicts =
        compare::judge(simulate({.shift = {.scalar = 1.3, .cell = 2.2}}, 9000 + i), 0.9, 3000);  // 5.8 and 9.8 standard errors
    number += verdicts[0].adjusted_p <= 0.05 ? 1 : 0;
    const compare::ObservableVerdict& map = verdicts[compare_test::kMapObservable];
    const std::size_t column = map.strongest % compare_test::kMapSide, row = map.strongest / compare_test::kMapSide;
    cell += map.adjusted_p <= 0.05 && column >= 5 && column <= 6 && row <= 1 ? 1 : 0;
    for (std::size_t o = 1; o < compare_test::kMapObservable; ++o) elsewhere += verdicts[o].adjusted_p <= 0.05 ? 1 : 0;
  }
  INFO(number << " numbers, " << cell << " cells, " << elsewhere << " elsewhere");
  CHECK(number >= 19);
  CHECK(cell >= 19);
  CHECK(elsewhere <= 4);  // 5 % of 20 comparisons is 1
}

TEST_CASE("equal seeds do not make two sources look alike") {
  // The same resamples of blocks in both: paired draw by draw their difference would vanish.
  compare::TestedObservable o;
  o.difference = {3}, o.error_a = o.error_b = {1}, o.blocks_a = o.blocks_b = {40};
  millscope::Random random(3);
  for (int r = 0; r < 200; ++r) o.draws_a.push_back(static_cast<float>(random.normal()));
  o.draws_b = o.draws_a;
  const compare::ObservableVerdict v = compare::judge({o}, 0.9)[0];
  CHECK(v.p > 0.01);  // 3 of an error of √2
  CHECK(v.p < 0.1);
}

TEST_CASE("few blocks make intervals wide and deviates small") {
  CHECK(compare::degrees_of_freedom(1, 10, 1, 10) == Approx(18));
  CHECK(compare::degrees_of_freedom(1, 10, 0, 500) == Approx(9));
  CHECK(compare::normal_deviate(1.96, 1e7) == Approx(1.96).epsilon(1e-4));
  CHECK(compare::normal_deviate(2.262157, 9) == Approx(1.959964).epsilon(1e-5));
  CHECK(compare::normal_deviate(1e6, 50) > 20);
}
