// The emulator against functions that are known.
#include <catch2/catch.hpp>

#include "kernel/base/error.hpp"
#include "studies/emulate/process.hpp"
#include "support.hpp"

using namespace millscope::emulate;
using namespace millscope::emulate::test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Smooth, neither linear nor quadratic, each parameter with its own length.
VectorXd wavy(const VectorXd& x) {
  VectorXd y(2);
  y << std::sin(4 * x[0]) + 0.5 * x[1], std::exp(-2 * x[0]) * std::cos(3 * x[1]);
  return y;
}

double root_mean_square_error(const Emulator& emulator, const Function& f, std::uint64_t seed) {
  const MatrixXd points = latin(emulator.box(), 200, seed);
  double sum = 0;
  for (Index i = 0; i < points.cols(); ++i) sum += (emulator.at(points.col(i)).mean - f(points.col(i))).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.cols()));
}

}  // namespace

TEST_CASE("a smooth function without noise is reproduced") {
  const Box box = unit_box(2);
  for (const Kernel kernel : {Kernel::matern52, Kernel::squared_exponential}) {
    const Training training = runs_of(wavy, latin(box, 40, 1), 0, 1);
    const Emulator emulator = Emulator::fit(box, training, {.kernel = kernel});
    CHECK(root_mean_square_error(emulator, wavy, 2) < (kernel == Kernel::matern52 ? 0.02 : 0.005));
    // at a run: its value, and nearly no doubt
    const Prediction at_run = emulator.at(training.input.row(7).transpose());
    CHECK_THAT(at_run.mean[0], WithinAbs(training.output(7, 0), 2e-3));
    CHECK(std::sqrt(at_run.variance[0]) < 2e-3);
    // where no run is near, more doubt
    const Prediction corner = emulator.at(VectorXd::Ones(2));
    CHECK(corner.variance[0] > at_run.variance[0]);
    CHECK(emulator.leave_one_out().predictivity.minCoeff() > 0.99);
  }
}

TEST_CASE("left-out runs lie inside their intervals as often as promised") {
  const Box box = unit_box(3);
  const Function f = [](const VectorXd& x) {
    return VectorXd{{std::sin(3 * x[0]) + x[1] * x[2], std::cos(2 * x[1]) - x[0], x[2] * x[2] + x[0]}};
  };
  double inside = 0, square = 0;
  double true_inside = 0;
  int checked = 0;
  constexpr int kRepeats = 12;
  for (std::uint64_t repeat = 1; repeat <= kRepeats; ++repeat) {
    const Emulator emulator = Emulator::fit(box, runs_of(f, latin(box, 30, repeat), 0.05, repeat), {.starts = 2});
    const Diagnostics d = emulator.leave_one_out();
    inside += d.coverage90_all / kRepeats;
    square += d.mean_square.mean() / kRepeats;
    const MatrixXd fresh = latin(box, 20, 100 + repeat);
    for (Index i = 0; i < fresh.cols(); ++i) {
      const Prediction p = emulator.at(fresh.col(i));
      const VectorXd z = (p.mean - f(fresh.col(i))).cwiseQuotient((p.variance + p.nugget).cwiseSqrt());
      true_inside += static_cast<double>((z.array().abs() < 1.645).count());
      checked += 3;
    }
  }
  CHECK_THAT(inside, WithinAbs(0.90, 0.04));
  CHECK_THAT(square, WithinAbs(1.0, 0.2));
  CHECK_THAT(true_inside / checked, WithinAbs(0.92, 0.06));
}

TEST_CASE("the closed form of leaving a run out is what leaving it out gives") {
  const Training all = runs_of(wavy, latin(unit_box(2), 15, 3), 0.1, 3);
  const Sample sample{all.input.transpose(), all.output.col(0), all.noise_variance.col(0)};
  const Shape shape{Kernel::matern52, Trend::quadratic, VectorXd{{-0.5, 0.3}}, -1.0, -6.0};
  const Process::LeftOut closed = Process(sample, shape).leave_one_out();
  for (const Index run : {Index{0}, Index{8}}) {
    Sample rest{MatrixXd(2, 14), VectorXd(14), VectorXd(14)};
    for (Index i = 0, at = 0; i < 15; ++i) {
      if (i == run) continue;
      rest.input.col(at) = sample.input.col(i);
      rest.output[at] = sample.output[i];
      rest.noise[at++] = sample.noise[i];
    }
    const Process::Value value = Process(rest, shape).at(sample.input.col(run));
    CHECK_THAT(closed.residual[run], WithinRel(sample.output[run] - value.mean, 1e-9));
    CHECK_THAT(closed.variance[run], WithinRel(value.variance + sample.noise[run] + std::exp(-6.0), 1e-9));
  }
}

TEST_CASE("the likelihood's slope is its slope") {
  const Training all = runs_of(wavy, latin(unit_box(2), 15, 3), 0.1, 3);
  const Sample sample{all.input.transpose(), all.output.col(0), all.noise_variance.col(0)};
  for (const Kernel kernel : {Kernel::matern52, Kernel::squared_exponential}) {
    const auto at = [&](const VectorXd& x) { return Process(sample, {kernel, Trend::linear, x.head(2), x[2], x[3]}); };
    const VectorXd x{{-0.5, 0.3, -1.0, -4.0}};
    VectorXd slope;
    at(x).log_likelihood(&slope);
    for (Index k = 0; k < 4; ++k) {
      const VectorXd step = 1e-5 * VectorXd::Unit(4, k);
      const double difference = (at(x + step).log_likelihood(nullptr) - at(x - step).log_likelihood(nullptr)) / 2e-5;
      CHECK_THAT(slope[k], WithinRel(difference, 1e-5));
    }
  }
}

TEST_CASE("other units give the same emulator") {
  const Box box = unit_box(2);
  const Training training = runs_of(wavy, latin(box, 25, 4), 0.03, 4);
  const Emulator plain = Emulator::fit(box, training);
  // parameter 1 in thousandths and shifted, observable 2 in 1e-4 of its unit and shifted
  Box other = box;
  other.lower << 3000, 0;
  other.upper << 4000, 1;
  Training scaled = training;
  scaled.input.col(0) = 3000 + 1000 * training.input.col(0).array();
  scaled.output.col(1) = 7 + 1e4 * training.output.col(1).array();
  scaled.noise_variance.col(1) *= 1e8;
  const Emulator moved = Emulator::fit(other, scaled);
  const Prediction a = plain.at(VectorXd{{0.3, 0.6}}), b = moved.at(VectorXd{{3300, 0.6}});
  CHECK_THAT(b.mean[0], WithinAbs(a.mean[0], 1e-5));
  CHECK_THAT(b.mean[1], WithinRel(7 + 1e4 * a.mean[1], 1e-5));
  CHECK_THAT(b.variance[1], WithinRel(1e8 * a.variance[1], 1e-3));
}

TEST_CASE("the nugget finds noise of which nobody told") {
  const Box box = unit_box(2);
  Training training = runs_of(wavy, latin(box, 60, 5), 0.1, 5);
  training.noise_variance.setZero();
  const Emulator emulator = Emulator::fit(box, training);
  CHECK_THAT(emulator.hyperparameters(0).nugget_deviation, WithinAbs(0.1, 0.03));
  CHECK(emulator.at(VectorXd{{0.5, 0.5}}).nugget[0] > 0.004);
}

TEST_CASE("the same seed gives the same emulator with any number of threads") {
  const Box box = unit_box(2);
  const Training training = runs_of(wavy, latin(box, 20, 6), 0.05, 6);
  const VectorXd x{{0.21, 0.77}};
  const Prediction one = Emulator::fit(box, training, {.threads = 1}).at(x), two = Emulator::fit(box, training, {.threads = 2}).at(x);
  CHECK(one.mean == two.mean);
  CHECK(one.variance == two.variance);
}

TEST_CASE("a quadratic is taken where it predicts better and enough runs are there") {
  const Function parabola = [](const VectorXd& x) {
    return VectorXd{{8 * (x[0] - 0.4) * (x[0] - 0.4) + 6 * x[0] * x[1] - 5 * x[2] * x[2] + 4 * x[1] * x[2]}};
  };
  const Function plane = [](const VectorXd& x) { return VectorXd{{x[0] - 2 * x[1]}}; };
  const auto trend = [](const Function& f, Index parameters, Index runs) {
    const Box box = unit_box(parameters);
    return Emulator::fit(box, runs_of(f, latin(box, runs, 7), 0.05, 7)).hyperparameters(0).trend;
  };
  CHECK(trend(parabola, 3, 30) == Trend::quadratic);
  CHECK(trend(parabola, 3, 14) == Trend::linear);
  CHECK(trend(plane, 2, 8) == Trend::linear);
  CHECK_THROWS_WITH(Emulator::fit(unit_box(2), runs_of(plane, latin(unit_box(2), 8, 7), 0.05, 7), {.trend = Trend::quadratic}),
                    Contains("do not determine a quadratic"));
}

TEST_CASE("training that teaches nothing is refused with the reason") {
  const Box box{VectorXd::Zero(2), VectorXd::Ones(2), {}, {"friction", "restitution"}};
  Training good = runs_of(wavy, latin(box, 12, 8), 0.05, 8);
  good.observable = {"power", "toe"};
  const auto refusal = [&](const Training& t) {
    try {
      Emulator::fit(box, t);
    } catch (const millscope::base::UserError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refusal(good) == "accepted");
  Training bad = good;
  bad.output(4, 1) = std::nan("");
  CHECK_THAT(refusal(bad), Contains("run 5") && Contains("toe is nan"));
  bad = good;
  bad.noise_variance(2, 0) = -1;
  CHECK_THAT(refusal(bad), Contains("run 3") && Contains("power has the variance -1"));
  bad = good;
  bad.input(0, 1) = INFINITY;
  CHECK_THAT(refusal(bad), Contains("run 1") && Contains("restitution is inf"));
  bad = good;
  bad.output.col(0).setConstant(5);
  CHECK_THAT(refusal(bad), Contains("power is 5 in all 12 runs"));
  bad = good;
  bad.input.col(0).setConstant(0.5);
  CHECK_THAT(refusal(bad), Contains("friction is 0.5 in all 12 runs"));
  bad = good;
  bad.input.col(0) = 1 - bad.input.col(1).array();
  CHECK_THAT(refusal(bad), Contains("changes only together"));
  bad = {good.input.topRows(4), good.output.topRows(4), good.noise_variance.topRows(4)};
  CHECK_THAT(refusal(bad), Contains("4 successful runs for 2 parameters: an emulator needs at least 5"));
}

TEST_CASE("runs at the same place that disagree without noise are taken for noisy") {
  const Box box = unit_box(1);
  MatrixXd points(1, 10);
  points << 0.1, 0.1, 0.3, 0.3, 0.5, 0.5, 0.7, 0.7, 0.9, 0.9;
  Training training = runs_of([](const VectorXd& x) { return VectorXd{{x[0]}}; }, points, 0.1, 9);
  training.noise_variance.setZero();
  const Emulator emulator = Emulator::fit(box, training);
  CHECK(emulator.hyperparameters(0).nugget_deviation > 0.03);
}
