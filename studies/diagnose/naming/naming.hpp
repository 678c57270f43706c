// Which physics the observations ask for: every candidate against the base, all refitted together with θ, judged by pseudo-data that are
// made of left-out runs of the bank. shared terms: Q and the surrogate of fit.hpp and surrogate.hpp.
//
// A pseudo-recording under a fitted model is what a surrogate makes of it, the deviation of the run of the bank that was left out of that
// surrogate, scaled to what a recording would have of it, and the recording's noise; nuisances are drawn from their priors, and where the
// model has an effect the bank's slopes are drawn again (pseudo_data.hpp has the equations). Everything is refitted to it with the left-out
// run's surrogate, so that the emulator's error is part of every p-value. Tests leave out ρ, the part of a run's deviation that is chance
// of its own, for the recording has its own. Intervals keep it, and come from runs with the model's effect alone where they are enough:
// what makes a model wrong in a recording is not all in the bank (docs/challenge.md has the coverage).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/diagnose/naming/fit.hpp"
#include "studies/diagnose/naming/noise.hpp"

namespace millscope::naming {

/// What may be named: a candidate, or a nuisance that leaves its prior.
struct Alternative {
  std::string name;
  std::optional<Index> candidate = {};      ///< of the bank
  std::optional<Index> freed = {};          ///< else: the coordinate whose prior does not count
  StrengthRange range = {};                 ///< of the candidate's strength, within which it is fitted
  std::optional<StrengthRange> prior = {};  ///< full strength is its end, where the fit may reach farther; of a nuisance coded
  std::vector<std::string> excludes = {};
  bool screened_out = false;  ///< its first runs showed that it cannot matter: it is not tested
};

/// Whether one of two, each with a name and what it excludes, rules the other out.
template <class Named>
bool exclude_each_other(const Named& one, const Named& other) {
  const auto excludes = [](const Named& a, const Named& b) {
    return std::find(a.excludes.begin(), a.excludes.end(), b.name) != a.excludes.end();
  };
  return excludes(one, other) || excludes(other, one);
}

/// Whether two may be there at once.
bool together(const Alternative& one, const Alternative& other);

/// What a fit of this alternative alone has on; nothing for a nuisance.
inline std::vector<ActiveCandidate> active_of(const Alternative& alternative, const FitResult& fit) {
  if (!alternative.candidate) return {};
  return {{*alternative.candidate, fit.strengths.front()}};
}

struct Problem {
  BankData data;
  std::vector<Alternative> alternatives;
  VectorXd observed;
  MatrixXd covariance;            ///< of the recording, block by condition
  std::vector<CommonSize> sizes;  ///< of its parts, as far as their size is not known exactly
};

/// Within which each candidate of the bank is fitted.
std::vector<StrengthRange> ranges_of(const Problem& problem);

/// Names of what of a fit stands at an end of what was simulated: candidates, parameters, nuisances. Not nuisances that are varied apart,
/// nor those of the camera: their range is all that is thought possible.
std::vector<std::string> ends_of(const Problem& problem, const VectorXd& coded, const std::vector<ActiveCandidate>& active);

struct Options {
  int draws = 2016;            ///< behind the null; 0: diagnose() takes as many as the level asks for
  int comparison_draws = 500;  ///< behind every comparison of two candidates
  double level = 0.05;         ///< for all candidates together
  double noise_units = 3;      ///< a candidate that does less, orthogonal to θ, cannot be seen
  std::uint64_t seed = 1;
  int threads = 0;
  std::function<void(const std::string&)> say;
};

inline constexpr double kNotWorkedOut = std::numeric_limits<double>::quiet_NaN();

/// Not known(): diagnosis.json has null ends.
inline base::Interval90 without_interval(double value) { return {value, kNotWorkedOut, kNotWorkedOut}; }

/// One candidate against the base.
struct Judged {
  FitResult fit;
  double delta_q = 0, p = 1, p_family = 1;
  double kappa = 0;         ///< part of what it does that θ cannot imitate, where it shows best: 0 is fully concealed
  double lambda = 0;        ///< visibility.hpp, about what was fitted with the candidate: where it shows best
  double lambda_found = 0;  ///< at the fitted strength
  std::vector<std::pair<double, double>> lambda_curve;  ///< (strength, λ), strengths rising; of candidates
  bool undetectable = false;
  int runs = 0;                          ///< of the bank with this candidate
  double lambda_beside = kNotWorkedOut;  ///< the same beside the best candidate, which is refitted as well; of others that may be there too
  bool tested = true;                    ///< else it has no runs, or its first ones showed that it cannot matter; its p are 1
  base::Interval90 strength;             ///< its interval is worked out when some candidate is significant
  std::vector<base::Interval90> theta;   ///< natural units; the same
  double goodness_p = kNotWorkedOut;     ///< whether the data look like a draw of this model; the same
  double against_best_p = 1;             ///< under this candidate: how often the best would be better by so much
};

/// One observable beside what the retuned base makes of it.
struct Mismatch {
  Index observable = 0;
  double base = 0;  ///< what the retuned base makes of it
  double z = 0;     ///< in standard deviations of the fitted base's residual
  double p = 1;     ///< for all observables together
};

struct Pair {
  Index first = 0, second = 0;  ///< alternatives
  FitResult fit;
  double p = 1;        ///< of the second beside the first
  double p_first = 1;  ///< of the first beside the second
  double goodness_p = 1;
};

struct Result {
  FitResult base;
  double base_p = 1;                         ///< whether the data look like a draw of the base
  std::vector<base::Interval90> base_theta;  ///< the retuned parameters
  std::vector<Judged> judged;                ///< one for each alternative
  std::vector<std::string> at_limit;         ///< parameters whose retuned value lies at an end of the bank's range
  std::optional<Index> best;                 ///< of the alternatives; nothing: none is significant
  std::vector<Index> kept;                   ///< the best and all that are not rejected against it
  std::vector<Pair> pairs;                   ///< at most one: two together
  std::vector<Mismatch> mismatch;            ///< the largest |z| first
  MatrixXd covariance;                       ///< Σ: recording and surrogate
  double chance = 0;                         ///< ρ, Surrogate::chance()
};

Result name_candidates(const Problem& problem, const Options& options);

}  // namespace millscope::naming
