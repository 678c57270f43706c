#include "studies/emulate/emulator.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/base/parallel.hpp"
#include "kernel/base/statistics.hpp"
#include "studies/emulate/check_training.hpp"
#include "studies/emulate/process.hpp"

namespace millscope::emulate {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Emulator::State {
  Box box;
  Training training;
  std::vector<Process> process;
  std::vector<Hyperparameters> hyperparameters;
  VectorXd centre, spread;  // of the observables
  VectorXd noise;           // median over runs
  MatrixXd correlation;
};

namespace {

Sample sample_of(const Emulator::State& s, Index observable) {
  MatrixXd input(s.box.size(), s.training.input.rows());
  for (Index i = 0; i < input.cols(); ++i) input.col(i) = s.box.coded(s.training.input.row(i).transpose());
  const double unit = s.spread[observable];
  return {std::move(input), (s.training.output.col(observable).array() - s.centre[observable]) / unit,
          s.training.noise_variance.col(observable) / (unit * unit)};
}

/// A quadratic needs runs to spare: a parameter's worth and two, beyond its own terms, and runs that determine all of them.
bool quadratic_possible(const Sample& sample) {
  const Index n = sample.input.cols(), terms = trend_size(Trend::quadratic, sample.input.rows());
  if (n < terms + sample.input.rows() + 2) return false;
  MatrixXd h(n, terms);
  for (Index i = 0; i < n; ++i) h.row(i) = trend_terms(Trend::quadratic, sample.input.col(i)).transpose();
  return Eigen::ColPivHouseholderQR<MatrixXd>(h).rank() == terms;
}

Process best_process(const Sample& sample, const FitOptions& options, Index observable) {
  const auto stream = static_cast<std::uint64_t>(observable);
  const bool possible = options.trend != Trend::linear && quadratic_possible(sample);
  if (options.trend == Trend::quadratic && !possible) {
    throw base::UserError(
        fmt::format("the {} runs do not determine a quadratic trend; add runs or use the linear one", sample.input.cols()));
  }
  if (options.trend == Trend::quadratic) return fit_process(sample, Trend::quadratic, options, stream);
  Process linear = fit_process(sample, Trend::linear, options, stream);
  if (!possible) return linear;
  Process quadratic = fit_process(sample, Trend::quadratic, options, stream);
  return quadratic.leave_one_out().log_density() > linear.leave_one_out().log_density() ? quadratic : linear;
}

MatrixXd standardised(const std::vector<Process>& process) {
  MatrixXd z(process.front().sample().output.size(), static_cast<Index>(process.size()));
  for (Index j = 0; j < z.cols(); ++j) {
    const Process::LeftOut left = process[j].leave_one_out();
    z.col(j) = left.residual.array() / left.variance.array().sqrt();
  }
  return z;
}

/// Correlations r of the columns, shrunk:  (1 − λ) r,  λ = Σ var r/Σ r² over the pairs (Schäfer & Strimmer 2005, Table 1, target D).
MatrixXd shrunk_correlation(MatrixXd z) {
  const auto n = static_cast<double>(z.rows());
  for (Index j = 0; j < z.cols(); ++j) z.col(j) /= std::sqrt(std::max(z.col(j).squaredNorm() / n, 1e-300));
  MatrixXd r = MatrixXd::Identity(z.cols(), z.cols());
  double variance = 0, square = 0;
  for (Index j = 0; j < z.cols(); ++j) {
    for (Index k = 0; k < j; ++k) {
      const VectorXd product = z.col(j).cwiseProduct(z.col(k));
      r(j, k) = r(k, j) = product.mean();
      variance += (product.array() - product.mean()).square().sum() / (n * (n - 1));
      square += r(j, k) * r(j, k);
    }
  }
  const double shrinkage = square > 0 ? std::clamp(variance / square, 0.0, 1.0) : 1.0;
  r *= 1 - shrinkage;
  r.diagonal().setOnes();
  return r;
}

Hyperparameters summary(const Process& process, double unit) {
  const Shape& shape = process.shape();
  const Process::LeftOut left = process.leave_one_out();
  const double mean_square = (left.residual.array().square() / left.variance.array()).mean();
  return {shape.trend,
          shape.log_length.array().exp(),
          unit * std::exp(0.5 * shape.log_variance),
          unit * std::exp(0.5 * shape.log_nugget),
          std::max(1.0, mean_square),
          process.log_likelihood(nullptr)};
}

}  // namespace

Emulator::Emulator(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Emulator Emulator::fit(const Box& box, const Training& training, const FitOptions& options) {
  check_training(box, training);
  if (options.starts < 1) throw std::invalid_argument("FitOptions: starts must be at least 1");
  auto state = std::make_shared<State>();
  state->box = box;
  state->training = training;
  const Index q = training.output.cols();
  state->centre = training.output.colwise().mean();
  state->spread =
      ((training.output.rowwise() - state->centre.transpose()).colwise().squaredNorm() / static_cast<double>(training.output.rows()))
          .cwiseSqrt();
  state->noise.resize(q);
  std::vector<std::shared_ptr<Process>> found(q);
  base::for_each_item(found.size(), base::worker_count(options.threads, found.size()), [&](std::size_t j, std::size_t) {
    const auto observable = static_cast<Index>(j);
    try {
      found[j] = std::make_shared<Process>(best_process(sample_of(*state, observable), options, observable));
    } catch (const std::domain_error& error) {
      throw base::UserError(fmt::format("{} cannot be emulated: {}; runs at the same parameters that differ without noise?",
                                        observable_name(training, observable), error.what()));
    }
  });
  for (Index j = 0; j < q; ++j) {
    const Process& process = *found[j];
    state->process.push_back(process);
    state->hyperparameters.push_back(summary(process, state->spread[j]));
    const auto noise = training.noise_variance.col(j);
    std::vector<double> of_runs(noise.begin(), noise.end());
    state->noise[j] = base::quantile(of_runs, 0.5);
  }
  state->correlation = shrunk_correlation(standardised(state->process));
  return Emulator(state);
}

Prediction Emulator::at(const VectorXd& point) const {
  if (point.size() != state_->box.size()) throw std::invalid_argument("Emulator::at: wrong number of parameters");
  const VectorXd coded = state_->box.coded(point);
  const Index q = observables();
  Prediction result{VectorXd(q), VectorXd(q), VectorXd(q), state_->noise};
  for (Index j = 0; j < q; ++j) {
    const Process::Value value = state_->process[j].at(coded);
    const Hyperparameters& fitted = state_->hyperparameters[j];
    const double unit = state_->spread[j];
    result.mean[j] = state_->centre[j] + unit * value.mean;
    result.variance[j] = fitted.inflation * unit * unit * value.variance;
    result.nugget[j] = fitted.inflation * fitted.nugget_deviation * fitted.nugget_deviation;
  }
  return result;
}

MatrixXd Emulator::covariance(const Prediction& prediction) const {
  const VectorXd deviation = (prediction.variance + prediction.nugget).cwiseSqrt();
  return deviation.asDiagonal() * state_->correlation * deviation.asDiagonal();
}

Diagnostics Emulator::leave_one_out() const {
  const Index n = state_->training.output.rows(), q = observables();
  Diagnostics d{MatrixXd(n, q), MatrixXd(n, q), MatrixXd(n, q), VectorXd(q), VectorXd(q), VectorXd(q), 0};
  for (Index j = 0; j < q; ++j) {
    const double unit = state_->spread[j];
    const Process::LeftOut left = state_->process[j].leave_one_out();
    d.predicted.col(j) = state_->training.output.col(j) - unit * left.residual;
    d.deviation.col(j) = unit * left.variance.cwiseSqrt();
    d.standardised.col(j) = left.residual.cwiseQuotient(left.variance.cwiseSqrt());
    d.coverage90[j] = (d.standardised.col(j).array().abs() < base::kNormal90).cast<double>().mean();
    d.mean_square[j] = d.standardised.col(j).squaredNorm() / static_cast<double>(n);
    d.predictivity[j] = 1 - left.residual.squaredNorm() / static_cast<double>(n);  // of the output in units of its spread
  }
  d.coverage90_all = d.coverage90.mean();
  return d;
}

Emulator Emulator::believing(const VectorXd& point) const {
  const Prediction believed = at(point);
  auto state = std::make_shared<State>(*state_);
  const Index n = state->training.input.rows();
  state->training.input.conservativeResize(n + 1, Eigen::NoChange);
  state->training.output.conservativeResize(n + 1, Eigen::NoChange);
  state->training.noise_variance.conservativeResize(n + 1, Eigen::NoChange);
  state->training.input.row(n) = point.transpose();
  state->training.output.row(n) = believed.mean.transpose();
  state->training.noise_variance.row(n) = believed.noise.transpose();
  for (Index j = 0; j < observables(); ++j) {
    Process& process = state->process[j];
    process = Process(sample_of(*state, j), process.shape());
  }
  return Emulator(std::move(state));
}

const MatrixXd& Emulator::correlation() const { return state_->correlation; }
const Hyperparameters& Emulator::hyperparameters(Index observable) const { return state_->hyperparameters.at(observable); }
Index Emulator::observables() const { return state_->training.output.cols(); }
const Training& Emulator::training() const { return state_->training; }
const Box& Emulator::box() const { return state_->box; }

}  // namespace millscope::emulate
