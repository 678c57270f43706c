// Where to simulate next, against the classical way: a rotatable central composite design and its quadratic.
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <numeric>

#include "studies/emulate/process.hpp"
#include "studies/emulate/sequential.hpp"
#include "support.hpp"

using namespace millscope::emulate;
using namespace millscope::emulate::test;
using Catch::Matchers::WithinAbs;

namespace {

/// Power and toe of an invented mill: bent in the friction, curved in the restitution; the target is their value at (0.34, 0.55).
VectorXd mill(const VectorXd& x) { return VectorXd{{30 * std::tanh(4 * x[0]) + 2 * x[1], 1.5 * std::exp(-3 * x[0]) + 0.8 * x[1] * x[1]}}; }
const VectorXd kTruth{{0.34, 0.55}};
const Box kBox{VectorXd{{0.05, 0.3}}, VectorXd{{0.75, 0.9}}, {}, {"friction", "restitution"}};

/// |Δ power| in W + a hundred times |Δ toe|, with the kinks of the study's own objective.
double objective(const VectorXd& y) { return std::abs(y[0] - mill(kTruth)[0]) + 100 * std::abs(y[1] - mill(kTruth)[1]); }

constexpr double kNoise = 0.01;

void append(Training& t, const VectorXd& point, millscope::base::RandomStream& random) {
  const Index n = t.input.rows();
  t.input.conservativeResize(n + 1, Eigen::NoChange);
  t.output.conservativeResize(n + 1, Eigen::NoChange);
  t.noise_variance.conservativeResize(n + 1, Eigen::NoChange);
  t.input.row(n) = point.transpose();
  t.output.row(n) = (mill(point) + kNoise * random.normals(2)).transpose();
  t.noise_variance.row(n).setConstant(kNoise * kNoise);
}

/// 4 corners, 4 axial points at √2, 5 in the centre: 13 runs; then the smallest value of the fitted quadratic in the box.
double composite_design(std::uint64_t seed) {
  millscope::base::RandomStream random(seed);
  const double a = 1 / std::sqrt(2.0);
  const std::vector<VectorXd> coded = {VectorXd{{-a, -a}}, VectorXd{{a, -a}}, VectorXd{{-a, a}}, VectorXd{{a, a}}, VectorXd{{-1, 0}},
                                       VectorXd{{1, 0}},   VectorXd{{0, -1}}, VectorXd{{0, 1}},  VectorXd{{0, 0}}, VectorXd{{0, 0}},
                                       VectorXd{{0, 0}},   VectorXd{{0, 0}},  VectorXd{{0, 0}}};
  MatrixXd terms(13, 6);
  VectorXd values(13);
  for (std::size_t i = 0; i < coded.size(); ++i) {
    const auto row = static_cast<Index>(i);
    terms.row(row) = trend_terms(Trend::quadratic, coded[i]).transpose();
    values[row] = objective(mill(kBox.natural(coded[i])) + kNoise * random.normals(2));
  }
  const VectorXd beta = terms.colPivHouseholderQr().solve(values);
  VectorXd best = VectorXd::Zero(2);
  double least = INFINITY;
  for (double u = -1; u <= 1; u += 0.01) {
    for (double v = -1; v <= 1; v += 0.01) {
      if (const double value = trend_terms(Trend::quadratic, VectorXd{{u, v}}).dot(beta); value < least) {
        least = value;
        best << u, v;
      }
    }
  }
  return objective(mill(kBox.natural(best)));
}

}  // namespace

TEST_CASE("expected improvement reaches the optimum with fewer runs than a composite design and its quadratic") {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Training training = runs_of(mill, latin(kBox, 6, seed), kNoise, seed);
    millscope::base::RandomStream random(seed, 9);
    while (training.input.rows() < 11) {
      const Emulator emulator = Emulator::fit(kBox, training);
      append(training, next_point(emulator, kBox, objective, seed), random);
    }
    const Optimum found = minimise(Emulator::fit(kBox, training), kBox, objective, seed);
    INFO("seed " << seed << ": 11 runs to " << objective(mill(found.point)) << ", 13 of the composite design to "
                 << composite_design(seed));
    CHECK(objective(mill(found.point)) < 0.5 * composite_design(seed));
    CHECK_THAT(found.point[0], WithinAbs(kTruth[0], 0.02));
    CHECK_THAT(found.point[1], WithinAbs(kTruth[1], 0.05));
  }
}

TEST_CASE("a point with an improvement in sight is better than one without") {
  const Training training = runs_of(mill, latin(kBox, 12, 1), kNoise, 1);
  const Emulator emulator = Emulator::fit(kBox, training);
  const VectorXd next = next_point(emulator, kBox, objective, 1);
  CHECK(kBox.contains(next));
  CHECK(expected_improvement(emulator, kBox, objective, next, 1) >
        expected_improvement(emulator, kBox, objective, VectorXd{{0.7, 0.9}}, 1));
  CHECK(expected_improvement(emulator, kBox, objective, next, 1) >= 0.99 * expected_improvement(emulator, kBox, objective, kTruth, 1));
  CHECK(next == next_point(emulator, kBox, objective, 1));
}

TEST_CASE("the misfit of a recording leads to its parameters, and the implausible is told from the plausible") {
  const Observed observed{mill(kTruth), MatrixXd{{0.04, 0}, {0, 1e-4}}};
  Training training = runs_of(mill, latin(kBox, 8, 2), kNoise, 2);
  millscope::base::RandomStream random(2);
  for (int i = 0; i < 4; ++i) append(training, next_point(Emulator::fit(kBox, training), kBox, observed, 5), random);
  const Emulator emulator = Emulator::fit(kBox, training);
  CHECK(implausibility(emulator, observed, kTruth) < 1.5);
  CHECK(implausibility(emulator, observed, VectorXd{{0.1, 0.4}}) > 3);
  double nearest = INFINITY;
  for (Index i = 8; i < 12; ++i) nearest = std::min(nearest, (training.input.row(i).transpose() - kTruth).norm());
  CHECK(nearest < 0.05);
}

TEST_CASE("points for several cores are not the same point") {
  const Emulator emulator = Emulator::fit(kBox, runs_of(mill, latin(kBox, 8, 3), kNoise, 3));
  const std::vector<VectorXd> points = next_points(emulator, kBox, objective, 3, 1);
  REQUIRE(points.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < i; ++j) CHECK((kBox.coded(points[i]) - kBox.coded(points[j])).norm() >= 0.04);
  }
  const Emulator believed = emulator.believing(points[0]);
  CHECK_THAT(believed.at(points[0]).mean[0], WithinAbs(emulator.at(points[0]).mean[0], 1e-6));
  CHECK(believed.at(points[0]).variance[0] < emulator.at(points[0]).variance[0]);
}

TEST_CASE("only allowed points are proposed") {
  Box box = kBox;
  box.allowed = [](const VectorXd& x) { return x[0] > 0.5; };  // the optimum is forbidden
  const Emulator emulator = Emulator::fit(kBox, runs_of(mill, latin(kBox, 15, 4), kNoise, 4));
  CHECK(next_point(emulator, box, objective, 1)[0] > 0.5);
  CHECK_THAT(minimise(emulator, box, objective, 1).point[0], WithinAbs(0.5, 0.02));
}
