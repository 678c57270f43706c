// Before and after, on conditions that were used for neither fit nor choice: real simulations, several seeds each, against the rivals of
// the practice.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/diagnose/bank/bank.hpp"
#include "studies/diagnose/verdict/recorded_problem.hpp"

namespace millscope::diagnose {

/// What one way of modelling says of a held-out condition.
struct Prediction {
  std::string name;      ///< "corrected", "retuned to power", …
  std::string sentence;  ///< what it is
  VectorXd value;        ///< NaN: some of its simulations leave it undefined
  MatrixXd covariance;   ///< of the simulations' mean
  double power = 0;      ///< W
  bool simulated = true;
  std::string failure;  ///< why none of its simulations came to its end; "" when some did
};

struct Score {
  Prediction prediction;
  double misfit = 0;             ///< mean over the observables of rᵀ C⁻¹ r: about 1 when only chance differs
  double power_percent = 0;      ///< (predicted − recorded)/recorded
  base::Interval90 improvement;  ///< its misfit − that of the corrected model
};

struct HeldOut {
  std::size_t condition = 0;
  std::vector<Score> scores;  ///< corrected first, where there is one
  double base_p = 1;          ///< that a recording of the refitted base looks as bad
  std::vector<std::string> failures;
  std::vector<std::string> not_compared;  ///< observables that some prediction leaves undefined (NaN in its value)
  bool improves = false;                  ///< the interval against every rival model lies above 0
  bool contradicts = false;               ///< that against some rival model lies below 0
};

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
