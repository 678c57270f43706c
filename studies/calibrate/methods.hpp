// The three ways from a study to a parameter set, and what the data say of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "studies/calibrate/evaluator.hpp"
#include "studies/campaign/doubts.hpp"
#include "studies/doe/doe.hpp"
#include "studies/emulate/posterior.hpp"

namespace millscope::calibrate {

/// A design that was run; rows whose simulations failed are left out.
struct RunDesign {
  doe::Design design;
  std::vector<std::size_t> parameters;  ///< of the study, one for each factor
  std::vector<Trial> trials;            ///< one for each row
  Eigen::VectorXd response;
};

struct Screening {
  RunDesign run;
  doe::Anova anova;
  std::vector<std::size_t> kept;  ///< factors that go on, the largest effect first
};

struct Composite {
  RunDesign run;
  doe::Surface surface;
};

/// What the observables say of all parameters, from an emulator of every simulation that was run.
struct Inference {
  emulate::Posterior posterior;
  std::vector<emulate::Profile> profiles;  ///< one for each parameter
  emulate::Diagnostics diagnostics;
  std::vector<std::string> observables;  ///< "dry75: power", in the order of the columns
};

struct Calibration {
  Eigen::VectorXd best;          ///< the calibrated set
  std::string how;               ///< where it comes from, one sentence
  std::optional<Trial> at_best;  ///< its simulation, where the budget had room for it
  double predicted = 0;          ///< objective that surface or emulator promise there; NaN: neither was asked
  std::optional<Screening> screening;
  std::vector<Trial> descent;
  std::optional<Composite> composite;
  std::optional<Inference> inference;
  std::vector<std::string> notes;
  std::vector<campaign::SharedDoubt> doubts;  ///< of all simulations that were used
};

/// Fractional factorial with centre points → ANOVA → steepest descent → central composite design → quadratic surface → optimum.
Calibration response_surface(Evaluator& evaluator);
/// Spread start → emulator of the observables → points of largest expected improvement until the budget is spent → optimum.
Calibration by_emulator(Evaluator& evaluator);
/// Covariance matrix adaptation: no emulator between simulation and search.
Calibration by_cma_es(Evaluator& evaluator);

/// The posterior from everything that the evaluator has run; nothing, with a note, where the runs are too few or too alike.
std::optional<Inference> infer(const Evaluator& evaluator, std::vector<std::string>& notes);

/// The method of the study, then `infer`.
Calibration calibrate(Evaluator& evaluator);

/// "friction: retuned to the power alone it is 0.2, outside its own interval (0.4 … 0.6): …": `found` has the value that was retuned and
/// the interval from all observables; `target`: what it was retuned to. Empty where the value lies inside.
std::string outside_interval(const std::string& name, const std::string& target, const base::Interval90& found);

/// Says that a value is outside its interval because the objective prefers another one than all observables do; empty where nothing has to
/// be said.
std::string contradiction(const Study& study, std::size_t parameter, double best, const emulate::Marginal& marginal);

/// The study's ranges and constraints for the emulator.
emulate::Box box_of(const Study& study);

}  // namespace millscope::calibrate
