// What a posterior means, in plain sentences.
#pragma once

#include "studies/emulate/posterior.hpp"

namespace millscope::emulate {

/// Sets `determined` and `statement` of every marginal, and the statements on the whole.
void add_statements(Posterior& posterior, const Box& box, Eigen::Index observables);

}  // namespace millscope::emulate
