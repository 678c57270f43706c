#include "studies/doe/least_squares.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "kernel/base/error.hpp"

namespace millscope::doe {
namespace {

using base::UserError;
using Index = Eigen::Index;

constexpr double kNothing = 1e-12;  // relative to a sum of squares: rounding, not error

double about_mean(const Eigen::VectorXd& y) { return (y.array() - y.mean()).square().sum(); }

void check_factor(const Design& design, Index i) {
  const std::string& name = design.factors[i].name;
  const Eigen::VectorXd x = design.coded.col(i);
  if ((x.array() == x[0]).all()) throw UserError(fmt::format("factor {} has one value in all runs; leave it out or vary it", name));
  for (Index j = 0; j < i; ++j) {
    const Eigen::VectorXd z = design.coded.col(j);
    const double together = (x.array() - x.mean()).matrix().dot((z.array() - z.mean()).matrix());
    if (together * together < about_mean(x) * about_mean(z) * (1 - 1e-10)) continue;
    throw UserError(fmt::format("factors {} and {} vary together in all runs, so that their effects cannot be told apart; leave one out",
                                design.factors[j].name, name));
  }
}

/// The first term that the others before it in pivot order combine to, and those terms.
std::string dependent_term(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, const Eigen::MatrixXd& scaled,
                           const std::vector<std::string>& names) {
  const Index rank = qr.rank();
  const auto& order = qr.colsPermutation().indices();
  Eigen::MatrixXd independent(scaled.rows(), rank);
  for (Index c = 0; c < rank; ++c) independent.col(c) = scaled.col(order[c]);
  const Eigen::VectorXd share = independent.colPivHouseholderQr().solve(scaled.col(order[rank]));
  std::string of;
  for (Index c = 0; c < rank; ++c) {
    if (std::abs(share[c]) > 1e-6) of += (of.empty() ? "" : ", ") + names[order[c]];
  }
  const std::string& term = names[order[rank]];
  return of.empty() ? fmt::format("{} is zero in all runs", term) : fmt::format("{} is a combination of {}", term, of);
}

std::vector<double> key_of(const Eigen::MatrixXd& coded, Index run) {
  std::vector<double> key;
  for (Index i = 0; i < coded.cols(); ++i) key.push_back(std::round(coded(run, i) * 1e9) + 0.0);
  return key;
}

}  // namespace

void check(const Design& design, const Eigen::VectorXd& response) {
  check(design.factors);
  if (design.coded.cols() != static_cast<Index>(design.factors.size())) {
    throw UserError(fmt::format("{} columns of coded values for {} factors", design.coded.cols(), design.factors.size()));
  }
  if (design.coded.rows() != response.size()) {
    throw UserError(fmt::format("{} responses for {} runs; one belongs to each", response.size(), design.coded.rows()));
  }
  if (response.size() < 2) throw UserError(fmt::format("{} runs; a fit takes at least two", response.size()));
  for (Index run = 0; run < response.size(); ++run) {
    if (!std::isfinite(response[run]) || !design.coded.row(run).allFinite()) {
      throw UserError(fmt::format("run {}: a value is not finite; leave the run out or repeat it", run + 1));
    }
  }
  for (Index i = 0; i < design.coded.cols(); ++i) check_factor(design, i);
  if ((response.array() == response[0]).all()) {
    throw UserError(
        fmt::format("the response is {} in all runs: there is nothing to explain; choose another response or wider steps", response[0]));
  }
}

LeastSquares solve(const Eigen::MatrixXd& model, const Eigen::VectorXd& response, const std::vector<std::string>& names) {
  if (model.rows() < model.cols()) {
    throw UserError(fmt::format("{} runs for {} terms; add runs or choose a smaller model", model.rows(), model.cols()));
  }
  const Eigen::VectorXd length = model.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = model * length.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
  qr.setThreshold(1e-9);
  if (qr.rank() < model.cols()) {
    throw UserError(
        fmt::format("these runs cannot tell all terms apart: {}; add runs or choose a smaller model", dependent_term(qr, scaled, names)));
  }
  LeastSquares fit;
  fit.model = model;
  const Eigen::MatrixXd inverse = (scaled.transpose() * scaled).inverse();
  fit.inverse = length.cwiseInverse().asDiagonal() * inverse * length.cwiseInverse().asDiagonal();
  fit.coefficient = qr.solve(response).cwiseQuotient(length);
  fit.coefficient =
      (fit.coefficient.cwiseProduct(length).array().abs() < kNothing * response.norm()).select(0, fit.coefficient);  // rounding
  fit.error = response - model * fit.coefficient;
  fit.residual_sum = fit.error.squaredNorm();
  fit.df = static_cast<int>(model.rows() - model.cols());
  if (fit.residual_sum <= kNothing * kNothing * response.squaredNorm()) fit.residual_sum = 0;  // an exact fit, but for rounding
  return fit;
}

Eigen::VectorXd sequential_sums(const Eigen::MatrixXd& model, const Eigen::VectorXd& response) {
  Eigen::VectorXd rotated = response;
  rotated.applyOnTheLeft(Eigen::HouseholderQR<Eigen::MatrixXd>(model).householderQ().adjoint());
  return rotated.head(model.cols()).array().square();
}

double partial_sum(const LeastSquares& fit, Index term) { return fit.coefficient[term] * fit.coefficient[term] / fit.inverse(term, term); }

void test(SumOfSquares& line, const SumOfSquares& against) {
  if (line.df < 1 || against.df < 1) return;
  line.F = against.value > 0 ? line.mean_square() / against.mean_square() : std::numeric_limits<double>::infinity();
  line.p = f_beyond(line.F, line.df, against.df);
}

PureError split_residual(const Eigen::MatrixXd& coded, const Eigen::VectorXd& response, const LeastSquares& fit) {
  std::map<std::vector<double>, std::vector<double>> groups;
  for (Index run = 0; run < coded.rows(); ++run) groups[key_of(coded, run)].push_back(response[run]);
  PureError split;
  for (const auto& [point, values] : groups) {
    split.pure.value += about_mean(Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size())));
    split.pure.df += static_cast<int>(values.size()) - 1;
  }
  split.copies = split.pure.df > 0 && split.pure.value <= kNothing * about_mean(response);
  split.lack_of_fit = {std::max(0.0, fit.residual_sum - split.pure.value), fit.df - split.pure.df};
  if (!split.copies) test(split.lack_of_fit, split.pure);
  return split;
}

// t_i = e_i √((ν − 1)/(S (1 − h_i) − e_i²)), ν and S those of the residual (Cook, Weisberg 1982).
std::vector<Residual> residuals_of(const LeastSquares& fit) {
  std::vector<Residual> residuals(fit.error.size());
  for (Index run = 0; run < fit.error.size(); ++run) {
    Residual& r = residuals[run];
    r.value = fit.error[run];
    r.leverage = fit.model.row(run).dot(fit.inverse * fit.model.row(run).transpose());
    const double others = fit.residual_sum * (1 - r.leverage) - r.value * r.value;
    if (fit.df < 2 || r.leverage > 1 - 1e-9 || fit.residual_sum <= 0) continue;
    r.studentised = others > kNothing * fit.residual_sum ? r.value * std::sqrt((fit.df - 1) / others)
                                                         : std::copysign(std::numeric_limits<double>::infinity(), r.value);
    r.p = std::min(1.0, static_cast<double>(fit.error.size()) * t_beyond(r.studentised, fit.df - 1));
    r.stands_out = std::abs(r.studentised) > kStandsOut;
  }
  return residuals;
}

double t_beyond(double value, int df) {
  if (std::isinf(value)) return 0;
  return 2 * boost::math::cdf(boost::math::complement(boost::math::students_t(df), std::abs(value)));
}

double t_quantile(double p, int df) { return boost::math::quantile(boost::math::complement(boost::math::students_t(df), p / 2)); }

double f_beyond(double value, int df, int against) {
  if (std::isinf(value)) return 0;
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(df, against), value));
}

double f_quantile(double p, int df, int against) {
  return boost::math::quantile(boost::math::complement(boost::math::fisher_f(df, against), p));
}

}  // namespace millscope::doe
