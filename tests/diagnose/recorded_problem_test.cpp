// Recordings as numbers with errors: what simulations tell of these errors, and what the recording.
#include "studies/diagnose/verdict/recorded_problem.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>

#include "made_up_study.hpp"

using namespace millscope;
using namespace millscope::diagnose;
using namespace millscope::naming;
using Catch::WithinRel;
using testing::Scratch;

namespace {

constexpr double kOwn = 0.02;       // variance of every number of the recording, by resampling
constexpr double kBlocks = 41;      // of the recording
const double kStudent = 40.0 / 38;  // few_blocks_factor of them

/// Number 0 is not resampled. Of the others the simulations have some correlation.
MatrixXd correlated(Index n, double correlation) {
  MatrixXd out = MatrixXd::Constant(n, n, correlation) + (1 - correlation) * MatrixXd::Identity(n, n);
  out.row(0).setZero(), out.col(0).setZero();
  return out;
}

struct Recorded {
  Scratch folder;
  Question question = question_of(folder, "hypotheses: {rolling_resistance: {}}\n");
  MadeUpMill mill{question, {}, {}};
  Evidence evidence = mill.evidence();
  Bank bank;
  calibrate::Observation& recording = evidence.recorded[0];
  Index size = recording.value.size();

  Recorded() {
    std::vector<BankPoint> points = plan_group(question, {}, 24);
    points.push_back({"with", 0, points[0].theta, {{0, 1}}});
    bank = fill_bank(question, mill.machinery(), evidence, points, {0});
    simulations_have(correlated(size, 0.9));
    recording.blocks = kBlocks, recording.resampled = kOwn * correlated(size, 0.9);
    recording.covariance = kStudent * recording.resampled;
    recording.covariance(0, 0) = 7;  // of a meter
  }
  /// Long and short ones alike; one with a candidate scatters otherwise, and is not asked.
  void simulations_have(const MatrixXd& one) {
    for (std::size_t p = 0; p < bank.points.size(); ++p)
      bank.seen[p][0]->resampled =
          (p % 2 == 0 ? 0.01 : 0.0025) * (bank.points[p].active.empty() ? one : MatrixXd(50 * correlated(size, 0)));
  }
  naming::Problem problem() const { return problem_of(question, evidence, bank, {0}); }
};

}  // namespace

TEST_CASE("errors of tracks are correlated as simulations are, and all together as large as the recording's own") {
  Recorded r;
  r.recording.resampled(1, 2) = r.recording.resampled(2, 1) = 0.95 * kOwn;  // by chance
  r.recording.covariance(4, 4) += 2;                                        // an axis
  const naming::Problem p = r.problem();
  const double size = p.covariance(2, 2);  // in which that chance has a small part
  CHECK_THAT(size, WithinRel(kOwn, 0.01));
  CHECK_THAT(p.covariance(1, 2), WithinRel(0.9 * size, 1e-9));
  CHECK_THAT(p.covariance(1, 4), WithinRel(0.9 * size, 1e-9));
  CHECK_THAT(p.covariance(4, 4), WithinRel(size + 2, 1e-9));
  CHECK_THAT(Recorded().problem().covariance(2, 2), WithinRel(kOwn, 1e-9));
  CHECK(p.covariance(0, 1) == 0);
  CHECK(p.covariance(0, 0) >= 7);
  REQUIRE(p.sizes.size() == 1);
  std::vector<Index> resampled;  // not the meter's power, nor what the axis makes unsure
  for (Index i = 1; i < r.size; ++i) {
    if (i != 4) resampled.push_back(i);
  }
  CHECK(p.sizes[0].observables == resampled);
  CHECK_THAT(p.sizes[0].degrees, WithinRel((kBlocks - 1) * static_cast<double>(r.size - 1) / 3, 1e-9));
}

TEST_CASE("the size is that of most directions, whatever the recording's chance in a slow one does to every number") {
  Recorded r;
  r.recording.resampled += 0.3 * kOwn * correlated(r.size, 1);  // every variance 1.3 times as large, by one direction
  const MatrixXd c = r.problem().covariance;
  CHECK_THAT(c(2, 2) + c(3, 3) - 2 * c(2, 3), WithinRel(0.2 * kOwn, 0.05));
  CHECK(c(2, 2) < 1.1 * kOwn);
}

TEST_CASE("where the recording surely has more error than simulations its own counts") {
  Recorded r;
  MatrixXd never = correlated(r.size, 0.9);
  never.row(5).setZero(), never.col(5).setZero();  // no simulated bead is ever seen there
  r.simulations_have(never);
  r.recording.resampled.row(5).setZero(), r.recording.resampled.col(5).setZero();
  r.recording.resampled(5, 5) = kOwn;
  CHECK_THAT(r.problem().covariance(5, 5), WithinRel(kOwn, 1e-9));
  // A camera that wanders: what simulated beads know ten times better than each number, the recording does not.
  Recorded steady, wanders;
  VectorXd wander = VectorXd::Zero(r.size);
  wander[6] = 1, wander[7] = -1;
  wanders.recording.resampled += kOwn * wander * wander.transpose();
  CHECK(wander.dot(steady.problem().covariance * wander) < 0.3 * kOwn);
  CHECK(wander.dot(wanders.problem().covariance * wander) > 0.9 * wander.dot(wanders.recording.resampled * wander));
  wanders.recording.resampled += 99 * kOwn * wander * wander.transpose();  // whatever one direction has, the others stay as they are
  VectorXd other = VectorXd::Zero(wanders.size);
  other[2] = 1, other[3] = -1;
  CHECK_THAT(other.dot(wanders.problem().covariance * other), WithinRel(other.dot(steady.problem().covariance * other), 0.05));
}

TEST_CASE("of few blocks the size is as unsure as one direction is") {
  Recorded r;
  r.recording.blocks = 10;
  CHECK(r.problem().sizes.at(0).degrees == 9);
}

TEST_CASE("a number that is compared twice leaves the covariance positive definite") {
  Recorded r;
  MatrixXd twice = correlated(r.size, 0.9);
  twice.row(7) = twice.row(6), twice.col(7) = twice.col(6);
  r.simulations_have(twice);
  r.recording.resampled = kOwn * twice;
  CHECK(r.problem().covariance.llt().info() == Eigen::Success);
}

TEST_CASE("errors that are stated stay as they are, and their size is known") {
  Recorded r;
  SECTION("of a velocity profile") { r.recording.bead_seconds = 0; }
  SECTION("where no simulation can tell") { r.bank.seen.assign(r.bank.seen.size(), {std::nullopt}); }
  naming::Problem p;
  p.alternatives = alternatives_of(r.question);
  add_recorded(r.question, r.evidence, r.bank, {0}, p);
  CHECK(p.covariance(4, 4) == r.recording.covariance(4, 4));
  CHECK(p.covariance(1, 2) == r.recording.covariance(1, 2));
  CHECK(p.sizes.empty());
}

TEST_CASE("what was seen of some points under other conditions stands beside the same points") {
  Recorded r;
  const std::vector<BankPoint> some = plan_group(r.question, {}, 3);
  const Bank other = fill_bank(r.question, r.mill.machinery(), r.evidence, some, {1});
  const Bank both = joined(r.bank, other);
  CHECK(both.conditions == std::vector<std::size_t>{0, 1});
  for (std::size_t p = 0; p < both.points.size(); ++p) {
    REQUIRE(both.seen[p].size() == 2);
    CHECK(both.seen[p][0] == r.bank.seen[p][0]);
    CHECK(both.seen[p][1].has_value() == (p < 3));
    if (p < 3) CHECK(both.seen[p][1] == other.seen[p][0]);
  }
}
