#include "studies/inspect/offset.hpp"

#include <algorithm>
#include <cmath>

#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"

namespace millscope::inspect {
namespace {

/// Dwell-weighted mean of the distance beside the axis, and its standard error from blocks of time.
struct SideMean {
  double mean = 0, deviation = 0, freedom = 0;
};

// Means over blocks of `length` seconds of covered time.
SideMean mean_by_blocks(const recording::Recording& recording, double axis_x, double length) {
  std::vector<std::pair<double, double>> blocks;  // Σ w x, Σ w
  for (const recording::Run& run : recording.runs) {
    const std::vector<double> dwell = dwell_times(run, recording.gap_limit);
    double moment = 0, weight = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
      moment += dwell[i] * (run.position[0][i] - axis_x);
      weight += dwell[i];
      if (weight < length) continue;
      blocks.emplace_back(moment, weight);
      moment = weight = 0;
    }
    if (weight > 0.5 * length) blocks.emplace_back(moment, weight);
  }
  SideMean result;
  if (blocks.size() < 6) return result;
  double moments = 0, weights = 0, squares = 0;
  for (const auto& [m, w] : blocks) {
    moments += m;
    weights += w;
  }
  result.mean = moments / weights;
  constexpr double kForCorrelation = 12;  // blocks; fewer do not tell their correlation
  double products = 0, last = 0;
  for (const auto& [m, w] : blocks) {
    const double deviation = m - result.mean * w;
    squares += deviation * deviation;
    products += deviation * last;
    last = deviation;
  }
  // Neighbouring blocks are alike where the tracer stays in a layer: as for a first-order autoregression, whose correlation a short series
  // makes too small by (1 + 3ρ)/n (Kendall 1954).
  const auto n = static_cast<double>(blocks.size());
  const double seen = products / squares, correlation = n < kForCorrelation ? 0 : std::clamp(seen + (1 + 3 * seen) / n, 0.0, 0.8),
               inflation = (1 + correlation) / (1 - correlation);
  result.deviation = std::sqrt(squares * n / (n - 1) * inflation) / weights;
  result.freedom = std::max(2.0, n / inflation - 1);
  return result;
}

}  // namespace

Finding mean_offset(const recording::Recording& recording, const MillMotion& motion, double circulation) {
  Finding result;
  if (!(circulation > 0) || motion.sense == 0) {
    result.note = "the axis or the circulations are not known";
    return result;
  }
  const double axis = motion.centre()[0];
  SideMean worst;
  for (const double circulations : {1.0, 2.0, 4.0, 8.0}) {
    const SideMean s = mean_by_blocks(recording, axis, circulations * circulation);
    if (s.freedom > 0 && s.deviation > worst.deviation) worst = s;
  }
  if (!(worst.freedom > 0)) {
    result.note = "too short to cut into six blocks of a circulation";
    return result;
  }
  const base::Interval90& x = *motion.axis[0].estimate;
  return {interval(worst.mean, worst.deviation, worst.freedom, 0.5 * (x.high - x.low)),
          "weighted by time; blocks of one to eight circulations and their likeness; the largest error"};
}

}  // namespace millscope::inspect
