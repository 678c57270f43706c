// What holds for every analyzer of fields: additivity, one meaning for simulations and recordings, weights by time, both turning senses,
// named axes.
#include <catch2/catch.hpp>
#include <cmath>

#include "analyzers/common/angle.hpp"
#include "analyzers_fields/analyzer.hpp"

using namespace analyzers_test;

namespace {

struct Subject {
  const char *name, *options;
};
constexpr Subject kSubjects[] = {{"pept_grid", ""},
                                 {"pept_grid", "grid=cylindrical"},
                                 {"pept_grid", "grid=xyz cells_x=20 cells_y=20"},
                                 {"pept_grid", "grid=r_theta_z z_from=0.05 z_to=0.2"},
                                 {"distributions", ""},
                                 {"power", ""},
                                 {"models", ""},
                                 {"slip", "lifters=20"},
                                 {"slip", "end_trim=0.05"}};

/// Beads that turn at their own speeds and drift up and down, so that nothing is the same in two places.
Sample wander(std::int64_t id, double t) {
  const double n = static_cast<double>(id), r = 0.02 + 0.012 * n, omega = 5.0 - 0.3 * n;
  const double angle = n + omega * t, drift = 0.01 * std::sin(3 * t + n), rise = 0.03 * std::cos(3 * t + n);
  return {{r * std::cos(angle), r * std::sin(angle) + drift, 0.13 + 0.1 * std::sin(t + n)},
          {-omega * r * std::sin(angle), omega * r * std::cos(angle) + rise, 0.1 * std::cos(t + n)}};
}

constexpr std::int64_t kBeads = 10;

}  // namespace

TEST_CASE("blocks that share a frame of weight zero add up to the whole") {
  const auto subject = GENERATE(from_range(std::begin(kSubjects), std::end(kSubjects)));
  INFO(subject.name << " " << subject.options);
  const Analyzer analyzer(subject.name, study(), subject.options);
  const auto times = even_times(400, 0.004);
  Frames whole = all_beads(wander, kBeads, times, std::vector<double>(400, 0.004), 6);
  for (std::size_t f = 0; f < 400; ++f) whole.work[f] = std::sin(static_cast<double>(f)), whole.lost[f] = static_cast<double>(f * f);
  Frames second = whole;
  for (std::size_t s = 149 * kBeads; s < 150 * kBeads; ++s) second.weight[s] = 0;
  Sums parts = analyzer.zero();
  analyzer.add(whole.block(0, 150), parts);
  analyzer.add(second.block(149), parts);
  Sums once = analyzer.zero();
  analyzer.add(whole.block(), once);
  REQUIRE(parts.size() == once.size());
  for (std::size_t a = 0; a < parts.size(); ++a) {
    for (std::size_t i = 0; i < parts[a].size(); ++i) REQUIRE(parts[a][i] == Approx(once[a][i]).epsilon(1e-12).margin(1e-12));
  }
  CHECK(sum(once[0]) != 0);
}

TEST_CASE("all beads at once mean the same as each bead followed by itself") {
  const auto subject = GENERATE(from_range(std::begin(kSubjects), std::end(kSubjects)));
  INFO(subject.name << " " << subject.options);
  const Analyzer analyzer(subject.name, study(), subject.options);
  const auto times = even_times(500, 0.004);
  const std::vector<double> weights(500, 0.004);
  const Outcome simulation = analyzer.of(all_beads(wander, kBeads, times, weights, 6));
  Sums tracers = analyzer.zero();
  for (std::int64_t bead = 0; bead < kBeads; ++bead) analyzer.add(one_bead(wander, bead, times, weights, 6).block(), tracers);
  CHECK(difference(simulation, analyzer.finish(tracers)) < 1e-9);
}

TEST_CASE("uneven sampling with the right dwell times gives the same fields") {
  const auto subject = GENERATE(from_range(std::begin(kSubjects), std::end(kSubjects)));
  INFO(subject.name << " " << subject.options);
  const Analyzer analyzer(subject.name, study(), subject.options);
  // Every sample of the even track stands for 4 ms; in the uneven one the bead is seen twice as often while t is in the first half.
  const auto even = even_times(1000, 0.004);
  Frames uneven;
  for (std::size_t f = 0; f < even.size(); ++f) {
    const bool dense = f < 500;
    for (int twice = 0; twice < (dense ? 2 : 1); ++twice) {
      uneven.add_sample(3, wander(3, even[f]), dense ? 0.002 : 0.004);
      uneven.end_frame(even[f] + 1e-9 * twice, 6);
    }
  }
  const Outcome expected = analyzer.of(one_bead(wander, 3, even, std::vector<double>(1000, 0.004), 6));
  CHECK(difference(expected, analyzer.of(uneven)) < 1e-9);
}

TEST_CASE("a mill that turns the other way gives the same figures") {
  // Names that change their sign with x or Omega, and those that are mirrored; the rest must be equal.
  const Subject subject = GENERATE(Subject{"pept_grid", "grid=cylindrical"}, Subject{"pept_grid", "grid=r_theta_z"},
                                   Subject{"slip", "lifters=20"}, Subject{"models", ""});
  INFO(subject.name << " " << subject.options);
  const auto times = even_times(500, 0.004);
  const std::vector<double> weights(500, 0.004);
  const Analyzer left(subject.name, study(1), subject.options);
  // The mirror image of a lifter at x is one at −x.
  const Analyzer right(subject.name, study(-1),
                       std::string(subject.options) + (subject.name == std::string("slip") ? " lifter_angle=3.14159265358979" : ""));
  Outcome a = left.of(all_beads(wander, kBeads, times, weights, 6)), b = right.of(all_beads(mirrored(wander), kBeads, times, weights, -6));
  CHECK(difference(a, b) < 1e-9);
}

TEST_CASE("every axis of a result is a result") {
  const auto subject = GENERATE(from_range(std::begin(kSubjects), std::end(kSubjects)));
  INFO(subject.name << " " << subject.options);
  const Outcome outcome = Analyzer(subject.name, study(), subject.options)
                              .of(all_beads(wander, kBeads, even_times(20, 0.01), std::vector<double>(20, 0.01), 6));
  REQUIRE(!outcome.empty());
  for (const auto& [name, found] : outcome) {
    INFO(name);
    CHECK(!found.doc.empty());
    CHECK(!found.unit.empty());
    for (std::size_t i = 0; i < found.shape.size(); ++i) {
      if (found.axes[i].empty()) {
        CHECK(name.find("edges") != std::string::npos);
        continue;
      }
      const std::uint64_t n = values(outcome, found.axes[i]).size();
      CHECK((n == found.shape[i] + 1 || n == found.shape[i]));
    }
  }
}

TEST_CASE("without data results are not numbers, and nothing breaks") {
  const auto subject = GENERATE(from_range(std::begin(kSubjects), std::end(kSubjects)));
  INFO(subject.name << " " << subject.options);
  const Analyzer analyzer(subject.name, study(), subject.options);
  for (const auto& [name, found] : analyzer.finish(analyzer.zero())) {
    for (const double v : found.values) CHECK(!std::isinf(v));
  }
}

TEST_CASE("what a mill is not known to be is refused with the remedy") {
  AnalyzerContext unknown = study();
  unknown.mill_radius = 0;
  for (const char* name : {"pept_grid", "distributions", "power", "models", "slip"}) {
    CHECK_THROWS_WITH(Analyzer(name, unknown), Catch::Contains("mill_diameter"));
  }
  AnalyzerContext still = study();
  still.omega = 0;
  CHECK_THROWS_WITH(Analyzer("power", still), Catch::Contains("direction"));
  CHECK_THROWS_WITH(Analyzer("slip", still), Catch::Contains("direction"));
  CHECK_THROWS_WITH(Analyzer("pept_grid", still, "grid=cylindrical"), Catch::Contains("direction"));
  AnalyzerContext endless = study();
  endless.mill_high = endless.mill_low = 0;
  CHECK_THROWS_WITH(Analyzer("pept_grid", endless, "grid=xyz"), Catch::Contains("z_from"));
  CHECK_THROWS_WITH(Analyzer("pept_grid", endless, "end_trim=0.05"), Catch::Contains("z_from"));
  CHECK_THROWS_WITH(Analyzer("pept_grid", study(), "end_trim=0.14"), Catch::Contains("empty"));
  CHECK_THROWS_WITH(Analyzer("pept_grid", study(), "end_trim=0.05 z_to=0.2"), Catch::Contains("not both"));
  CHECK_THROWS_WITH(Analyzer("pept_grid", study(), "grid=xyz cells_x=2000 cells_y=2000"), Catch::Contains("larger cells"));
  CHECK_THROWS_WITH(Analyzer("slip", study(), "sector_from=1 sector_to=0.5"), Catch::Contains("sector"));
  AnalyzerContext beadless = study();
  beadless.bead_radius = 0;
  CHECK_THROWS_WITH(Analyzer("models", beadless), Catch::Contains("bead_diameter"));
}

TEST_CASE("the quick angle is that of the library, on the axes and between, and never beyond half a turn") {
  using millscope::analyzers::angle_of;
  double largest = 0;
  for (int i = 0; i < 100000; ++i) {
    const double a = 1e-4 * i, y = std::sin(a), x = std::cos(1.7 * a);
    largest = std::max(largest, std::fabs(angle_of(y, x) - std::atan2(y, x)));
  }
  for (const double x : {-2.0, 0.0, 2.0}) {
    for (const double y : {-2.0, -0.0, 0.0, 2.0}) largest = std::max(largest, std::fabs(angle_of(y, x) - std::atan2(y, x)));
  }
  CHECK(largest < 4e-9);
  for (int i = -1000; i <= 1000; ++i) {
    const double angle = angle_of(1e-12 * i, -1.0);
    CHECK(std::fabs(angle) <= 3.14159265358979323846);
  }
  CHECK(std::isnan(angle_of(std::nan(""), 1)));
}
