// From trials to what the emulator takes; for the files of this room.
#pragma once

#include <vector>

#include "studies/calibrate/evaluator.hpp"
#include "studies/emulate/emulator.hpp"

namespace millscope::calibrate {

/// Observables of all fit conditions side by side; those that no simulation changes are left out.
struct Fitting {
  emulate::Training training;
  emulate::Observed observed;
};
Fitting fitting_of(const Evaluator& evaluator);

/// Trials that did not fail.
std::vector<const Trial*> finished(const Evaluator& evaluator);

}  // namespace millscope::calibrate
