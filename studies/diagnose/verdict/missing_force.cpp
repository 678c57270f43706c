#include "studies/diagnose/verdict/missing_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::diagnose {
namespace {

constexpr const char* kAnalyzers = "analyzers:\n  mean_acceleration: {rings: 5, sectors: 12, bins_speed: 12, largest_speed: 2}\n";
constexpr const char* kName = "mean_acceleration";
constexpr int kForceSeeds = 2;

struct Side {
  analysis::ResultSet set;
  const analysis::ResultArray& of(const char* name) const { return *set.find(kName, name); }
  /// Too few visits give no error that a p could rest on.
  bool sure(const char* name, std::size_t i) const {
    return (of(name).flags[i] & (analysis::kFewBlocks | analysis::kOftenUndefined | analysis::kNoUncertainty)) == 0;
  }
};

/// Value of the recording less the mean of the simulations, with its error; NaN where one of them lacks it.
struct Difference {
  double value = 0, sem = 0;
  base::Interval90 interval() const { return base::Interval90::about(value, sem); }
  bool known() const { return std::isfinite(value) && std::isfinite(sem) && sem > 0; }
};

Difference difference(const Side& recorded, const std::vector<Side>& simulated, const char* name, std::size_t i) {
  const auto runs = static_cast<double>(simulated.size());
  if (!recorded.sure(name, i)) return {};
  double mean = 0, variance = 0;
  for (const Side& s : simulated) {
    if (!s.sure(name, i)) return {};
  }
  for (const Side& s : simulated) mean += s.of(name).value[i] / runs, variance += std::pow(s.of(name).sem[i] / runs, 2);
  return {recorded.of(name).value[i] - mean, std::sqrt(variance + std::pow(recorded.of(name).sem[i], 2))};
}

std::vector<ForceCell> cells_of(const Side& recorded, const std::vector<Side>& simulated) {
  const std::vector<double>&r = recorded.of("r_edges").value, &angle = recorded.of("angle_edges").value;
  const std::size_t sectors = angle.size() - 1;
  std::vector<ForceCell> cells;
  for (std::size_t i = 0; i < recorded.of("x").value.size(); ++i) {
    const Difference x = difference(recorded, simulated, "x", i), y = difference(recorded, simulated, "y", i);
    if (!x.known() || !y.known()) continue;
    const std::size_t ring = i / sectors, sector = i % sectors;
    const double radius = 0.5 * (r[ring] + r[ring + 1]), from_six = 0.5 * (angle[sector] + angle[sector + 1]) * std::numbers::pi / 180;
    const double sense = recorded.set.meta.context.omega < 0 ? -1 : 1;
    const double square = std::pow(x.value / x.sem, 2) + std::pow(y.value / y.sem, 2);
    cells.push_back({r[ring],
                     r[ring + 1],
                     angle[sector],
                     angle[sector + 1],
                     {sense * radius * std::sin(from_six), -radius * std::cos(from_six)},
                     {recorded.of("velocity_x").value[i], recorded.of("velocity_y").value[i]},
                     x.interval(),
                     y.interval(),
                     std::exp(-0.5 * square)});
  }
  for (ForceCell& cell : cells) cell.p = std::min(1.0, cell.p * static_cast<double>(cells.size()));
  std::stable_sort(cells.begin(), cells.end(), [](const ForceCell& a, const ForceCell& b) { return a.p < b.p; });
  return cells;
}

std::vector<ForceBySpeed> by_speed(const Side& recorded, const std::vector<Side>& simulated) {
  const std::vector<double>& edge = recorded.of("speed_edges").value;
  std::vector<ForceBySpeed> bins;
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    const Difference d = difference(recorded, simulated, "along_motion", i);
    if (d.known()) bins.push_back({edge[i], edge[i + 1], d.interval()});
  }
  return bins;
}

}  // namespace

std::vector<MissingForce> missing_force(const HeldOutRequest& r) {
  std::vector<MissingForce> out;
  if (!r.machinery.results) return out;
  const VectorXd theta = r.problem.data.natural(r.naming.base.coded);
  for (const std::size_t condition : r.fit) {
    if (!r.evidence.recorded[condition].of_tracks()) continue;
    std::vector<campaign::Simulation> simulations;
    for (int replicate = 1; replicate <= kForceSeeds; ++replicate)
      simulations.push_back(simulation_at(r.question, theta, {}, condition, replicate, "retuned to all observables"));
    const Side recorded{r.machinery.results(condition, {}, kAnalyzers, {})};
    std::vector<Side> simulated;
    for (const campaign::Outcome& outcome : r.machinery.run(simulations)) {
      if (outcome.state == campaign::State::done)
        simulated.push_back({r.machinery.results(condition, outcome, kAnalyzers, r.question.camera(theta))});
    }
    if (!simulated.empty())
      out.push_back({condition, recorded.set.meta.context.omega, cells_of(recorded, simulated), by_speed(recorded, simulated)});
  }
  return out;
}

std::string force_sentence(const Question& question, std::size_t condition, const ForceCell& c) {
  const double middle = 0.5 * (c.angle_low + c.angle_high);
  return fmt::format(
      "{}, {:.0f} to {:.0f} mm from the axis, {:.0f}° {} 6 o'clock: {:+.2g} ({:+.2g} … {:+.2g}) m/s² along x, {:+.2g} ({:+.2g} … {:+.2g}) "
      "m/s² upwards; p = {:.2g} for all cells together.",
      question.study.conditions[condition].name, 1e3 * c.r_low, 1e3 * c.r_high, std::fabs(middle), middle < 0 ? "before" : "past",
      c.x.value, c.x.low, c.x.high, c.y.value, c.y.low, c.y.high, c.p);
}

}  // namespace millscope::diagnose
