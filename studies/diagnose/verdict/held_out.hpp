// Before and after, on conditions that were used for neither fit nor choice, against the rivals of the practice.
//
// The bank has simulations of these conditions, so that its surrogate predicts them. Where its left-out error is not below half of the
// difference that is judged (judge.hpp), both that differ are simulated, several seeds each. So is a
// fitted model that stands at an end of what was simulated. A name rests on simulations: where only the
// held-out conditions stand between the best candidate and its name, the corrected case, the base retuned to power and every rival that
// may be the strongest are simulated; so is a rival on which the prediction alone would not let it improve.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/diagnose/bank/bank.hpp"
#include "studies/diagnose/verdict/recorded_problem.hpp"

namespace millscope::diagnose {

/// The model of the practice.
inline const std::string kToPower = "retuned to power";

/// What one way of modelling says of a held-out condition.
struct Prediction {
  std::string name;        ///< "corrected", "retuned to power", …
  std::string sentence;    ///< what it is
  VectorXd theta;          ///< natural units; of what is computed, of what it is computed from
  VectorXd value;          ///< NaN: some of its simulations leave it undefined
  MatrixXd covariance;     ///< of the simulations' mean, or of the surrogate's error
  double power = 0;        ///< W; NaN: it is not among the observables, and nothing was simulated
  bool simulated = false;  ///< else it is the surrogate's
  bool computed = false;   ///< from that of the refitted base, which is `simulated` or not
  std::string failure;     ///< why none of its simulations came to its end; "" when some did
};

/// How far a difference is from what the surrogate gets wrong, in noise units.
struct Reliance {
  double difference = 0;  ///< what is judged
  double error = 0;       ///< of left-out runs, along it
  bool enough() const { return error < 0.5 * difference; }
};

struct Score {
  Prediction prediction;
  double misfit = 0;             ///< mean over the observables of rᵀ C⁻¹ r: about 1 when only chance differs, more as θ is off
  double power_percent = 0;      ///< (predicted − recorded)/recorded
  base::Interval90 improvement;  ///< its misfit − that of the corrected model
  Reliance reliance;             ///< on its difference from the corrected model; from the recording where there is none
};

struct HeldOut {
  std::size_t condition = 0;
  int simulations = 0;        ///< that were asked for
  VectorXd variance;          ///< of the recording's errors
  std::vector<Score> scores;  ///< corrected first, where there is one
  /// That a recording of the refitted base would look as bad. What the fitted recordings leave open of θ counts; of a predicted base the
  /// surrogate's error, too.
  double base_p = 1;
  double strict_base_p = 1;  ///< the same as if the surrogate did not err in this condition: what an alarm is not to be missed by
  std::vector<std::string> failures;
  std::vector<std::string> not_compared;  ///< observables that some prediction leaves undefined (NaN in its value)
  bool improves = false;                  ///< the interval against every rival model lies above 0
  bool contradicts = false;               ///< that against some rival model lies below 0

  /// Whether a name may rest on this: corrected model, base retuned to power and every rival that may be the strongest were simulated.
  bool rests_on_simulations() const;
};

/// "corrected, retuned to power simulated (12 simulations); effect removed predicted by the bank's surrogate".
std::string sources_sentence(const HeldOut& held);

/// θ that matches the powers of the fit conditions, nuisances at their priors' means (those varied apart as they are in the case), as near
/// the middle of the ranges as that allows: the practice.
VectorXd retuned_to_power(const naming::BankData& data, const naming::Surrogate& surrogate, const VectorXd& observed,
                          const MatrixXd& covariance, const std::vector<Index>& powers);

struct HeldOutRequest {
  const Question& question;
  const calibrate::Machinery& machinery;
  const Evidence& evidence;
  const Bank& bank;                ///< of all conditions
  const naming::Problem& problem;  ///< of the fit conditions
  const naming::Result& naming;
  std::vector<std::size_t> fit;
  bool at_stake = false;  ///< nothing but the held-out conditions stands between the best candidate and its name
  double alarm = 0.05;    ///< strict p of the base in a held-out condition, up to which it is simulated
  int seeds = 3;
  std::uint64_t seed = 1;
};

HeldOut hold_against(const HeldOutRequest& request, std::size_t condition);

/// Parameters fitted to one condition alone.
struct Alone {
  std::size_t condition = 0;
  std::vector<base::Interval90> before, after;  ///< θ of the base, and with what is named held at its value; natural units
};
std::vector<Alone> fit_alone(const HeldOutRequest& request);

}  // namespace millscope::diagnose
