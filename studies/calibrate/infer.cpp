// From all simulations to an emulator and the posterior of the parameters.
#include <fmt/format.h>

#include <cmath>

#include "studies/calibrate/inference.hpp"
#include "studies/calibrate/methods.hpp"

namespace millscope::calibrate {
namespace {

constexpr double kSameEverywhere = 1e-12;

Eigen::Index total(const Trial& trial) {
  Eigen::Index n = 0;
  for (const Observation& o : trial.observed) n += o.value.size();
  return n;
}

}  // namespace

std::vector<const Trial*> finished(const Evaluator& evaluator) {
  std::vector<const Trial*> done;
  for (const Trial& trial : evaluator.trials()) {
    if (!trial.failed) done.push_back(&trial);
  }
  return done;
}

emulate::Box box_of(const Study& study) {
  emulate::Box box{study.low(), study.high(), {}, {}};
  for (const Parameter& p : study.parameters) box.name.push_back(p.name);
  if (!study.constraints.empty()) box.allowed = [&study](const Eigen::VectorXd& point) { return study.allowed(point); };
  return box;
}

Fitting fitting_of(const Evaluator& evaluator) {
  const std::vector<const Trial*> done = finished(evaluator);
  Fitting f;
  if (done.empty()) return f;
  const Study& study = evaluator.study();
  const auto runs = static_cast<Eigen::Index>(done.size());
  const Eigen::Index n = total(*done.front());
  Eigen::MatrixXd output(runs, n), noise(runs, n), covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd value(n);
  std::vector<std::string> names;
  f.training.input.resize(runs, static_cast<Eigen::Index>(study.parameters.size()));
  Eigen::Index column = 0;
  for (std::size_t k = 0; k < done.front()->conditions.size(); ++k) {
    const std::size_t condition = done.front()->conditions[k];
    const Observation& recorded = evaluator.recorded(condition);
    const Eigen::Index size = recorded.value.size();
    value.segment(column, size) = recorded.value;
    covariance.block(column, column, size, size) = recorded.covariance;
    for (const Observable& o : recorded.observables) names.push_back(study.conditions[condition].name + ": " + o.name);
    for (Eigen::Index r = 0; r < runs; ++r) {
      const Observation& seen = done[r]->observed[k];
      output.row(r).segment(column, size) = seen.value.transpose();
      noise.row(r).segment(column, size) = seen.covariance.diagonal().transpose();
    }
    column += size;
  }
  for (Eigen::Index r = 0; r < runs; ++r) f.training.input.row(r) = done[r]->point.transpose();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double spread = output.col(i).maxCoeff() - output.col(i).minCoeff();
    if (spread > kSameEverywhere * (1 + std::fabs(output(0, i)))) kept.push_back(i);
  }
  f.training.output = output(Eigen::all, kept);
  f.training.noise_variance = noise(Eigen::all, kept);
  f.observed = {value(kept), covariance(kept, kept)};
  for (const Eigen::Index i : kept) f.training.observable.push_back(names[i]);
  return f;
}

std::optional<Inference> infer(const Evaluator& evaluator, std::vector<std::string>& notes) {
  const Study& study = evaluator.study();
  const Fitting f = fitting_of(evaluator);
  const emulate::Box box = box_of(study);
  try {
    const emulate::Emulator emulator = emulate::Emulator::fit(box, f.training);
    Inference inference;
    emulate::SamplerOptions options;
    options.seed = study.design.seed;
    inference.posterior = emulate::sample_posterior(emulator, box, f.observed, options);
    for (int p = 0; p < static_cast<int>(study.parameters.size()); ++p)
      inference.profiles.push_back(emulate::profile(emulator, box, f.observed, p));
    inference.diagnostics = emulator.leave_one_out();
    inference.observables = f.training.observable;
    return inference;
  } catch (const base::UserError& e) {
    notes.push_back(fmt::format("no posterior: {}", e.what()));
    return std::nullopt;
  }
}

}  // namespace millscope::calibrate
