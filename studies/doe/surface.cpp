// The second-order response surface: fit, lack of fit, values, least value in a box.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "kernel/base/error.hpp"
#include "studies/doe/least_squares.hpp"
#include "studies/doe/stationary.hpp"

namespace millscope::doe {
namespace {

using base::UserError;
using Index = Eigen::Index;

std::string name_of(const std::vector<int>& term, const std::vector<Factor>& factors) {
  if (term.empty()) return "1";
  const std::string& first = factors[term[0]].name;
  if (term.size() == 1) return first;
  return term[0] == term[1] ? first + "^2" : first + "*" + factors[term[1]].name;
}

std::vector<Coefficient> named_terms(const std::vector<Factor>& factors) {
  std::vector<Coefficient> terms;
  for (const auto& term : quadratic_terms(static_cast<int>(factors.size()))) {
    Coefficient c;
    c.name = name_of(term, factors);
    c.factors = term;
    terms.push_back(std::move(c));
  }
  return terms;
}

LeastSquares fit_terms(const Design& design, const Eigen::VectorXd& response, const std::vector<Coefficient>& terms) {
  Eigen::MatrixXd model(design.coded.rows(), static_cast<Index>(terms.size()));
  for (Index run = 0; run < model.rows(); ++run) model.row(run) = terms_at(terms, design.coded.row(run).transpose()).transpose();
  std::vector<std::string> names;
  for (const Coefficient& c : terms) names.push_back(c.name == "1" ? "the mean" : c.name);
  return solve(model, response, names);
}

void fill_coefficients(Surface& surface, const LeastSquares& fit, const Eigen::VectorXd& sequential) {
  for (std::size_t c = 0; c < surface.coefficients.size(); ++c) {
    const Index term = static_cast<Index>(c);
    Coefficient& coefficient = surface.coefficients[c];
    SumOfSquares line{partial_sum(fit, term), 1};
    test(line, surface.residual);
    coefficient.value = fit.coefficient[term];
    if (fit.df > 0) coefficient.standard_error = std::sqrt(fit.variance() * fit.inverse(term, term));
    coefficient.partial = line.value;
    coefficient.sequential = sequential[term];
    coefficient.F = line.F;
    coefficient.p = line.p;
  }
}

std::string lack_of_fit_sentence(const Surface& s, bool copies) {
  if (copies) {
    return "lack of fit cannot be tested: repeated runs agree to the last digit, so no error was measured (simulations repeated with one "
           "seed?)";
  }
  if (s.pure_error.df == 0) return "lack of fit cannot be tested: no run is repeated; repeat the centre";
  if (s.lack_of_fit.df == 0) return "lack of fit cannot be tested: as many different runs as terms; add runs elsewhere";
  const std::string found =
      fmt::format("lack of fit F({},{}) = {:.1f}, p = {:.2g}", s.lack_of_fit.df, s.pure_error.df, s.lack_of_fit.F, s.lack_of_fit.p);
  if (!s.rejected) return found + ": repeated runs scatter as the surface misses; nothing speaks against the quadratic";
  return found +
         ": the quadratic is rejected. It misses by more than repeated runs scatter (a kink, a higher order or a faulty run), so the F, p "
         "and standard "
         "errors above and the region below are not to be trusted; fit a smaller region, or what the response is made of";
}

/// Whether the model beats the mean at all.
void test_model(Surface& s) {
  s.model = {s.total.value - s.residual.value, static_cast<int>(s.coefficients.size()) - 1};
  test(s.model, s.residual);
  s.r_squared = 1 - s.residual.value / s.total.value;
  s.adjusted_r_squared = s.residual.df > 0 ? 1 - s.residual.mean_square() / s.total.mean_square() : kUndefined;
}

void split_error(Surface& s, const Design& design, const Eigen::VectorXd& response, const LeastSquares& fit) {
  const PureError split = split_residual(design.coded, response, fit);
  s.pure_error = split.pure;
  s.lack_of_fit = split.lack_of_fit;
  s.rejected = s.lack_of_fit.p < 1 - s.confidence;
  s.lack_of_fit_sentence = lack_of_fit_sentence(s, split.copies);
}

/// One way to hold factors of a box at an end or free, counted in base three: 0 low, 1 high, 2 free.
std::optional<Eigen::VectorXd> least_on_face(const Quadratic& q, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, int face) {
  Eigen::VectorXd point(q.linear.size());
  std::vector<Index> free;
  for (Index i = 0; i < q.linear.size(); ++i, face /= 3) {
    if (face % 3 == 2) free.push_back(i);
    point[i] = face % 3 == 0 ? lower[i] : face % 3 == 1 ? upper[i] : 0;
  }
  if (free.empty()) return point;
  const Eigen::VectorXd gradient = q.linear + 2 * q.form * point;
  const Eigen::LDLT<Eigen::MatrixXd> form(2 * q.form(free, free));
  if (form.info() != Eigen::Success || form.vectorD().minCoeff() <= 0) return std::nullopt;  // least at an end instead
  const Eigen::VectorXd found = form.solve(-gradient(free));
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double x = found[static_cast<Index>(i)];
    if (!(x >= lower[free[i]] && x <= upper[free[i]])) return std::nullopt;
    point[free[i]] = x;
  }
  return point;
}

}  // namespace

std::vector<std::vector<int>> quadratic_terms(int factors) {
  std::vector<std::vector<int>> terms{{}};
  for (int i = 0; i < factors; ++i) terms.push_back({i});
  for (int i = 0; i < factors; ++i) terms.push_back({i, i});
  for (int i = 0; i < factors; ++i) {
    for (int j = i + 1; j < factors; ++j) terms.push_back({i, j});
  }
  return terms;
}

Surface fit_surface(const Design& design, const Eigen::VectorXd& response, double confidence) {
  if (!(confidence > 0 && confidence < 1)) throw UserError(fmt::format("confidence {}: give a share between 0 and 1", confidence));
  check(design, response);
  Surface s;
  s.factors = design.factors;
  s.confidence = confidence;
  s.coefficients = named_terms(design.factors);
  const LeastSquares fit = fit_terms(design, response, s.coefficients);
  s.covariance = fit.df > 0 ? Eigen::MatrixXd(fit.variance() * fit.inverse)
                            : Eigen::MatrixXd::Constant(fit.inverse.rows(), fit.inverse.cols(), kUndefined);
  s.residual = {fit.residual_sum, fit.df};
  s.total = {(response.array() - response.mean()).square().sum(), static_cast<int>(response.size()) - 1};
  fill_coefficients(s, fit, sequential_sums(fit.model, response));
  test_model(s);
  split_error(s, design, response, fit);
  s.lower = design.coded.colwise().minCoeff().transpose();
  s.upper = design.coded.colwise().maxCoeff().transpose();
  s.stationary = find_stationary(s);
  s.residuals = residuals_of(fit);
  if (s.model.p > 1 - confidence) {
    s.notes.push_back(
        fmt::format("the surface is not significantly better than the mean (p = {:.2g}): its shape may be chance", s.model.p));
  }
  if (fit.df > 0 && fit.residual_sum == 0)
    s.notes.push_back("the model fits exactly: no error is left to measure, and no F or p means anything");
  if (fit.df == 0) s.notes.push_back("no degrees of freedom are left for the residual: no standard errors, F and p; add or repeat runs");
  return s;
}

double value_at(const Surface& surface, const Eigen::VectorXd& coded) {
  const Eigen::VectorXd terms = terms_at(surface.coefficients, coded);
  double value = 0;
  for (std::size_t c = 0; c < surface.coefficients.size(); ++c) value += terms[static_cast<Index>(c)] * surface.coefficients[c].value;
  return value;
}

double standard_error_at(const Surface& surface, const Eigen::VectorXd& coded) {
  const Eigen::VectorXd terms = terms_at(surface.coefficients, coded);
  return std::sqrt(terms.dot(surface.covariance * terms));
}

// A quadratic is least in a box where its gradient vanishes along the free factors of some face: all 3^k faces are tried.
Eigen::VectorXd least_within(const Surface& surface, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Index count = static_cast<Index>(surface.factors.size());
  if (count > 8) throw UserError(fmt::format("{} factors; the least value in a box is found for at most eight", count));
  if (lower.size() != count || upper.size() != count || !(lower.array() <= upper.array()).all()) {
    throw UserError("the box has an upper end below its lower one, or not one pair of ends for each factor");
  }
  const Quadratic q = quadratic_of(surface);
  Eigen::VectorXd best;
  int faces = 1;
  for (Index i = 0; i < count; ++i) faces *= 3;
  for (int face = 0; face < faces; ++face) {
    const auto point = least_on_face(q, lower, upper, face);
    if (point && (best.size() == 0 || value_at(surface, *point) < value_at(surface, best))) best = *point;
  }
  return best;
}

}  // namespace millscope::doe
