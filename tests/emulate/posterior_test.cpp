// What the data say of parameters, where the answer is known.
#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "kernel/base/error.hpp"
#include "studies/emulate/posterior.hpp"
#include "support.hpp"

using namespace millscope::emulate;
using namespace millscope::emulate::test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Emulator of y = A x over the box, practically exact.
Emulator linear_emulator(const MatrixXd& a, const Box& box) {
  return Emulator::fit(box, runs_of([&](const VectorXd& x) { return VectorXd(a * x); }, latin(box, 30, 1), 0, 1),
                       {.trend = Trend::linear, .starts = 1});
}

/// Two observables see the friction, none the restitution.
VectorXd blind_to_second(const VectorXd& x) { return VectorXd{{2 * x[0], std::sin(2 * x[0])}}; }

}  // namespace

TEST_CASE("a linear model with normal noise has the posterior of the textbook") {
  const Box box{VectorXd{{-4, -40}}, VectorXd{{6, 60}}};
  const MatrixXd a{{1, 0.02}, {0.5, -0.1}, {-0.3, 0.05}};
  const MatrixXd noise{{0.09, 0.02, 0}, {0.02, 0.16, 0.01}, {0, 0.01, 0.04}};
  const Observed observed{VectorXd{{1.3, 0.2, -0.1}}, noise};
  const MatrixXd covariance = (a.transpose() * noise.inverse() * a).inverse();
  const VectorXd mean = covariance * a.transpose() * noise.inverse() * observed.value;

  const Posterior posterior = sample_posterior(linear_emulator(a, box), box, observed, {.seed = 3, .draws = 2000});
  CHECK(posterior.converged);
  CHECK(posterior.acceptance > 0.1);
  for (Index k = 0; k < 2; ++k) {
    const Marginal& m = posterior.marginal[k];
    const double deviation = std::sqrt(covariance(k, k));
    INFO(m.statement);
    CHECK_THAT(m.mean, WithinAbs(mean[k], 0.06 * deviation));
    CHECK_THAT(m.deviation, WithinRel(deviation, 0.06));
    CHECK_THAT(m.low90, WithinAbs(mean[k] - 1.645 * deviation, 0.12 * deviation));
    CHECK_THAT(m.high90, WithinAbs(mean[k] + 1.645 * deviation, 0.12 * deviation));
    CHECK_THAT(m.mode, WithinAbs(mean[k], 0.03 * deviation));
    CHECK_THAT(m.conditional_ratio / m.width_ratio, WithinRel(1 / std::sqrt(covariance(k, k) * covariance.inverse()(k, k)), 0.06));
    CHECK(m.r_hat < 1.05);
  }
  CHECK_THAT(posterior.correlation(0, 1), WithinAbs(covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), 0.04));
  const VectorXd rest = observed.value - a * mean;
  CHECK_THAT(posterior.misfit, WithinRel(rest.dot(noise.inverse() * rest), 0.02));
}

TEST_CASE("what the emulator does not know widens the posterior, and where it knows less its values count less") {
  const Box box = unit_box(1);
  const Function line = [](const VectorXd& x) { return VectorXd{{x[0]}}; };
  const Emulator sure = Emulator::fit(box, runs_of(line, latin(box, 10, 1), 1e-4, 1), {.trend = Trend::linear});
  const Emulator unsure = Emulator::fit(box, runs_of(line, latin(box, 10, 1), 0.1, 1), {.trend = Trend::linear});
  const Observed observed{VectorXd{{0.5}}, MatrixXd{{1e-4}}};
  const double narrow = sample_posterior(sure, box, observed).marginal[0].deviation;
  const double wide = sample_posterior(unsure, box, observed).marginal[0].deviation;
  CHECK_THAT(narrow, WithinRel(0.01, 0.1));
  CHECK(wide > 2 * narrow);
  // The log determinant: far from all runs the same residual is less of a surprise but the density is spread thinner.
  const VectorXd x{{0.5}};
  const Prediction p = unsure.at(x);
  const double variance = 1e-4 + p.variance[0] + p.nugget[0], residual = 0.5 - p.mean[0];
  CHECK_THAT(log_density(unsure, box, observed, x), WithinRel(-0.5 * (residual * residual / variance + std::log(variance)), 1e-9));
  CHECK(log_density(unsure, box, observed, VectorXd{{1.01}}) == -INFINITY);
}

TEST_CASE("a parameter that nothing depends on is called hardly determined, one that is seen is called determined") {
  const Box box{VectorXd::Zero(2), VectorXd::Ones(2), {}, {"friction", "restitution"}};
  const Emulator emulator = Emulator::fit(box, runs_of(blind_to_second, latin(box, 30, 1), 0.01, 1));
  const Posterior posterior = sample_posterior(emulator, box, {VectorXd{{0.8, std::sin(0.8)}}, 4e-4 * MatrixXd::Identity(2, 2)});
  CHECK(posterior.marginal[0].determined == Determined::well);
  CHECK(posterior.marginal[0].width_ratio < 0.1);
  CHECK_THAT(posterior.marginal[0].statement, Contains("friction: determined by the data: 0.3") && Contains("% of its width before them"));
  CHECK(posterior.marginal[1].determined == Determined::hardly);
  CHECK(posterior.marginal[1].width_ratio > 0.85);
  CHECK_THAT(posterior.marginal[1].statement, Contains("restitution: hardly determined"));
}

TEST_CASE("two parameters that do the same conceal each other") {
  const Box box{VectorXd::Zero(2), VectorXd::Ones(2), {}, {"sliding", "rolling"}};
  const Function sum = [](const VectorXd& x) { return VectorXd{{x[0] + x[1], (x[0] + x[1]) * (x[0] + x[1])}}; };
  const Emulator emulator = Emulator::fit(box, runs_of(sum, latin(box, 30, 1), 0.005, 1));
  const Observed observed{VectorXd{{1.0, 1.0}}, 1e-4 * MatrixXd::Identity(2, 2)};
  const Posterior posterior = sample_posterior(emulator, box, observed);
  CHECK(posterior.marginal[0].determined == Determined::hardly);
  CHECK(posterior.marginal[0].conditional_ratio < 0.1);
  CHECK(posterior.correlation(0, 1) < -0.95);
  CHECK_THAT(posterior.marginal[0].statement, Contains("rolling can do (correlation -"));
  CHECK_THAT(posterior.statements.back(), Contains("sliding and rolling conceal each other"));

  const Profile p = profile(emulator, box, observed, 0);
  CHECK(p.concealed > 0.9);
  CHECK(p.high_alone - p.low_alone < 0.1);
  CHECK(p.high_readjusted - p.low_readjusted > 0.8);
  CHECK((p.readjusted.array() >= p.alone.array() - 1e-6).all());
  // the others' way: rolling = 1 − sliding
  CHECK_THAT(p.others(4, 0) + p.others(4, 1), WithinAbs(1.0, 0.05));
}

TEST_CASE("the profile of a linear model is the textbook's parabola") {
  const Box box = {VectorXd{{-10, -10}}, VectorXd{{10, 10}}};
  const MatrixXd a{{1, 0.5}, {0, 1}, {1, -1}};
  const Observed observed{VectorXd{{1, 2, -1}}, 0.25 * MatrixXd::Identity(3, 3)};
  const MatrixXd precision = 4 * a.transpose() * a;
  const Profile p = profile(linear_emulator(a, box), box, observed, 0);
  CHECK_THAT(p.high_readjusted - p.low_readjusted, WithinRel(2 * 1.645 * std::sqrt(precision.inverse()(0, 0)), 0.02));
  CHECK_THAT(p.high_alone - p.low_alone, WithinRel(2 * 1.645 / std::sqrt(precision(0, 0)), 0.02));
  CHECK_THAT(p.sensitivity_alone, WithinRel(10 * std::sqrt(precision(0, 0)), 0.01));
  CHECK_THAT(p.sensitivity_readjusted, WithinRel(10 / std::sqrt(precision.inverse()(0, 0)), 0.01));
}

TEST_CASE("constraints hold, and what they alone exclude is not called determined") {
  Box box = unit_box(2);
  box.name = {"rolling", "sliding"};
  box.allowed = [](const VectorXd& x) { return x[0] < 0.3 * x[1]; };
  const Function f = [](const VectorXd& x) { return VectorXd{{std::cos(x[1])}}; };
  const Emulator emulator = Emulator::fit(box, runs_of(f, latin(unit_box(2), 25, 1), 0.01, 1));
  const Posterior posterior = sample_posterior(emulator, box, {VectorXd{{std::cos(0.6)}}, MatrixXd{{0.25}}});
  CHECK((posterior.samples.col(0).array() < 0.3 * posterior.samples.col(1).array()).all());
  CHECK(posterior.marginal[0].high90 < 0.3);
  CHECK(posterior.marginal[0].determined == Determined::hardly);
}

TEST_CASE("a simulation that cannot tell the truth is said not to fit") {
  const Box box = unit_box(1);
  const Function f = [](const VectorXd& x) { return VectorXd{{x[0], x[0] * x[0], 1 - x[0]}}; };
  const Emulator emulator = Emulator::fit(box, runs_of(f, latin(box, 15, 1), 0.005, 1));
  const MatrixXd noise = 1e-4 * MatrixXd::Identity(3, 3);
  const Posterior good = sample_posterior(emulator, box, {VectorXd{{0.505, 0.245, 0.49}}, noise});
  CHECK(good.misfit_probability > 0.01);
  CHECK_THAT(good.statements.front(), Contains("the best parameters fit"));
  const Posterior bad = sample_posterior(emulator, box, {VectorXd{{0.5, 0.25, 0.9}}, noise});
  CHECK(bad.misfit_probability < 1e-6);
  CHECK_THAT(bad.statements.front(), Contains("no parameters fit"));
  const Posterior edge = sample_posterior(emulator, box, {VectorXd{{1.1, 1.2, -0.1}}, noise});
  CHECK(edge.marginal[0].at_edge);
  CHECK_THAT(edge.marginal[0].statement, Contains("widen it"));
}

TEST_CASE("ninety of a hundred truths lie in their 90 % intervals") {
  // Truths drawn over the box; observations drawn on the emulator: its mean, its own doubt and the recording's noise.
  const Box box = unit_box(2);
  const Function f = [](const VectorXd& x) { return VectorXd{{std::sin(2 * x[0]) + 0.3 * x[1], x[0] * x[1], std::exp(-x[0])}}; };
  const Emulator emulator = Emulator::fit(box, runs_of(f, latin(box, 25, 1), 0.02, 1));
  const MatrixXd noise = 9e-4 * MatrixXd::Identity(3, 3);
  constexpr int kTruths = 110;
  millscope::base::RandomStream random(5);
  double inside[2] = {0, 0};
  for (int i = 0; i < kTruths; ++i) {
    const VectorXd truth = random.uniforms(2, 0, 1);
    const Prediction p = emulator.at(truth);
    const MatrixXd root = (noise + emulator.covariance(p)).llt().matrixL();
    const VectorXd value = p.mean + root * random.normals(3);
    const Posterior posterior = sample_posterior(emulator, box, {value, noise}, {.seed = 7 + static_cast<std::uint64_t>(i), .draws = 150});
    for (const Index k : {Index{0}, Index{1}}) {
      const Marginal& m = posterior.marginal[k];
      if (m.low90 <= truth[k] && truth[k] <= m.high90) inside[k] += 100.0 / kTruths;
    }
  }
  INFO(inside[0] << " % and " << inside[1] << " %");
  CHECK((inside[0] >= 80 && inside[0] <= 97));
  CHECK((inside[1] >= 80 && inside[1] <= 97));
}

TEST_CASE("the same seed gives the same posterior, with any number of threads") {
  const Box box = unit_box(2);
  const Emulator emulator = Emulator::fit(box, runs_of(blind_to_second, latin(box, 15, 1), 0.01, 1));
  const Observed observed{VectorXd{{0.8, 0.7}}, 4e-4 * MatrixXd::Identity(2, 2)};
  const Posterior one = sample_posterior(emulator, box, observed, {.seed = 4, .draws = 100, .doublings = 0, .threads = 1});
  const Posterior two = sample_posterior(emulator, box, observed, {.seed = 4, .draws = 100, .doublings = 0, .threads = 2});
  const Posterior other = sample_posterior(emulator, box, observed, {.seed = 5, .draws = 100, .doublings = 0, .threads = 2});
  CHECK(one.samples == two.samples);
  CHECK(one.samples != other.samples);
}

TEST_CASE("data that are none, and boxes that are empty, are refused") {
  Box box = unit_box(2);
  Training training = runs_of(blind_to_second, latin(box, 15, 1), 0.01, 1);
  training.observable = {"power", "toe"};
  const Emulator emulator = Emulator::fit(box, training);
  const MatrixXd noise = 1e-4 * MatrixXd::Identity(2, 2);
  const auto sample = [&](VectorXd value, MatrixXd covariance) {
    return sample_posterior(emulator, box, {std::move(value), std::move(covariance)});
  };
  CHECK_THROWS_WITH(sample(VectorXd{{1, std::nan("")}}, noise), Contains("recording's toe is nan"));
  CHECK_THROWS_WITH(sample(VectorXd{{1, 1}}, -noise), Contains("power has the variance"));
  CHECK_THROWS_WITH(sample(VectorXd{{1, 1}}, MatrixXd{{1, 2}, {2, 1}}), Contains("negative direction"));
  CHECK_THROWS_WITH(sample(VectorXd{{1, 1}}, MatrixXd{{1, 0.5}, {0, 1}}), Contains("not symmetric"));
  box.allowed = [](const VectorXd& x) { return x[0] > 2; };
  CHECK_THROWS_WITH(sample(VectorXd{{1, 1}}, noise), Contains("constraints leave next to nothing"));

  // two observables that are one, recorded and emulated without error
  const Function twice = [](const VectorXd& x) { return VectorXd{{x[0] + x[1], 2 * (x[0] + x[1])}}; };
  const Emulator same = Emulator::fit(unit_box(2), runs_of(twice, latin(unit_box(2), 15, 1), 0, 1));
  CHECK_THROWS_WITH(sample_posterior(same, unit_box(2), {VectorXd{{1, 2}}, 1e3 * MatrixXd{{1, 2}, {2, 4}}}), Contains("singular"));
}
