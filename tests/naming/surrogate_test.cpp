// The surrogate of the bank and fits with it, on a mill that is a formula.
#include "studies/diagnose/naming/surrogate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernel/base/random.hpp"
#include "made_up_bank.hpp"
#include "studies/diagnose/naming/covariance.hpp"
#include "studies/diagnose/naming/fit.hpp"

using namespace millscope;
using namespace millscope::naming;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

VectorXd point(double a, double b, double c) { return Eigen::Vector3d(a, b, c); }

}  // namespace

TEST_CASE("the surrogate follows a quadratic mill, and its left-out residuals have the runs' noise") {
  const MadeUp mill;
  const Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, 1);
  const Features features(p.data);
  const Surrogate s(p.data, features, std::vector<bool>(p.data.rows.size(), true));
  const VectorXd error = s.at(point(0.3, 0.1, 0.2), {{0, 0.5}}) - truth_of(mill, point(0.3, 0.1, 0.2), {0.5, 0, 0});
  CHECK(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())) < mill.run_noise);
  CHECK_THAT(std::sqrt(s.residual_covariance(p.covariance).diagonal().mean()), WithinRel(mill.run_noise, 0.15));
}

TEST_CASE("how much more runs with an effect scatter is told without bias, and so is one run's covariance") {
  constexpr int kBanks = 40;
  for (const double chancier : {1.0, 2.0, 5.0}) {
    for (const bool small : {true, false}) {
      MadeUp mill;
      mill.runs = small ? 24 : 48, mill.each = small ? 8 : 16, mill.again = 8, mill.chancier = chancier, mill.run_noise = 0.6;
      double ratio = 0, covariance = 0;
      for (std::uint64_t seed = 1; seed <= kBanks; ++seed) {
        const Problem p = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, 40 + seed);
        const Surrogate s(p.data);
        ratio += s.scatter_of({{0, 1}}) / kBanks;
        covariance += s.residual_covariance(p.covariance).diagonal().mean() / kBanks;
      }
      CAPTURE(chancier, small, ratio, covariance);
      CHECK_THAT(ratio, WithinRel(chancier * chancier, 0.15));
      CHECK_THAT(covariance, WithinRel(mill.run_noise * mill.run_noise, 0.06));
    }
  }
}

TEST_CASE("the surrogate's error is the same whether the noise of the observables is independent or correlated") {
  const auto difference = [](Problem p) {
    const MatrixXd independent = Surrogate(p.data).residual_covariance(p.covariance);
    const Index n = independent.rows();
    MatrixXd mixed = MatrixXd::Zero(n, n);  // every observable shares nine tenths with the one before
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j <= i; ++j) mixed(i, j) = std::pow(0.9, static_cast<double>(i - j));
    }
    p.data.value *= mixed.transpose();
    const MatrixXd correlated = Surrogate(p.data).residual_covariance(mixed * p.covariance * mixed.transpose());
    return (correlated - mixed * independent * mixed.transpose()).norm() / correlated.norm();
  };
  Problem p = made_up_problem({}, point(0, 0, 0), {0, 0, 0}, 1);
  CHECK(difference(p) < 0.1);  // the weights of runs with an effect go by the observables as they are
  std::erase_if(p.data.rows, [](const BankRow& row) { return !row.active.empty(); });
  p.data.value.conservativeResize(static_cast<Index>(p.data.rows.size()), Eigen::NoChange);  // those without come first
  CHECK(difference(p) < 1e-9);
}

TEST_CASE("runs that are repeated tell the chance of runs from what the surface cannot follow") {
  const auto chance = [](double run_noise, double cubic, std::uint64_t seed) {
    MadeUp mill;
    mill.run_noise = run_noise, mill.cubic = cubic, mill.again = 8;
    const Problem p = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, seed);
    return Surrogate(p.data).chance(p.covariance);
  };
  double all = 0, exact = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) all += chance(0.3, 0, seed) / 40, exact += chance(0.03, 1, seed) / 40;
  CHECK(all > 0.65);  // 1 less what eight degrees of freedom leave open
  CHECK(all < 0.95);
  CHECK(exact < 0.1);
  const Problem alone = made_up_problem({}, point(0, 0, 0), {0, 0, 0}, 1);
  const Surrogate s(alone.data);
  CHECK(s.chance(alone.covariance) == 0);
  CHECK(s.error_covariance(alone.covariance)(3, 3) > 1.1 * s.residual_covariance(alone.covariance)(3, 3));
  CHECK(s.error_covariance(alone.covariance)(3, 3) < 1.6 * s.residual_covariance(alone.covariance)(3, 3));
}

TEST_CASE("a run that is left out is predicted without its repeats, with the candidate that is asked for or without any") {
  MadeUp mill;
  mill.run_noise = 0.01, mill.cubic = 1, mill.again = 8;
  const Problem p = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, 3);
  const MatrixXd without = left_out_deviations(p.data, {});
  CHECK(without.rows() == 24 + 8);
  CHECK(left_out_deviations(p.data, 0).rows() == 10);
  const Surrogate s(p.data);  // whose left-out residuals have the repeat still in
  int repeated = 0;
  double alone = 0, beside = 0;
  for (Index a = 0; a < without.rows(); ++a) {
    for (Index b = a + 1; b < without.rows(); ++b) {
      if (!repeats(p.data.rows[static_cast<std::size_t>(a)], p.data.rows[static_cast<std::size_t>(b)])) continue;
      ++repeated;
      CHECK((without.row(a) - without.row(b)).cwiseAbs().maxCoeff() < 0.1);
      alone += without.row(a).squaredNorm(), beside += s.left_out().row(a).squaredNorm();
    }
  }
  CHECK(repeated == 8);
  CHECK(alone > 1.5 * beside);
}

TEST_CASE("two candidates that have runs together are more than their sum, and leave what each does alone as it is") {
  MadeUp mill;
  mill.run_noise = 0.05, mill.each = 16;
  const Problem alone = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, 5);
  Problem both = alone;
  const VectorXd beyond = VectorXd::Constant(both.observed.size(), 3.0);  // what the two do besides at full strength
  base::RandomStream random(8);
  for (int k = 0; k < 16; ++k) {
    const double a = 0.1 + 0.9 * random.uniform(), b = 0.1 + 0.9 * random.uniform();
    const VectorXd u = point(2 * random.uniform() - 1, 2 * random.uniform() - 1, 0);
    const Index row = both.data.value.rows();
    both.data.rows.push_back({both.data.natural(u), {{2, b}, {0, a}}});
    both.data.value.conservativeResize(row + 1, Eigen::NoChange);
    // Together they are chancier: that is no reason to believe the runs of each alone less.
    both.data.value.row(row) = (truth_of(mill, u, {a, 0, b}) + a * b * beyond + 0.5 * random.normals(beyond.size())).transpose();
  }
  const Surrogate one(alone.data), two(both.data);
  const VectorXd u = point(0.2, -0.1, 0);
  const VectorXd more = two.at(u, {{0, 0.8}, {2, 0.5}}) - two.at(u, {{0, 0.8}}) - two.at(u, {{2, 0.5}}) + two.at(u);
  CHECK((more - 0.4 * beyond).norm() < 0.15 * 0.4 * beyond.norm());
  CHECK(two.at(u, {{0, 0.8}, {2, 0.5}}) == two.at(u, {{2, 0.5}, {0, 0.8}}));
  CHECK((two.at(u, {{0, 0.8}}) - one.at(u, {{0, 0.8}})).norm() < 0.1);
  CHECK(two.scatter_of({{0, 0.8}}) < 3);
  CHECK(two.scatter_of({{0, 0.8}, {2, 0.5}}) > 30);
  CHECK_FALSE(Features(alone.data).product(0, 2));
}

TEST_CASE("an effect that begins slowly gets a higher degree, and a faint one its true strength") {
  MadeUp mill;
  mill.each = 16, mill.weakest = 0.1, mill.whole = 1;
  double mean = 0, square = 0;
  constexpr int kMills = 20;
  for (std::uint64_t seed = 1; seed <= kMills; ++seed) {
    Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, seed);
    p.observed = truth_of(mill, point(0.2, -0.3, 0), {0.2, 0, 0});
    const auto strength = [&p] {
      const Surrogate s(p.data);
      const Weighting w(p.covariance, s);
      return Model(p.data, s, w, {{0}, std::vector<StrengthRange>(3)}).fit(p.observed).strengths[0];
    };
    square += strength() / kMills;
    choose_terms(p.data, p.covariance);
    CHECK(p.data.degree[0] > 2);
    mean += strength() / kMills;
  }
  CHECK_THAT(mean, WithinAbs(0.2, 0.02));
  CHECK(std::fabs(square - 0.2) > 0.05);  // without it
}

TEST_CASE("an effect that grows as its strength rarely gets a higher degree, few runs never") {
  MadeUp mill;
  mill.each = 16, mill.weakest = 0.1;
  int higher = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, seed);
    choose_terms(p.data, p.covariance);
    higher += p.data.degree[0] > 2 ? 1 : 0;
  }
  CHECK(higher <= 4);
  mill.whole = 1, mill.each = 11;
  Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, 1);
  choose_terms(p.data, p.covariance);
  CHECK(p.data.degree[0] == 2);
}

TEST_CASE("an effect that is whole before the end of its range needs the fourth power, and runs that allow it") {
  MadeUp mill;
  mill.each = 16, mill.weakest = 0.1, mill.whole = 0.5, mill.run_noise = 0.1;
  Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, 1);
  choose_terms(p.data, p.covariance);
  CHECK(p.data.degree[0] == 4);
  const Index powers = 4, parameters = 2;
  CHECK(Features(p.data).count(0) == powers + parameters);
  std::erase_if(p.data.rows, [kept = 0](const BankRow& row) mutable { return row.candidate() == 0 && ++kept > 8; });
  CHECK(Features(p.data).count(0) == 2 + parameters);  // as in a held-out condition whose runs have failed
}

TEST_CASE("too few runs to leave one out tell nothing") {
  Problem p = made_up_problem({}, point(0, 0, 0), {0, 0, 0}, 1);
  std::erase_if(p.data.rows, [](const BankRow& row) { return !row.active.empty(); });
  const Index coefficients = Features(p.data).size();
  p.data.rows.resize(static_cast<std::size_t>(coefficients + 2));
  p.data.value.conservativeResize(coefficients + 2, Eigen::NoChange);
  CHECK(left_out_deviations(p.data, {}).rows() == coefficients + 2);
  p.data.rows.pop_back();
  p.data.value.conservativeResize(coefficients + 1, Eigen::NoChange);
  CHECK(left_out_deviations(p.data, {}).rows() == 0);
}

TEST_CASE("the error of one prediction covers what it is wrong by") {
  constexpr int kBanks = 40;
  for (const double strength : {0.0, 0.8}) {
    const std::vector<ActiveCandidate> active = strength > 0 ? std::vector<ActiveCandidate>{{0, strength}} : std::vector<ActiveCandidate>{};
    const VectorXd at = point(0.5, -0.6, 0.2);
    double ratio = 0;
    for (std::uint64_t seed = 1; seed <= kBanks; ++seed) {
      MadeUp mill;
      mill.again = 8;
      const Problem p = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, 70 + seed);
      const Surrogate s(p.data);
      const VectorXd error = s.at(at, active) - truth_of(mill, at, {strength, 0, 0});
      const VectorXd variance = s.error_covariance(p.covariance, at, active).diagonal();
      ratio += error.cwiseAbs2().cwiseQuotient(variance).mean() / kBanks;
    }
    CAPTURE(strength, ratio);
    CHECK(ratio > 0.3);
    CHECK(ratio < 1);
  }
}

TEST_CASE("a fit finds its truth without noise, at limits too") {
  MadeUp mill;
  mill.run_noise = 1e-6;
  const Problem p = made_up_problem(mill, point(0, 0, 0), {0, 0, 0}, 2);
  const Features features(p.data);
  const Surrogate s(p.data, features, std::vector<bool>(p.data.rows.size(), true));
  const Weighting weighting(p.covariance, s);
  const Model model(p.data, s, weighting, {{0}, std::vector<StrengthRange>(3)});
  for (const double strength : {0.0, 0.4, 1.0}) {
    const FitResult f = model.fit(truth_of(mill, point(0.4, -0.6, 0), {strength, 0, 0}));
    CHECK_THAT(f.coded[0], WithinAbs(0.4, 1e-3));
    CHECK_THAT(f.coded[1], WithinAbs(-0.6, 1e-3));
    CHECK_THAT(f.strengths[0], WithinAbs(strength, 1e-3));
    CHECK(f.q < 1e-3);
  }
}

namespace {

/// Q of data without noise, from predictions alone.
double misfit(const Problem& p, const Surrogate& s, const Weighting& w, const VectorXd& u, const std::vector<ActiveCandidate>& active) {
  double q = (w.whitener * (p.observed - s.at(u, active))).squaredNorm();
  for (Index i = 0; i < u.size(); ++i) {
    const Coordinate& c = p.data.theta[i];
    if (c.nuisance()) q += std::pow((u[i] - c.coded(c.prior_mean)) * c.prior_weight(), 2);
  }
  return q;
}

}  // namespace

TEST_CASE("a fit's Q is the misfit as it is written, and nowhere within the limits is less") {
  MadeUp mill;
  mill.runs = 48, mill.each = 24;
  base::RandomStream random(5, 0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    mill.whole = seed == 5 ? 1 : 0;
    Problem p = made_up_problem(mill, point(0.3, -0.2, 0), {0.6, 0, 0}, seed);
    if (seed == 5) p.data.degree = {4, 3, 2};
    const Surrogate s(p.data);
    const Weighting w(p.covariance, s);
    for (const std::vector<Index>& on : {std::vector<Index>{}, {0}, {0, 1}, {1, 2}}) {
      const StrengthRange range{seed > 3 ? -1.0 : 0.0, 1};
      const Model model(p.data, s, w, {.on = on, .ranges = std::vector<StrengthRange>(3, range), .exact = true});
      const FitResult found = model.fit(p.observed);
      CHECK_THAT(found.q, WithinRel(misfit(p, s, w, found.coded, model.active(found)), 1e-8));
      for (int k = 0; k < 500; ++k) {
        const double near = k < 250 ? 0.05 : 1;
        FitResult other = found;
        for (Index i = 0; i < other.coded.size(); ++i) other.coded[i] = std::clamp(other.coded[i] + near * random.normal(), -1.0, 1.0);
        for (double& strength : other.strengths) strength = std::clamp(strength + near * random.normal(), range.low, 1.0);
        CHECK(misfit(p, s, w, other.coded, model.active(other)) >= found.q - 1e-6 * (1 + std::fabs(found.q)));
      }
    }
  }
}

TEST_CASE("with an effect at nothing a model is the base, however little the bank tells of it") {
  MadeUp mill;
  mill.each = 8, mill.run_noise = 2, mill.chancier = 2;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Problem p = made_up_problem(mill, point(0.2, -0.3, 0), {0, 0, 0}, seed);
    const Surrogate s(p.data);
    const Weighting w(p.covariance, s);
    const Model base(p.data, s, w, {});
    const FitResult none = base.fit(p.observed);
    for (const int j : {0, 1, 2}) {
      const Model with(p.data, s, w, {{j}, std::vector<StrengthRange>(3)});
      CHECK_THAT(with.fit_holding(3, 0, p.observed).q, WithinRel(none.q, 1e-6));
    }
  }
}

TEST_CASE("correlations of chance are shrunk away, real ones stay") {
  std::srand(3);
  const Eigen::MatrixXd independent = Eigen::MatrixXd::Random(400, 4);
  Eigen::MatrixXd joint = independent;
  for (int c = 1; c < 4; ++c) joint.col(c) = independent.col(0) + 0.3 * independent.col(c);
  const Eigen::MatrixXd a = shrunk(covariance_of(independent), 12), b = shrunk(covariance_of(joint), 200);
  CHECK(std::abs(a(0, 1)) < 0.2 * std::sqrt(a(0, 0) * a(1, 1)));
  CHECK(b(0, 1) > 0.85 * std::sqrt(b(0, 0) * b(1, 1)));
  CHECK(a(0, 0) == Approx(1.0 / 3.0).epsilon(0.15));
}
