// Intervals from resampling groups of data (bootstrap), the same on every machine.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "studies/inspect/estimate.hpp"

namespace millscope::inspect {

/// Draws with replacement as many groups as there are and calls `estimate` with how often each was drawn. Each call returns the same
/// number of values; returns for each value its standard deviation over the draws. Calls that return nothing are left out.
std::vector<double> bootstrap_deviation(std::size_t groups, std::size_t draws,
                                        const std::function<std::vector<double>(const std::vector<double>&)>& estimate);

/// Value ± t(0.95, freedom) · deviation, with `floor` (half the width of a 90 % interval of what resampling cannot see) added in
/// quadrature.
base::Interval90 interval(double value, double deviation, double freedom, double floor = 0);

/// 90 % interval (Wilson 1927) of a proportion.
base::Interval90 proportion(double successes, double trials);

}  // namespace millscope::inspect
