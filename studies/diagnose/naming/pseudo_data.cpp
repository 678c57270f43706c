#include "studies/diagnose/naming/pseudo_data.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/base/parallel.hpp"

namespace millscope::naming {
namespace {

constexpr std::size_t kLeastBase = 8;
constexpr std::size_t kEnoughWith = 12;  // runs with a candidate, for intervals from them alone
constexpr double kFaint = 0.1;           // of a strength: the bank has no runs with less
constexpr double kSingular = 1e-12;

/// Of a symmetric matrix A without negative eigenvalues, which may be singular: F with F Fᵀ = A, and G with Gᵀ F F ᵀ G = 1 where A is not
/// 0.
struct Root {
  MatrixXd factor, inverse;
};

Root root_of(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(a);
  const VectorXd& values = solver.eigenvalues();
  const double least = kSingular * values.cwiseAbs().maxCoeff();
  const VectorXd root = (values.array() > least).select(values.cwiseMax(0).cwiseSqrt(), 0);
  const VectorXd inverse = (values.array() > least).select(root.cwiseInverse(), 0);
  return {solver.eigenvectors() * root.asDiagonal(), solver.eigenvectors() * inverse.asDiagonal()};
}

}  // namespace

PseudoData::PseudoData(const Problem& problem, const Options& options)
    : problem_(problem), options_(options), features_(std::make_unique<Features>(problem.data)), ranges_(ranges_of(problem)) {
  const BankData& data = problem.data;
  const std::vector<bool> all(data.rows.size(), true);
  surrogate_ = std::make_unique<Surrogate>(data, *features_, all);
  chance_ = surrogate_->chance(problem.covariance);
  weighting_ = std::make_unique<Weighting>(problem.covariance, *surrogate_);
  run_white_ = weighting_->whitener * root_of(weighting_->run).factor;
  noise_ = Noise(problem.covariance, problem.sizes);
  std::size_t base = 0;
  for (std::size_t r = 0; r < data.rows.size(); ++r) {
    LeftOut left;
    left.surrogate = std::make_unique<Surrogate>(data, *features_, all_but(data, r));
    const VectorXd u = data.coded(data.rows[r].theta);
    const std::vector<ActiveCandidate>& active = data.rows[r].active;
    left.deviation = data.value.row(r).transpose() - left.surrogate->at(u, active);
    left.leverage = left.surrogate->leverage(u, active);
    left.active = active;
    base += active.empty() && data.usual(data.rows[r]) ? 1 : 0;
    left_out_.push_back(std::move(left));
  }
  if (base < kLeastBase)
    throw base::UserError(
        fmt::format("the bank has {} finished runs without a candidate, the null needs {}; raise bank.base", base, kLeastBase));
}

double PseudoData::scatter_of(const std::vector<ActiveCandidate>& active) const {
  std::vector<ActiveCandidate> strong = active;
  std::erase_if(strong, [](const ActiveCandidate& e) { return std::fabs(e.strength) < kFaint; });
  return surrogate_->scatter_of(strong);
}

std::vector<const PseudoData::LeftOut*> PseudoData::runs_for(const Truth& truth, bool for_intervals) const {
  std::vector<const LeftOut*> out, with;
  for (const LeftOut& left : left_out_) {
    const bool has_all = std::all_of(left.active.begin(), left.active.end(), [&](const ActiveCandidate& own) {
      return std::any_of(truth.active.begin(), truth.active.end(),
                         [&](const ActiveCandidate& e) { return e.candidate == own.candidate && std::fabs(e.strength) >= kFaint; });
    });
    if (!has_all) continue;
    out.push_back(&left);
    if (!left.active.empty()) with.push_back(&left);
  }
  return for_intervals && with.size() >= kEnoughWith ? with : out;
}

Model PseudoData::model(const Surrogate& surrogate, const Choice& choice) const {
  Switched switched{{}, ranges_, {}};
  for (const Index r : choice) {
    const Alternative& alternative = problem_.alternatives[r];
    if (alternative.candidate) switched.on.push_back(*alternative.candidate);
    if (alternative.freed) switched.freed = alternative.freed;
  }
  return {problem_.data, surrogate, *weighting_, switched};
}

VectorXd Truth::coordinates() const {
  std::vector<double> strengths;
  for (const ActiveCandidate& e : active) strengths.push_back(e.strength);
  return coordinates_of(coded, strengths);
}

FitResult PseudoData::fit(const Choice& choice) const { return model(*surrogate_, choice).fit(problem_.observed); }

Truth PseudoData::truth(const Choice& choice, const FitResult& fit) const {
  Truth truth{fit.coded, model(*surrogate_, choice).active(fit), {}};
  for (const Index r : choice) truth.freed = std::max(truth.freed, problem_.alternatives[r].freed);
  return truth;
}

VectorXd PseudoData::drawn_theta(const Truth& truth, base::RandomStream& random) const {
  VectorXd u = truth.coded;
  for (Index i = 0; i < u.size(); ++i) {
    const Coordinate& c = problem_.data.theta[i];
    if (!c.nuisance() || i == truth.freed) continue;
    const double centre = c.coded(c.prior_mean), sigma = 1 / c.prior_weight();
    do u[i] = centre + sigma * random.normal();
    while (std::fabs(u[i]) > 1);  // the prior's mean lies within the range
  }
  return u;
}

double PseudoData::part_of(const LeftOut& left, const Truth& truth, double chance) const {
  const double wanted = truth.active.empty() ? 1 - chance + left.surrogate->leverage(truth.coded) : (1 - chance) * scatter_of(truth.active);
  return std::sqrt(wanted / (scatter_of(left.active) + left.leverage));
}

double PseudoData::reliability(const Truth& truth, const ActiveCandidate& candidate) const {
  const std::vector<ActiveCandidate> whole{{candidate.candidate, std::copysign(1.0, candidate.strength)}};
  const double square = (weighting_->whitener * (surrogate_->at(truth.coded, whole) - surrogate_->at(truth.coded))).squaredNorm();
  const double chance = weighting_->run_noise * surrogate_->leverage_of(truth.coded, whole);
  return square > 0 ? std::max(0.0, 1 - chance / square) : 1;
}

VectorXd PseudoData::rise(const Model& model, const Truth& truth, double least, const VectorXd& y) {
  const VectorXd t = truth.coordinates();
  VectorXd out(t.size());
  for (Index i = 0; i < t.size(); ++i) out[i] = model.fit_holding(i, t[i], y).q - least;
  return out;
}

PseudoData::Refit PseudoData::refit(const LeftOut& left, const Truth& truth, const std::vector<Choice>& choices) const {
  Refit out{&left, left.surrogate->coefficients(), {}, {}, {}};
  for (const Choice& choice : choices) out.models.push_back(model(*left.surrogate, choice));
  if (truth.active.empty()) return out;
  std::vector<Index> on;
  double both = 1;
  for (const ActiveCandidate& e : truth.active) {
    const double root = std::sqrt(reliability(truth, e));
    on.push_back(e.candidate);
    both *= root;
    out.coefficients.middleRows(features_->first(e.candidate), features_->count(e.candidate)) *= root;
  }
  if (on.size() == 2) {
    if (const auto product = features_->product(on[0], on[1])) out.coefficients.row(*product) *= both;
  }
  // Base and candidates of the truth are drawn again; the other candidates' coefficients move as they do with those on average.
  const std::vector<Index> columns = features_->columns(on);
  const MatrixXd& error = left.surrogate->coefficient_error();
  out.again = error(Eigen::all, columns) * root_of(error(columns, columns)).inverse;
  out.whitened = weighting_->whitener * out.coefficients.transpose();
  return out;
}

PseudoData::Drawn PseudoData::drawn(const Refit& refit, const Truth& truth, const Draws& how, std::size_t b) const {
  base::RandomStream random(options_.seed + how.stream, b);
  const Truth at{drawn_theta(truth, random), truth.active, truth.freed};
  const LeftOut& left = *refit.left;
  const Index n = left.deviation.size();
  const VectorXd y = refit.coefficients.transpose() * features_->all(at.coded, at.active) +
                     part_of(left, at, how.for_intervals ? 0 : chance_) * left.deviation + noise_.draw(random);
  std::vector<Model> again;
  if (refit.again.size() > 0) {
    const Index k = refit.again.cols();
    const MatrixXd normals = random.normals(k * n).reshaped(k, n);
    const MatrixXd whitened = refit.whitened + (run_white_ * normals.transpose()) * refit.again.transpose();
    for (const Model& fixed : refit.models) again.push_back(fixed.with(whitened));
  }
  const std::vector<Model>& models = again.empty() ? refit.models : again;
  Drawn out;
  for (const Model& model : models) out.fit.push_back(model.fit(y));
  const FitResult& found = out.fit.front();
  if (again.empty()) out.residual = y - refit.coefficients.transpose() * features_->all(found.coded, models.front().active(found));
  if (how.for_intervals) out.rise = rise(models.front(), at, found.q, y);
  return out;
}

std::vector<PseudoData::Drawn> PseudoData::draw(const Truth& truth, const std::vector<Choice>& choices, const Draws& how) const {
  const std::vector<const LeftOut*> runs = runs_for(truth, how.for_intervals);
  std::vector<Refit> refits(runs.size());
  base::for_each_item(refits.size(), base::worker_count(options_.threads, refits.size()),
                      [&](std::size_t r, std::size_t) { refits[r] = refit(*runs[r], truth, choices); });
  std::vector<Drawn> out(how.count);
  base::for_each_item(out.size(), base::worker_count(options_.threads, out.size()),
                      [&](std::size_t b, std::size_t) { out[b] = drawn(refits[b % refits.size()], truth, how, b); });
  return out;
}

}  // namespace millscope::naming
