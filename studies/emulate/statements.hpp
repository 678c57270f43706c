// What a posterior means, in plain sentences.
#pragma once

#include "studies/emulate/posterior.hpp"

namespace millscope::emulate {

/// Of a misfit r' C⁻¹ r that is at least as large when nothing but chance differs: χ² with as many degrees of freedom.
double misfit_probability(double misfit, double freedom);

/// Sets `determined` and `statement` of every marginal, and the statements on the whole.
void add_statements(Posterior& posterior, const Box& box, Eigen::Index observables);

}  // namespace millscope::emulate
