// Design of experiments: plans of runs, what two-level plans say of each factor, second-order surfaces and their stationary point.
//
//   const Design plan = two_level({{"CRPP", 0.5, 0.2, ""}, {"CFPP", 0.5, 0.2, ""}, {"CRPG", 0.5, 0.2, ""}, {"CFPG", 0.5, 0.2, ""}},
//                                 {"CFPG=CRPP*CFPP*CRPG"}, 3);                     // 8 + 3 runs, resolution IV
//   const Anova anova = analyze_two_level(plan, objective);                        // one number for each run
//   const auto path = steepest_descent(anova, 0.5, 4);                             // where to look next
//   const Surface surface = fit_surface(central_composite(factors, rotatable(2), 5), objective);
//
// Factors are coded: natural = centre + step · coded. All functions are pure; what the user can put right is thrown as base::UserError.
// Methods: Montgomery, Design and Analysis of Experiments, 8th ed. 2013; Box, Hunter, Biometrika 41 (1954) 190 (confidence region).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace millscope::doe {

inline constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kConfidence = 0.95;  ///< of intervals and regions, unless told otherwise
/// A run whose externally studentised residual is larger than this stands out.
inline constexpr double kStandsOut = 3;

struct Factor {
  std::string name;
  double centre = 0, step = 1;  ///< natural = centre + step · coded, step > 0
  std::string unit = {};        ///< of the natural value, for tables
};

struct Design {
  std::vector<Factor> factors;
  Eigen::MatrixXd coded;             ///< [runs, factors]
  std::vector<std::string> kind;     ///< of each run: "factorial", "centre", "axial" or "spread"
  std::string resolution;            ///< "full", "III", "IV", …; "irregular"; "" where the notion has no meaning
  std::vector<std::string> aliases;  ///< chains up to two-factor interactions: "CRPP*CFPP = CRPG*CFPG"; "A = -B*C" where the sign turns
};

/// Between coded and natural values of all factors, one point.
Eigen::VectorXd natural(const std::vector<Factor>& factors, const Eigen::VectorXd& coded);
Eigen::VectorXd coded(const std::vector<Factor>& factors, const Eigen::VectorXd& natural);

// ---- Designs ---------------------------------------------------------------------------------------------------------------------------

/// Two levels, −1 and +1, in standard order (the first factor turns fastest), then `centre_points` runs at 0. `generators` make a fraction:
/// "CFPG=CRPP*CFPP*CRPG", "D=-A*B"; none: the full factorial. Refused: unknown or repeated names, factors generated from generated ones,
/// fractions that confound two factors or a factor with the mean.
Design two_level(std::vector<Factor> factors, const std::vector<std::string>& generators, int centre_points);

/// Axial distance of equal precision in all directions: (2^k)^(1/4).
double rotatable(int factors);
inline constexpr double kFaceCentred = 1;

/// The full factorial, two axial runs a factor at ±axial_distance (coded), `centre_points` runs at 0. At least two factors.
Design central_composite(std::vector<Factor> factors, double axial_distance, int centre_points);

/// One run in each of `runs` layers of every factor; of 100 seeded draws the one whose closest two runs are farthest apart (maximin).
Design latin_hypercube(std::vector<Factor> factors, int runs, std::uint64_t seed);

/// The first `runs` points of Sobol's sequence without its first point, the corner; coded in (−1, 1).
Design sobol(std::vector<Factor> factors, int runs);

// ---- Analysis of variance --------------------------------------------------------------------------------------------------------------

/// A line of an analysis of variance. F, p and confidence are NaN where nothing is left to test against.
struct SumOfSquares {
  double value = 0;
  int df = 0;
  double mean_square() const { return df > 0 ? value / df : kUndefined; }
  double F = kUndefined, p = kUndefined;       // NOLINT(readability-identifier-naming): F is its name
  double confidence() const { return 1 - p; }  ///< the level at which the line is significant
};

struct Effect {
  std::string name;          ///< "CFPP", "CRPP*CFPP"
  std::string alias;         ///< what the estimate stands for besides, "CRPG*CFPG"; empty: nothing up to two-factor interactions
  std::vector<int> factors;  ///< which ones
  double value = 0;          ///< mean at +1 less mean at −1 = twice the coefficient
  double standard_error = kUndefined;
  SumOfSquares sum;     ///< partial: what the residual grows by without the term
  bool pooled = false;  ///< not in the model: part of the residual
};

/// One run against the model.
struct Residual {
  double value = 0;                 ///< observed less fitted
  double leverage = 0;              ///< diagonal of the hat matrix
  double studentised = kUndefined;  ///< externally: the run itself does not enter the variance; t with residual df − 1
  double p = kUndefined;            ///< of so large a one among all runs (Bonferroni)
  bool stands_out = false;          ///< |studentised| > kStandsOut
};

enum class TwoLevelModel { main_effects, interactions };

struct Anova {
  std::vector<Factor> factors;
  TwoLevelModel model = TwoLevelModel::main_effects;
  double mean = 0;                        ///< fitted value at the mean of the factorial runs
  std::vector<Effect> effects;            ///< main effects in the order of the factors, then two-factor interactions (one a chain)
  std::optional<SumOfSquares> curvature;  ///< factorial runs against centre runs; nothing without centre runs
  SumOfSquares residual, total;           ///< total: about the mean
  SumOfSquares pure_error, lack_of_fit;   ///< parts of the residual; df 0: no replicates, or nothing beside them
  std::vector<Residual> residuals;
  std::vector<std::string> notes;  ///< what the figures are not good for
};

/// Effects, sums of squares, F and p of a two-level plan with or without centre runs (and replicates). Interactions that are not in the
/// model are estimated all the same and shown as pooled. `response`: one value a run. Refused: factors that do not vary or vary together,
/// a response that does not vary, values that are not finite, fewer runs than coefficients.
Anova analyze_two_level(const Design& design, const Eigen::VectorXd& response, TwoLevelModel model = TwoLevelModel::main_effects);

/// Coded points: the centre, then `steps` steps against the gradient of the main effects; in each the factor with the largest
/// effect moves by `coded_step_of_the_largest`. Factors whose effect has p > `largest_p` stay at the centre.
std::vector<Eigen::VectorXd> steepest_descent(const Anova& anova, double coded_step_of_the_largest, int steps, double largest_p = 1);

// ---- Second-order response surface -----------------------------------------------------------------------------------------------------

struct Coefficient {
  std::string name;          ///< "1", "CFPP", "CFPP^2", "CFPP*CRPG"
  std::vector<int> factors;  ///< {}, {0}, {0, 0}, {0, 1}
  double value = 0, standard_error = kUndefined;
  double partial = kUndefined;            ///< sum of squares that the residual grows by without the term
  double sequential = kUndefined;         ///< sum of squares that the term adds to those before it
  double F = kUndefined, p = kUndefined;  // NOLINT(readability-identifier-naming): F is its name
};

enum class StationaryKind { minimum, maximum, saddle, ridge };
const char* name_of(StationaryKind kind);

/// A principal axis of the quadratic form.
struct Axis {
  double curvature = 0, standard_error = kUndefined;  ///< eigenvalue; standard error by the delta method
  Eigen::VectorXd direction;                          ///< coded, unit length
  bool flat = false;                                  ///< the curvature cannot be told from zero
};

/// Box and Hunter 1954: the points whose gradient cannot be told from zero, as far as the plan's runs reach.
struct StationaryRegion {
  double confidence = kConfidence;
  Eigen::VectorXd low, high;  ///< coded ends along each factor; NaN: no point of the region in the range of the runs
  std::vector<bool> bounded;  ///< false: the region reaches the end of the runs' range, so the data do not bound this factor
  double share = kUndefined;  ///< of the box that the runs span
};

struct StationaryPoint {
  Eigen::VectorXd coded, natural;
  double value = 0;
  StationaryKind kind = StationaryKind::ridge;
  std::vector<Axis> axes;  ///< flattest first
  bool inside = false;     ///< of the box that the runs span
  std::optional<StationaryRegion> region;
  std::string sentence;  ///< kind, place and what is not determined, in plain words
};

struct Surface {
  std::vector<Factor> factors;
  std::vector<Coefficient> coefficients;  ///< 1, linear, squares, products
  Eigen::MatrixXd covariance;             ///< of the coefficients, by the residual
  SumOfSquares model, residual, total;
  SumOfSquares pure_error, lack_of_fit;  ///< df 0: not testable
  std::string lack_of_fit_sentence;      ///< the verdict and its consequence
  bool rejected = false;                 ///< lack of fit at p < 1 − confidence
  double r_squared = 0, adjusted_r_squared = 0;
  double confidence = kConfidence;
  Eigen::VectorXd lower, upper;               ///< coded box that the runs span
  std::optional<StationaryPoint> stationary;  ///< nothing where all second-order coefficients vanish
  std::vector<Residual> residuals;
  std::vector<std::string> notes;
};

/// The full quadratic in all factors by least squares. Refused: what `analyze_two_level` refuses, and plans on which a term is
/// a combination of others (a two-level plan has no squares).
Surface fit_surface(const Design& design, const Eigen::VectorXd& response, double confidence = kConfidence);

/// Fitted value and its standard error at a coded point.
double value_at(const Surface& surface, const Eigen::VectorXd& coded);
double standard_error_at(const Surface& surface, const Eigen::VectorXd& coded);

/// The coded point of a box at which the fitted surface is least; exact, whatever the kind of the stationary point. At most eight factors.
Eigen::VectorXd least_within(const Surface& surface, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace millscope::doe
