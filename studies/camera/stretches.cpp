// Short stretches of a recording from which the noise can be read.
#include "studies/camera/stretches.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"

namespace millscope::camera {
namespace {

constexpr std::size_t kLength = 24;           // locations in a stretch: some three to ten correlation times
constexpr std::size_t kFewestStretches = 20;  // stretches
constexpr double kImpact = 8;                 // contrasts beyond so many medians: an impact or a stray location
constexpr std::size_t kStride = 4;            // between candidates for quiet stretches
constexpr double kQuietShare = 0.10;          // of a recording: with 0.06 errors are a quarter larger, with 0.15 too small

Stretch stretch_of(const recording::Run& run, std::size_t first, const Middle& middle) {
  Stretch s;
  s.first = first;
  for (std::size_t i = first; i < first + kLength; ++i) {
    s.time.push_back(run.time[i] - run.time[first]);
    for (std::size_t axis = 0; axis < 3; ++axis) s.value[axis].push_back(run.position[axis][i]);
    s.distance.push_back(middle.distance(run, i));
  }
  return s;
}

/// Largest distance of a location from the straight line between its neighbours, in m.
double largest_bend(const Stretch& s) {
  double largest = 0;
  for (std::size_t i = 1; i + 1 < s.time.size(); ++i) {
    const double share = (s.time[i] - s.time[i - 1]) / (s.time[i + 1] - s.time[i - 1]);
    double square = 0;
    for (const auto& x : s.value) square += std::pow(x[i] - (1 - share) * x[i - 1] - share * x[i + 1], 2);
    largest = std::max(largest, std::sqrt(square));
  }
  return largest;
}

/// All unbroken stretches that begin `stride` locations apart, without those that hold an impact or a stray location.
std::vector<Stretch> stretches_of(const recording::Recording& recording, const Middle& middle, double pause, std::size_t stride) {
  std::vector<Stretch> all;
  for (std::size_t index = 0; index < recording.runs.size(); ++index) {
    const recording::Run& run = recording.runs[index];
    for (std::size_t first = 0; first + kLength <= run.size();) {
      std::size_t broken = first;
      for (std::size_t i = first + 1; i < first + kLength; ++i) {
        if (run.time[i] - run.time[i - 1] > pause) broken = i;
      }
      if (broken == first) {
        all.push_back(stretch_of(run, first, middle));
        all.back().run = index;
      }
      first = broken == first ? first + stride : broken;
    }
  }
  if (all.size() < kFewestStretches) {
    throw base::UserError(
        fmt::format("{}: only {} stretches of {} locations without a pause of {:.3g} s; the noise needs {}; record for longer",
                    recording.file.string(), all.size(), kLength, pause, kFewestStretches));
  }
  std::vector<double> bends;
  for (const Stretch& s : all) bends.push_back(largest_bend(s));
  std::vector<double> ordered = bends;
  const double limit = kImpact * base::quantile(ordered, 0.5);
  std::vector<Stretch> calm;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (bends[i] <= limit) calm.push_back(std::move(all[i]));
  }
  return calm;
}

bool overlap(const Stretch& a, const Stretch& b) {
  const std::size_t low = std::min(a.first, b.first), high = std::max(a.first, b.first);
  return a.run == b.run && high < low + kLength;
}

/// How far the bead leaves a circle about the mill's axis within a stretch, m: slopes and bends of radius and height.
double drift_of(const Stretch& s, const Middle& middle) {
  const auto count = static_cast<Eigen::Index>(s.time.size());
  Eigen::MatrixXd powers(count, 3), values(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = 2 * s.time[i] / s.time.back() - 1;
    powers.row(i) << 1, t, t * t;
    values.row(i) << std::hypot(s.value[0][i] - middle.at[0], s.value[1][i] - middle.at[1]), s.value[2][i];
  }
  const Eigen::MatrixXd coefficients = powers.colPivHouseholderQr().solve(values);
  return coefficients.bottomRows(2).norm();
}

}  // namespace

std::vector<Stretch> stretches_over(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most) {
  const std::vector<Stretch> all = stretches_of(recording, middle, pause, kLength);
  const std::size_t count = std::min(most, all.size());
  std::vector<Stretch> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

std::vector<Stretch> quiet_stretches(const recording::Recording& recording, const Middle& middle, double pause, std::size_t most) {
  const std::vector<Stretch> candidates = stretches_of(recording, middle, pause, kStride);
  std::vector<std::pair<double, std::size_t>> drifts;
  for (std::size_t i = 0; i < candidates.size(); ++i) drifts.emplace_back(drift_of(candidates[i], middle), i);
  std::sort(drifts.begin(), drifts.end());
  std::vector<Stretch> quiet;
  const auto wanted = static_cast<std::size_t>(kQuietShare * static_cast<double>(candidates.size() * kStride) / kLength);
  for (const auto& [drift, index] : drifts) {
    if (quiet.size() >= std::min(most, std::max(kFewestStretches, wanted))) break;
    const Stretch& s = candidates[index];
    if (std::none_of(quiet.begin(), quiet.end(), [&](const Stretch& other) { return overlap(s, other); })) quiet.push_back(s);
  }
  return quiet;
}

}  // namespace millscope::camera
