#include "studies/inspect/windows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/statistics.hpp"

namespace millscope::inspect {

std::vector<UnbrokenStretch> unbroken_stretches(const recording::Recording& recording) {
  std::vector<UnbrokenStretch> stretches;
  for (std::size_t r = 0; r < recording.runs.size(); ++r) {
    const recording::Run& run = recording.runs[r];
    std::size_t first = 0;
    for (std::size_t i = 1; i <= run.size(); ++i) {
      if (i < run.size() && run.time[i] - run.time[i - 1] <= recording.gap_limit) continue;
      stretches.push_back({&run, r, first, i});
      first = i;
    }
  }
  return stretches;
}

Parabola fit_parabola(const recording::Run& run, std::size_t first, std::size_t last) {
  Parabola result;
  result.count = last - first;
  result.middle = 0.5 * (run.time[first] + run.time[last - 1]);
  result.duration = run.time[last - 1] - run.time[first];
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = first; i < last; ++i) {
    const double s = run.time[i] - result.middle;
    const Eigen::Vector3d powers(1, s, s * s);
    normal += powers * powers.transpose();
    for (int a = 0; a < 3; ++a) moments.col(a) += run.position[a][i] * powers;
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Matrix3d solution = inverse * moments;
  std::array<double, 3> squares{};
  for (std::size_t i = first; i < last; ++i) {
    const double s = run.time[i] - result.middle;
    for (int a = 0; a < 3; ++a) {
      const double miss = run.position[a][i] - (solution(0, a) + s * (solution(1, a) + s * solution(2, a)));
      squares[a] += miss * miss;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    result.position[axis] = solution(0, axis);
    result.velocity[axis] = solution(1, axis);
    result.acceleration[axis] = 2 * solution(2, axis);
    result.scatter[axis] = result.count > 3 ? std::sqrt(squares[axis] / static_cast<double>(result.count - 3)) : 0;
  }
  result.velocity_per_noise = std::sqrt(inverse(1, 1));
  result.acceleration_per_noise = 2 * std::sqrt(inverse(2, 2));
  return result;
}

void GrowingParabola::add(const recording::Run& run, std::size_t point) {
  const double s = run.time[point] - origin_;
  double power = 1;
  for (double& sum : power_) {
    sum += power;
    power *= s;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (count_ == 0) base_[a] = run.position[a][point];
    const double x = run.position[a][point] - base_[a];
    moment_[a][0] += x;
    moment_[a][1] += x * s;
    moment_[a][2] += x * s * s;
    square_[a] += x * x;
  }
  ++count_;
}

std::array<double, 3> GrowingParabola::variance() const {
  std::array<double, 3> result{};
  if (count_ < 4) return result;
  Eigen::Matrix3d normal;
  normal << power_[0], power_[1], power_[2], power_[1], power_[2], power_[3], power_[2], power_[3], power_[4];
  const Eigen::Matrix3d inverse = normal.inverse();
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Vector3d moment(moment_[a][0], moment_[a][1], moment_[a][2]);
    result[a] = std::max(0.0, square_[a] - moment.dot(inverse * moment)) / static_cast<double>(count_ - 3);
  }
  return result;
}

std::vector<Parabola> local_parabolas(const std::vector<UnbrokenStretch>& stretches, double length, std::size_t least) {
  std::vector<Parabola> result;
  for (const UnbrokenStretch& stretch : stretches) {
    const std::vector<double>& time = stretch.run->time;
    std::size_t low = stretch.first, high = stretch.first;
    for (double start = time[stretch.first]; start + length <= time[stretch.last - 1]; start += 0.5 * length) {
      while (low < stretch.last && time[low] < start) ++low;
      high = std::max(high, low);
      while (high < stretch.last && time[high] <= start + length) ++high;
      if (high - low >= least && time[high - 1] - time[low] > 0.6 * length) result.push_back(fit_parabola(*stretch.run, low, high));
    }
  }
  return result;
}

std::vector<double> dwell_times(const recording::Run& run, double gap_limit) {
  std::vector<double> dwell(run.size());
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double pause = run.time[i] - run.time[i - 1];
    if (pause > gap_limit) continue;
    dwell[i - 1] += 0.5 * pause;
    dwell[i] += 0.5 * pause;
  }
  return dwell;
}

double median_interval(const recording::Recording& recording) {
  std::vector<double> intervals;
  for (const recording::Run& run : recording.runs) {
    for (std::size_t i = 1; i < run.size(); ++i) intervals.push_back(run.time[i] - run.time[i - 1]);
  }
  return intervals.empty() ? 0 : base::quantile(intervals, 0.5);
}

}  // namespace millscope::inspect
