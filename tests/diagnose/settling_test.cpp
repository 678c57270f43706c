// What all of a bank's simulations share while they are not steady yet is found by all of them together.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "kernel/base/random.hpp"
#include "made_up_study.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::Matchers::Contains;
using testing::Scratch;

namespace {

constexpr int kSteps = 600;

/// What all runs of a condition share, mm.
struct Shared {
  double start = 0;   ///< decays within a twentieth of the analysed time
  double ripple = 0;  ///< once a turn, all the time
  double speed = 8;   ///< rad/s: the analysed time 1 … 4 s is nearly four turns
};

/// One run's centre of mass about −30 mm, with 0.5 mm of scatter of its own.
void write_run(const std::filesystem::path& folder, const Shared& shared, base::RandomStream& random) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "summary.json") << fmt::format(R"({{"window_s": [1, 4], "mill_speed_rad_per_s": {}}})", -shared.speed);
  std::ofstream out(folder / "series.csv");
  out << "time_s,com_x_m,com_y_m,translational_energy_J,rotational_energy_J\n";
  const double own = 0.5 * random.normal();
  double wandering = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 4.0 * i / kSteps, since = std::max(0.0, t - 1);
    wandering = 0.95 * wandering + 0.15 * random.normal();
    const double x = -30 + own + wandering + shared.start * std::exp(-since / 0.15) + shared.ripple * std::sin(shared.speed * t);
    out << fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},1e-4\n", t, 1e-3 * x, -0.02 + 1e-4 * random.normal(),
                       1e-3 + 1e-5 * random.normal());
  }
}

/// A bank of runs in both fitted conditions, of which the first one shares something.
Bank bank_of(const Scratch& scratch, int runs, const Shared& shared, std::uint64_t seed) {
  base::RandomStream random(seed, 0);
  Bank bank;
  bank.conditions = {0, 1};
  bank.points.resize(static_cast<std::size_t>(runs));
  for (int r = 0; r < runs; ++r) {
    bank.runs.emplace_back();
    bank.seen.emplace_back(2, calibrate::Observation{});
    for (const int c : {0, 1}) {
      bank.runs.back().push_back(scratch.path / fmt::format("{}_{}_{}", seed, r, c));
      write_run(bank.runs.back().back(), c == 0 ? shared : Shared{}, random);
    }
  }
  return bank;
}

}  // namespace

TEST_CASE("what is left of the start in all runs of a bank is told") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  const Bank bank = bank_of(folder, 60, {3, 0}, 1);
  const std::vector<std::string> told = unsettled(q, bank, {0, 1});
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Contains(q.study.conditions[0].name) && Contains("centre of mass x") && Contains("mm") && Contains("mean of 60") &&
                          Contains("time.analyze_from_s"));
  // Files that were damaged tell nothing and end nothing.
  std::ofstream(bank.runs[3][0] / "summary.json") << R"({"window_s": [null, null]})";
  std::ofstream(bank.runs[4][0] / "summary.json") << "{";
  std::ofstream(bank.runs[5][0] / "series.csv", std::ios::app) << "1,2\n";
  std::ofstream(bank.runs[6][0] / "series.csv") << "time_s\n0\n1\n";
  std::filesystem::remove_all(bank.runs[7][0]);
  const std::vector<std::string> still = unsettled(q, bank, {0, 1});
  REQUIRE(still.size() == 1);
  CHECK_THAT(still[0], Contains("mean of 55"));
}

TEST_CASE("two turns are enough to tell the start, fewer are not") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  CHECK(unsettled(q, bank_of(folder, 60, {3, 0, 4.25}, 9), {0, 1}).size() == 1);
  CHECK(unsettled(q, bank_of(folder, 60, {3, 0, 4.1}, 10), {0, 1}).empty());
  CHECK(unsettled(q, bank_of(folder, 60, {0, 2, 4.25}, 11), {0, 1}).empty());
}

TEST_CASE("chance of runs, or a ripple, is not taken for a start") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  for (const std::uint64_t seed : {2, 3, 4, 5}) CHECK(unsettled(q, bank_of(folder, 40, {}, seed), {0, 1}).empty());
  CHECK(unsettled(q, bank_of(folder, 40, {0, 2}, 6), {0, 1}).empty());
}

TEST_CASE("runs with an effect, that failed or are too few tell nothing of their start") {
  const Scratch folder;
  const Question q = question_of(folder, "");
  CHECK(unsettled(q, bank_of(folder, 20, {3, 0}, 7), {0, 1}).empty());
  Bank failed = bank_of(folder, 60, {3, 0}, 8), with = failed;
  for (auto& point : failed.seen) point[0].reset();
  CHECK(unsettled(q, failed, {0, 1}).empty());
  for (BankPoint& point : with.points) point.active = {{0, 0.5}};
  CHECK(unsettled(q, with, {0, 1}).empty());
}
