// What is learnt from: runs of a model at parameter sets, without and with candidates, and what was seen of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace millscope::naming {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

inline constexpr Index kLeastTogether = 3;  ///< runs of a candidate with a nuisance varied apart, for their product to be fitted
inline constexpr double kWideRange = 2;     ///< high over low, from which on a logarithm may serve better

/// With what the surrogate multiplies a coordinate, beside itself.
enum class Products { all, parameters, none };

/// One coordinate of θ: a parameter of the study, or a nuisance with a prior.
struct Coordinate {
  std::string name;
  double low = 0, high = 1;  ///< natural units; what the bank covers
  double prior_mean = 0;     ///< of a nuisance; the median of a logarithmic one
  double prior_sigma = 0;    ///< 0: flat over the range
  bool logarithmic = false;  ///< the surrogate is quadratic in its logarithm
  Products products = Products::all;
  std::optional<double> usual = {};  ///< of a nuisance that is varied apart, in runs of its own: its value in all others
  bool nuisance() const { return prior_sigma > 0; }
  double coded(double natural) const;  ///< low → −1, high → 1
  double natural(double coded) const;
  double prior_weight() const;  ///< 1/σ in coded units; 0: flat
};

/// A candidate that is on, and how strongly: 0 is without it, 1 the far end of its prior range, −1 the other end of a two-sided one.
struct ActiveCandidate {
  Index candidate = 0;
  double strength = 0;
};

/// One run of the bank.
struct BankRow {
  VectorXd theta;  ///< natural units
  std::vector<ActiveCandidate> active;

  /// The first that is on; nothing: none is.
  std::optional<Index> candidate() const { return active.empty() ? std::nullopt : std::optional(active.front().candidate); }
};

/// The same in all but the seed.
bool repeats(const BankRow& a, const BankRow& b);

struct BankData {
  std::vector<Coordinate> theta;
  Index candidates = 0;
  std::vector<int> degree = {};  ///< of the surrogate in each candidate's strength, 2 to 4; empty: 2 for all
  std::vector<BankRow> rows;
  MatrixXd value;                          ///< rows × observables
  std::vector<Index> condition;            ///< under which each observable was seen; a label
  std::vector<std::string> left_out = {};  ///< finished runs that are not among the rows, and why

  VectorXd coded(const VectorXd& natural) const;
  VectorXd natural(const VectorXd& coded) const;
  /// Whether every nuisance that is varied apart has its usual value in a run.
  bool usual(const BankRow& row) const;
};

/// Which of the used rows, counted among themselves, repeat each other: each point once, with its runs.
std::vector<std::vector<Index>> points_of(const BankData& data, const std::vector<bool>& used);

/// All rows but one and those that repeat it.
std::vector<bool> all_but(const BankData& data, std::size_t row);

}  // namespace millscope::naming
