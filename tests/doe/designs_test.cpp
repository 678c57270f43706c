// Plans of runs.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "studies/doe/sequences.hpp"
#include "support.hpp"

using namespace doe_test;
using Catch::Matchers::WithinAbs;

TEST_CASE("a full factorial stands in standard order and is orthogonal") {
  const Design d = two_level(factors(3), {}, 2);
  CHECK(d.resolution == "full");
  CHECK(d.aliases.empty());
  REQUIRE(d.coded.rows() == 10);
  CHECK(d.coded.row(0) == Eigen::RowVector3d(-1, -1, -1));
  CHECK(d.coded.row(1) == Eigen::RowVector3d(1, -1, -1));
  CHECK(d.coded.row(7) == Eigen::RowVector3d(1, 1, 1));
  CHECK((d.coded.transpose() * d.coded) == Eigen::MatrixXd(8 * Eigen::Matrix3d::Identity()));
  CHECK(d.kind[7] == "factorial");
  CHECK(d.kind[8] == "centre");
  CHECK(d.coded.row(9).isZero());
}

TEST_CASE("fractions: resolution and aliases of textbook plans") {
  const Design half = two_level(factors(3), {"C=A*B"}, 0);  // Montgomery 2013, ch. 8
  CHECK(half.resolution == "III");
  CHECK(half.aliases == std::vector<std::string>{"A = B*C", "B = A*C", "C = A*B"});
  const Design turned = two_level(factors(3), {"C=-A*B"}, 0);
  CHECK(turned.aliases == std::vector<std::string>{"A = -B*C", "B = -A*C", "C = -A*B"});
  CHECK(turned.coded.col(2) == -half.coded.col(2));
  const Design quarter = two_level(factors(6), {"E=A*B*C", "F=B*C*D"}, 0);  // 2^(6-2), IV
  CHECK(quarter.coded.rows() == 16);
  CHECK(quarter.resolution == "IV");
  CHECK(quarter.aliases ==
        std::vector<std::string>{"A*B = C*E", "A*C = B*E", "A*D = E*F", "A*E = B*C = D*F", "A*F = D*E", "B*D = C*F", "B*F = C*D"});
  CHECK(two_level(factors(5), {"E=A*B*C*D"}, 0).resolution == "V");
  CHECK(two_level(factors(7), {"D=A*B", "E=A*C", "F=B*C", "G=A*B*C"}, 0).coded.rows() == 8);
}

TEST_CASE("generators that make no plan are refused") {
  const auto message = [](std::vector<std::string> generators) { return refusal([&] { two_level(factors(4), generators, 0); }); };
  CHECK(message({"D=A*X"}).find("'X' is no factor") != std::string::npos);
  CHECK(message({"D"}).find("MADE=PRODUCT") != std::string::npos);
  CHECK(message({"D=A*B", "D=A*C"}).find("made twice") != std::string::npos);
  CHECK(message({"C=A*B", "D=A*C"}).find("a generator makes") != std::string::npos);
  CHECK(message({"D=A*A"}).find("twice in the product") != std::string::npos);
  CHECK(message({"D=D"}).find("a generator makes") != std::string::npos);
  CHECK(message({"D=A"}).find("A*D") != std::string::npos);
  CHECK(message({"C=A*B", "D=A*B"}).find("C*D") != std::string::npos);
  CHECK(refusal([] { two_level(factors(17), {}, 0); }).find("2^17 runs") != std::string::npos);
}

TEST_CASE("factors that make no plan are refused") {
  const auto message = [](std::vector<Factor> list) { return refusal([&] { two_level(list, {}, 0); }); };
  CHECK(message({}).find("no factors") != std::string::npos);
  CHECK(message({{"A", 0, 1, ""}, {"A", 0, 1, ""}}).find("stands twice") != std::string::npos);
  CHECK(message({{"A", 0, 0, ""}}).find("high level") != std::string::npos);
  CHECK(message({{"A*B", 0, 1, ""}}).find("'*'") != std::string::npos);
  CHECK(refusal([] { central_composite(factors(2), -1, 3); }).find("axial distance") != std::string::npos);
  CHECK(refusal([] { central_composite(factors(1), 1, 3); }).find("at least two") != std::string::npos);
}

TEST_CASE("a rotatable composite predicts equally well in all directions") {
  const Design d = central_composite(factors(2), rotatable(2), 5);
  CHECK(d.coded.rows() == 13);
  CHECK_THAT(rotatable(2), WithinAbs(std::sqrt(2.0), 1e-12));
  Eigen::VectorXd response = d.coded.col(0).array().square() + d.coded.col(1).array().cube();  // anything that leaves a residual
  const Surface s = fit_surface(d, response);
  const double along = standard_error_at(s, Eigen::Vector2d(1.2, 0));
  for (double angle = 0.1; angle < 6; angle += 0.7)
    CHECK_THAT(standard_error_at(s, 1.2 * Eigen::Vector2d(std::cos(angle), std::sin(angle))), WithinAbs(along, 1e-12));
  CHECK(central_composite(factors(3), kFaceCentred, 1).coded.cwiseAbs().maxCoeff() == 1);
}

TEST_CASE("a Latin hypercube has one run in each layer, whatever the seed, and keeps its distances") {
  const Design d = latin_hypercube(factors(3), 20, 7);
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::set<int> layers;
    for (Eigen::Index run = 0; run < 20; ++run) layers.insert(static_cast<int>((d.coded(run, i) + 1) * 10));
    CHECK(layers.size() == 20);
  }
  CHECK(latin_hypercube(factors(3), 20, 7).coded == d.coded);
  CHECK(latin_hypercube(factors(3), 20, 8).coded != d.coded);
  double least = 10;
  for (Eigen::Index a = 0; a < 20; ++a) {
    for (Eigen::Index b = 0; b < a; ++b) least = std::min(least, (d.coded.row(a) - d.coded.row(b)).norm());
  }
  CHECK(least > 0.35);  // a single draw keeps 0.2 on average
}

TEST_CASE("Sobol's points are the known ones and fill the box") {
  const Eigen::MatrixXd u = sobol_points(3, 2);
  CHECK(u.row(0) == Eigen::RowVector2d(0.5, 0.5));
  CHECK(u.row(1) == Eigen::RowVector2d(0.75, 0.25));
  CHECK(u.row(2) == Eigen::RowVector2d(0.25, 0.75));
  const Design d = sobol(factors(4), 127);  // with the corner left out, 2^7 − 1 points have each layer of 1/128 but the first once
  for (Eigen::Index i = 0; i < 4; ++i) {
    std::set<int> layers;
    for (Eigen::Index run = 0; run < 127; ++run) layers.insert(static_cast<int>((d.coded(run, i) + 1) * 64));
    CHECK(layers.size() == 127);
    CHECK(layers.count(0) == 0);
  }
}

TEST_CASE("coded and natural values are two sides of one point") {
  const auto list = factors(3);
  const Eigen::VectorXd point = Eigen::Vector3d(-1, 0.5, 1.4);
  CHECK(natural(list, point).isApprox(Eigen::Vector3d(-2, 11, 22.8)));
  CHECK(coded(list, natural(list, point)).isApprox(point));
}
