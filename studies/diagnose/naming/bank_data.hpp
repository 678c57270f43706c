// What the numbers of a diagnosis are made of: simulations at parameter sets, with and without an effect, and what was seen of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace millscope::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

inline constexpr std::size_t kLeastTogether = 3;  ///< runs of a candidate with a nuisance apart, from which on their product is fitted
inline constexpr double kWideRange = 2;           ///< high over low, from which on a logarithm may serve better

/// With what the surrogate multiplies a coordinate, itself apart.
enum class Products { all, parameters, none };

/// One coordinate of θ: a parameter of the study, or a nuisance with a prior.
struct Coordinate {
  std::string name;
  double low = 0, high = 1;  ///< natural units; what the bank covers
  double prior_mean = 0;     ///< of a nuisance; the median of a logarithmic one
  double prior_sigma = 0;    ///< 0: flat over the range
  bool logarithmic = false;  ///< the surrogate is quadratic in its logarithm
  Products products = Products::all;
  std::optional<double> usual = {};  ///< of a nuisance that the bank varies apart: its value in all other runs
  bool nuisance() const { return prior_sigma > 0; }
  double coded(double natural) const;  ///< low → −1, high → 1
  double natural(double coded) const;
  double prior_weight() const;  ///< 1/σ in coded units; 0: flat
};

/// The effect of a candidate in a run: 0 is without, 1 the far end of its prior range, −1 the other end of a two-sided one.
struct Effect {
  int candidate = -1;
  double share = 0;
};

/// One parameter set of the bank, simulated in all conditions.
struct BankRow {
  VectorXd theta;  ///< natural units
  std::vector<Effect> effects;
};

/// The same in all but the seed.
bool repeats(const BankRow& a, const BankRow& b);

struct BankData {
  std::vector<Coordinate> theta;
  Index candidates = 0;
  std::vector<BankRow> rows;
  MatrixXd value;                          ///< rows × observables; those of all fit conditions side by side
  std::vector<int> condition;              ///< of each observable
  std::vector<std::string> left_out = {};  ///< finished runs that are not among the rows, and why

  VectorXd coded(const VectorXd& natural) const;
  VectorXd natural(const VectorXd& coded) const;
  /// Whether every nuisance apart has its usual value in a run.
  bool usual(const BankRow& row) const;
};

/// Which of the used rows, counted among themselves, repeat each other: each point once, with its runs.
std::vector<std::vector<Index>> points_of(const BankData& data, const std::vector<bool>& used);

}  // namespace millscope::diagnose
