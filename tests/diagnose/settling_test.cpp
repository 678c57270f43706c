// What all of a bank's simulations share while they are not steady yet is found by all of them together.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "made_up_study.hpp"
#include "studies/emulate/random.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

constexpr int kSteps = 300;

/// One run's centre of mass about −30 mm, with `chance` mm of scatter of its own that lasts, and `excess` mm that decays within a twentieth
/// of the analysed time 1 … 4 s.
void write_run(const std::filesystem::path& folder, double chance, double excess, emulate::Random& random) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "summary.json") << R"({"window_s": [1, 4]})";
  std::ofstream out(folder / "series.csv");
  out << "time_s,com_x_m,com_y_m,translational_energy_J,rotational_energy_J\n";
  const double own = chance * random.normal();
  double wandering = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 4.0 * i / kSteps, since = std::max(0.0, t - 1);
    wandering = 0.95 * wandering + 0.3 * chance * random.normal();
    const double x = -30 + own + wandering + excess * std::exp(-since / 0.15);
    out << fmt::format("{:.17g},{:.17g},{:.17g},1e-3,1e-4\n", t, 1e-3 * x, -0.02);
  }
}

/// A bank of runs in both fitted conditions, of which the second one starts late enough.
Bank bank_of(const Scratch& scratch, int runs, double excess, std::uint64_t seed) {
  emulate::Random random(seed, 0);
  Bank bank;
  bank.conditions = {0, 1};
  bank.points.resize(static_cast<std::size_t>(runs));
  for (int r = 0; r < runs; ++r) {
    bank.runs.emplace_back();
    bank.seen.emplace_back(2, calibrate::Observation{});
    for (const int c : {0, 1}) {
      bank.runs.back().push_back(scratch.path / fmt::format("{}_{}_{}", seed, r, c));
      write_run(bank.runs.back().back(), 0.5, c == 0 ? excess : 0, random);
    }
  }
  return bank;
}

}  // namespace

TEST_CASE("what is left of the start in all runs of a bank is told") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  const std::vector<std::string> told = unsettled(q, bank_of(folder, 60, 1.5, 1));
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Contains(q.study.conditions[0].name) && Contains("centre of mass x") && Contains("time.analyze_from_s"));
}

TEST_CASE("chance of runs is not taken for a start") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  for (const std::uint64_t seed : {2, 3, 4, 5}) CHECK(unsettled(q, bank_of(folder, 40, 0, seed)).empty());
}

TEST_CASE("runs that are not there, or have failed, tell nothing of their start") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  Bank bank = bank_of(folder, 60, 1.5, 6);
  for (auto& point : bank.seen) point[0].reset();
  CHECK(unsettled(q, bank).empty());
  for (auto& point : bank.runs) point.assign(2, folder.path / "nowhere");
  CHECK(unsettled(q, bank).empty());
}
