#include "studies/inspect/flight.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"
#include "studies/recording/noise.hpp"

namespace millscope::inspect {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;    // m/s²
constexpr double kShortest = 0.11;   // s: shorter arcs do not tell accelerations apart
constexpr std::size_t kFewest = 12;  // points
constexpr double kCutEnds = 0.15;    // of an arc, at both ends: where the bead still touches others
constexpr double kFewestFlights = 5;
constexpr double kCorrelation = 1.4;    // standard errors grow so much because the noise is not white
constexpr double kLooseSupport = 0.12;  // m/s², half of a 90 % interval: neighbours that brush a bead in flight

struct Arc {
  Vector3d acceleration;
  double deviation = 0;  // of a component, m/s²
};

// How far from the point `first` the same parabola holds within the noise; returns the end, or `first`.
std::size_t end_of_arc(const UnbrokenStretch& stretch, std::size_t first, const std::array<double, 3>& noise, std::size_t least) {
  const recording::Run& run = *stretch.run;
  GrowingParabola sums(run.time[first]);
  std::size_t good = first, next_test = first + least;
  for (std::size_t i = first; i < stretch.last; ++i) {
    sums.add(run, i);
    if (i + 1 < next_test) continue;
    next_test = i + 1 + std::max<std::size_t>(2, sums.count() / 10);
    const auto variance = sums.variance();
    const double tolerance = 1.15 * (1 + 1.5 / std::sqrt(2 * static_cast<double>(sums.count())));
    double worst = 0;
    for (std::size_t a = 0; a < 3; ++a) worst = std::max(worst, std::sqrt(variance[a]) / (tolerance * noise[a]));
    if (worst < 1) good = i + 1;
    if (worst > 1.25) break;
  }
  return good;
}

void add_arc(const recording::Run& run, std::size_t first, std::size_t last, double noise, std::vector<Arc>& arcs) {
  const double duration = run.time[last - 1] - run.time[first];
  const double from = run.time[first] + kCutEnds * duration, to = run.time[last - 1] - kCutEnds * duration;
  while (first < last && run.time[first] < from) ++first;
  while (last > first && run.time[last - 1] > to) --last;
  if (last - first < 8) return;
  const Parabola p = fit_parabola(run, first, last);
  const double deviation = std::max(0.1, kCorrelation * noise * p.acceleration_per_noise);
  if (deviation < 0.8) arcs.push_back({{p.acceleration[0], p.acceleration[1], p.acceleration[2]}, deviation});
}

std::vector<Arc> find_arcs(const recording::Recording& recording) {
  std::vector<std::array<double, 3>> noises;
  for (const recording::Run& run : recording.runs) noises.push_back(recording::difference_noise(run, recording.gap_limit));
  const auto least = std::max(kFewest, static_cast<std::size_t>(kShortest / std::max(1e-5, median_interval(recording)) / 4));
  std::vector<Arc> arcs;
  for (const UnbrokenStretch& stretch : unbroken_stretches(recording)) {
    const recording::Run& run = *stretch.run;
    std::array<double, 3> noise = noises[stretch.run_number];
    for (double& n : noise) n = std::max(n, 2e-5);
    for (std::size_t i = stretch.first; i + least <= stretch.last;) {
      const std::size_t end = end_of_arc(stretch, i, noise, least);
      if (end > i && run.time[end - 1] - run.time[i] >= kShortest) {
        add_arc(run, i, end, (noise[0] + noise[1] + noise[2]) / 3, arcs);
        i = end - 2;
      } else {
        i += least / 4;
      }
    }
  }
  return arcs;
}

/// A narrow population (free flight) in a broad one.
struct Mixture {
  Vector3d gravity = Vector3d::Zero();
  double part = 0;        // of the arcs
  double flights = 0;     // sum of probabilities
  double likelihood = 0;  // log of it, above that without flights
};

class Rest {  // the broad population: a normal density
 public:
  explicit Rest(const std::vector<Arc>& arcs) {
    for (int a = 0; a < 3; ++a) {
      std::vector<double> values;
      for (const Arc& arc : arcs) values.push_back(arc.acceleration[a]);
      middle_[a] = base::quantile(values, 0.5);
      for (double& v : values) v = std::fabs(v - middle_[a]);
      width_[a] = std::numbers::sqrt2 * std::max(1.5, 1.4826 * base::quantile(values, 0.5));
    }
  }
  double density(const Vector3d& a) const {
    const Vector3d e = (a - middle_).cwiseQuotient(width_);
    return std::exp(-0.5 * e.squaredNorm()) / (std::pow(2 * std::numbers::pi, 1.5) * width_.prod());
  }

 private:
  Vector3d middle_, width_;
};

Mixture fit_mixture(const std::vector<Arc>& arcs, const std::vector<double>& rest, const std::vector<double>& times,
                    const Vector3d& start) {
  Mixture m;
  m.gravity = start;
  m.part = 0.2;
  for (int pass = 0; pass < 40; ++pass) {
    Vector3d sum = Vector3d::Zero();
    double weight = 0, members = 0, all = 0;
    m.likelihood = 0;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const double s = arcs[i].deviation, n = times.empty() ? 1 : times[i];
      const double near = m.part * std::exp(-0.5 * (arcs[i].acceleration - m.gravity).squaredNorm() / (s * s)) /
                          std::pow(2 * std::numbers::pi * s * s, 1.5);
      const double far = (1 - m.part) * rest[i] + 1e-300, probability = near / (near + far);
      sum += n * probability / (s * s) * arcs[i].acceleration;
      weight += n * probability / (s * s);
      members += n * probability;
      all += n;
      m.likelihood += n * (std::log(near + far) - std::log(rest[i] + 1e-300));
    }
    if (weight < 1e-6) return {};
    m.gravity = sum / weight;
    m.flights = members;
    m.part = std::clamp(members / all, 0.002, 0.9);
  }
  return m;
}

// From each arc that might be a flight; the one that explains most.
Mixture best_mixture(const std::vector<Arc>& arcs, const std::vector<double>& rest) {
  std::vector<Vector3d> starts;
  for (const Arc& arc : arcs) {
    if (std::fabs(arc.acceleration.norm() - kGravity) < 1.7 && arc.deviation < 0.6) starts.push_back(arc.acceleration);
  }
  const std::size_t stride = starts.size() / 60 + 1;
  Mixture best;
  for (std::size_t i = 0; i < starts.size(); i += stride) {
    const Mixture m = fit_mixture(arcs, rest, {}, starts[i]);
    if (std::fabs(m.gravity.norm() - kGravity) < 1.2 && m.likelihood > best.likelihood) best = m;
  }
  return best;
}

double in_plane(const Vector3d& g) { return std::atan2(g[0], -g[1]) * 180 / std::numbers::pi; }
double out_of_plane(const Vector3d& g) { return std::atan2(g[2], std::hypot(g[0], g[1])) * 180 / std::numbers::pi; }

}  // namespace

FreeFlight measure_flight(const recording::Recording& recording) {
  constexpr std::size_t kMostArcs = 4000;
  FreeFlight result;
  std::vector<Arc> arcs = find_arcs(recording);
  result.arcs = arcs.size();
  if (const std::size_t stride = arcs.size() / kMostArcs + 1; stride > 1) {
    for (std::size_t i = 0; i * stride < arcs.size(); ++i) arcs[i] = arcs[i * stride];
    arcs.resize((arcs.size() + stride - 1) / stride);
  }
  std::vector<double> rest;
  Mixture best;
  if (!arcs.empty()) {
    const Rest broad(arcs);
    for (const Arc& arc : arcs) rest.push_back(broad.density(arc.acceleration));
    best = best_mixture(arcs, rest);
  }
  result.flights = best.flights;
  if (best.flights < kFewestFlights || best.likelihood < 25) {
    const std::string why = fmt::format(
        "{} parabolic arcs, but no group of them that stands out with gravity's acceleration: the tracer hardly flew free", arcs.size());
    result.angle_degrees.note = result.axial_degrees.note = result.magnitude.note = why;
    return result;
  }
  const auto deviation = bootstrap_deviation(arcs.size(), 60, [&](const std::vector<double>& times) {
    const Mixture m = fit_mixture(arcs, rest, times, best.gravity);
    return m.flights > 0 ? std::vector<double>{in_plane(m.gravity), out_of_plane(m.gravity), m.gravity.norm()} : std::vector<double>{};
  });
  // What is missing from gravity's magnitude may be a support that also tilts it.
  const double freedom = best.flights - 1;
  const double floor = std::hypot(kLooseSupport, best.gravity.norm() - kGravity) / kGravity * 180 / std::numbers::pi;
  const std::string basis = fmt::format("{:.0f} of {} parabolic arcs", best.flights, arcs.size());
  result.angle_degrees = {interval(in_plane(best.gravity), deviation[0], freedom, floor), basis};
  result.axial_degrees = {interval(out_of_plane(best.gravity), deviation[1], freedom, floor), basis};
  result.magnitude = {interval(best.gravity.norm(), deviation[2], freedom, kLooseSupport), basis};
  return result;
}

}  // namespace millscope::inspect
