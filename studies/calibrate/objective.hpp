// How far a simulation is from a recording, in one number.
#pragma once

#include "studies/calibrate/observation.hpp"
#include "studies/calibrate/study.hpp"

namespace millscope::calibrate {

/// Eq. 4.3 of Chagas 2015 and its three parts.
struct ChagasObjective {
  double power = 0;  ///< |ΔP|, W of the recorded mill
  double x = 0;      ///< root mean square over all bins of the difference of the x distribution, %
  double speed = 0;  ///< the same of the speed distribution, %
  double terms = 0;  ///< Σ weight |Δ| in % of the recorded value
  double value() const { return power + x + speed + terms; }
};

/// Refused (UserError): distributions on different bins.
ChagasObjective chagas2015(const Observation& recorded, const Observation& simulated, const std::vector<Term>& terms);

/// r' C⁻¹ r, r = simulated − recorded, C the sum of both covariances: about as large as there are observables when nothing but chance
/// differs.
double misfit(const Observation& recorded, const Observation& simulated);

}  // namespace millscope::calibrate
