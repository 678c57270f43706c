#include "studies/calibrate/power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/output/summary.hpp"

namespace millscope::calibrate {
namespace {

constexpr double kLeastPowerError = 1e-6;  // of a power: an exact one must not make a covariance singular

}  // namespace

PowerFigure beads_power(const analysis::ResultSet& results, double mass, std::string how) {
  const analysis::ResultArray* specific = results.find("power", "specific_power_gravity");
  return {mass * specific->value.at(0), mass * specific->sem.at(0), std::move(how)};
}

PowerFigure whole_charge_power(const std::filesystem::path& run, double factor) {
  const auto summary = output::read_json(run / "summary.json");
  const auto power = summary.is_object() && summary.contains("power_W") ? summary["power_W"] : nlohmann::ordered_json();
  if (!power.is_object() || !power.contains("com") || !power["com"].is_number()) {
    throw base::UserError(fmt::format("{}: its summary.json tells no power; the run has not come to its end", run.string()));
  }
  const double sem = power.contains("com_sem") && power["com_sem"].is_number() ? power["com_sem"].get<double>() : 0.0;
  return {factor * power["com"].get<double>(), factor * sem,
          fmt::format("whole simulated charge, times {:.4g} for the recorded mass", factor)};
}

void set_metered_power(Observation& o, PowerFigure power) {
  o.power = std::move(power);
  const auto i = o.find(ObservableKind::power);
  if (!i) return;
  o.value[*i] = o.power.value;
  for (Eigen::MatrixXd* c : {&o.covariance, &o.resampled}) {
    if (c->size() > 0) c->row(*i).setZero(), c->col(*i).setZero();
  }
  o.covariance(*i, *i) = std::pow(std::max(o.power.sem, kLeastPowerError * std::fabs(o.power.value)), 2);
}

void add_power_error(const Observation& recorded, double relative, Eigen::MatrixXd& covariance) {
  if (const auto i = recorded.find(ObservableKind::power)) covariance(*i, *i) += std::pow(relative * recorded.value[*i], 2);
}

void add_power_error(Observation& recorded, double relative) {
  recorded.power.sem = std::hypot(recorded.power.sem, relative * recorded.power.value);
  add_power_error(recorded, relative, recorded.covariance);
}

}  // namespace millscope::calibrate
