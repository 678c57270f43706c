// One emulator for the whole bank: quadratic in θ; for each candidate quadratic in its strength or, where that serves better, cubic or
// quartic, and linear in its products with the fitted parameters and with the nuisances that are varied apart; for two candidates that have
// runs together the product of their strengths. All observables share the runs, so that one factorisation serves them all.
//
//   m(u, s) = b₀ + Σ b_i u_i + Σ b_ij u_i u_j + Σ_j (c_j s_j + d_j s_j² + … + Σ_i e_ji s_j u_i) + Σ f_jk s_j s_k,  u: coded θ, s: strengths
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "studies/diagnose/naming/bank_data.hpp"

namespace millscope::naming {

/// A feature: the product of two factors, which are counted 1, coordinates, strengths of all candidates, squares of these.
struct Product {
  Index one = 0, other = 0;
};

/// Which columns the model has.
class Features {
 public:
  explicit Features(const BankData& data);

  Index size() const { return std::ssize(products_); }
  Index coordinates() const { return coordinates_; }
  Index candidates() const { return candidates_; }
  Index base_size() const { return base_size_; }
  /// First column of a candidate's block and its length; 0: the bank has no run with it.
  Index first(Index candidate) const { return first_[candidate]; }
  Index count(Index candidate) const { return count_[candidate]; }
  const Product& of_column(Index column) const { return products_[column]; }
  Index factors() const { return 1 + coordinates_ + 2 * candidates_; }
  Index factor_of_coordinate(Index i) const { return 1 + i; }
  Index factor_of_strength(Index candidate) const { return 1 + coordinates_ + candidate; }
  Index factor_of_square(Index candidate) const { return 1 + coordinates_ + candidates_ + candidate; }
  VectorXd all(const VectorXd& coded, const std::vector<ActiveCandidate>& active) const;
  /// Column of the product of two candidates' strengths; nothing: too few runs have both.
  std::optional<Index> product(Index a, Index b) const;
  /// The strengths of a candidate's runs, with 0: lowest and highest.
  const std::pair<double, double>& ends(Index candidate) const { return ends_[candidate]; }
  /// Which runs scatter alike: those with the same candidates on. Nothing: with none, or with two that have no product.
  std::optional<Index> group(const std::vector<ActiveCandidate>& active) const;
  Index groups() const { return candidates() + std::ssize(together_); }
  /// Columns of all products.
  std::vector<Index> product_columns() const;
  /// Of all columns those of the base, of some candidates one after the other, and where they are two of their product.
  std::vector<Index> columns(const std::vector<Index>& candidates) const;

 private:
  void add_candidate(const BankData& data, Index candidate);
  void add_both(const BankData& data);

  Index base_size_ = 0, coordinates_ = 0, candidates_ = 0;
  std::vector<Product> products_;  ///< of columns
  std::vector<Index> first_, count_;
  std::vector<std::pair<double, double>> ends_;
  std::map<std::pair<Index, Index>, Index> together_;  ///< of two candidates, the lower first: column of their product
};

class Surrogate {
 public:
  /// Least squares on the rows where `used` is true. Throws base::UserError when they are fewer than the coefficients.
  Surrogate(const BankData& data, Features features, const std::vector<bool>& used);
  /// On all rows, with all features that they support.
  explicit Surrogate(const BankData& data);

  VectorXd at(const VectorXd& coded, const std::vector<ActiveCandidate>& active = {}) const;
  /// Covariance of the coefficients' errors over S: runs that scatter more tell less. Features × features.
  const MatrixXd& coefficient_error() const { return coefficient_error_; }
  /// By how much larger than S the covariance of runs with these candidates is, at least 1.
  double scatter_of(const std::vector<ActiveCandidate>& active) const;
  /// Variance of the prediction over that of one run's residual without a candidate.
  double leverage(const VectorXd& coded, const std::vector<ActiveCandidate>& active = {}) const;
  /// The same of the difference that candidates make, beside others or alone.
  double leverage_of(const VectorXd& coded, const std::vector<ActiveCandidate>& active,
                     const std::vector<ActiveCandidate>& beside = {}) const;
  const MatrixXd& coefficients() const { return coefficients_; }  ///< features × observables
  const Features& features() const { return features_; }
  Index degrees() const { return degrees_; }  ///< points − coefficients
  /// Row residuals, each from a fit without that row: (y − m)/(1 − h).
  const MatrixXd& left_out() const { return left_out_; }
  /// S, covariance of one run without a candidate about the surface: the runs' chance and what the surface cannot follow; that of
  /// runs with some is scatter_of() times as large. Correlations are shrunk in coordinates in which the recording's noise has none.
  MatrixXd residual_covariance(const MatrixXd& recording) const;
  /// ρ, the part of S that is chance, of which a recording has its own instead: by what runs of equal parameters and other seeds differ
  /// (pure error; Montgomery 2013, ch. 10). The low end of its 90 % interval, over all observables or in the span of what coordinates
  /// and candidates do, whichever is lower: what a surface cannot follow there would pass for a candidate. 0: no run is repeated.
  double chance(const MatrixXd& recording) const;
  /// Orthonormal, in units of a whitener: what every coordinate does, every candidate at the ends of its strengths, and every two that were
  /// simulated together.
  MatrixXd span(const MatrixXd& whitener) const;
  /// Covariance of the surrogate's error, (1 − ρ + h̄) S with the mean leverage h̄ of the runs without a candidate.
  MatrixXd error_covariance(const MatrixXd& recording) const;
  /// The same of one prediction, ((1 − ρ) e + h) S with its own leverage h and the scatter e of runs with what is active.
  MatrixXd error_covariance(const MatrixXd& recording, const VectorXd& coded, const std::vector<ActiveCandidate>& active) const;

 private:
  Features features_;
  void keep_scatter(const std::vector<std::vector<Index>>& points, const MatrixXd& y, const VectorXd& scatter);

  MatrixXd coefficients_, coefficient_error_, residual_, left_out_;
  std::vector<double> scatter_with_;  ///< of groups
  MatrixXd scatter_;                  ///< [points, observables], as of runs without a candidate
  MatrixXd repeated_;                 ///< runs about the mean of those at their point
  double mean_leverage_ = 0;
  Index degrees_ = 0, degrees_repeated_ = 0;
};

/// What the runs with a candidate, or those without any, differ by from the surrogate of all others, which has none of their repeats
/// either: [runs, observables]. The chance of single runs is in it. No rows where the others would be too few.
MatrixXd left_out_deviations(const BankData& data, std::optional<Index> candidate);

/// Chooses for every positive coordinate with a range of a factor of 2 or more whether its logarithm serves better, and for every candidate
/// with enough runs the degree in its strength: the surely smaller sum of squared left-out residuals, each over its run's scatter, in the
/// span of what coordinates and candidates do, in noise units of the recording and of a run. There an error would pass for a candidate.
void choose_terms(BankData& data, const MatrixXd& recording);

}  // namespace millscope::naming
