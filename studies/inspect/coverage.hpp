// How much of the time and of the mill's length a recording covers, and how noisy its points are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

struct Coverage {
  std::size_t runs = 0;
  std::uint64_t points = 0;
  double span = 0;              ///< s from first to last point, all runs
  double covered = 0;           ///< s of it outside gaps
  double rate = 0;              ///< points per covered second, 1/s
  double median_interval = 0;   ///< s between points
  double gap_limit = 0;         ///< s: a longer pause is a gap
  double longest_gap = 0;       ///< s
  recording::RunReport report;  ///< sums over the runs
};

Coverage measure_coverage(const recording::Recording& recording);

/// Noise from point to point (difference_noise) with an interval from twenty parts of the recording; m.
std::array<Finding, 3> measure_noise(const recording::Recording& recording);

/// Along the mill's axis.
struct Axial {
  double low = 0, high = 0;        ///< z below and above which the tracer spends 0.5 % of the covered time, m
  std::array<double, 10> share{};  ///< of the covered time, in tenths from low to high
  std::size_t traverses = 0;       ///< journeys from the lower third to the upper or back
};

Axial measure_axial(const recording::Recording& recording);

}  // namespace millscope::inspect
