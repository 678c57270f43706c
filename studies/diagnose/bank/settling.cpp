// A mill that starts from rest needs some turns until it is steady. What is left of that when the analysis begins is small beside one
// run's chance, but the same in all runs: pooled over the bank it shows.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/parallel.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/summary.hpp"
#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {
namespace {

namespace fs = std::filesystem;

struct Quantity {
  const char* column;
  const char* name;
  bool length;  ///< told in mm; else in per cent of itself
};
constexpr std::array kQuantities = {Quantity{"com_x_m", "the centre of mass x", true}, Quantity{"com_y_m", "the centre of mass y", true},
                                    Quantity{"translational_energy_J", "the translational energy", false},
                                    Quantity{"rotational_energy_J", "the rotational energy", false}};
constexpr double kFirst = 0.125, kLater = 0.5;  // of the analysed time: what is compared with what comes after kLater
constexpr std::size_t kLeastRuns = 24;
constexpr double kSure = 4;      // standard errors: one of some hundred banks of 32 runs by chance, over all conditions and quantities
constexpr double kLeast = 1e-3;  // of the quantity, of a centre of mass of its distance from the axis: less does not matter

/// Of each quantity, mean over the first part of the analysed time and over the later one.
struct Parts {
  std::array<double, kQuantities.size()> first{}, later{};
};

struct Times {
  double first_begin, first_end, later_begin, later_end;
};

/// Both parts are whole turns, as a speed that ripples once a turn is no sign of a start; nothing where less than two are analysed.
std::optional<Times> times_of(const nlohmann::ordered_json& summary) {
  const auto window = summary.is_object() ? summary.value("window_s", nlohmann::ordered_json()) : nlohmann::ordered_json();
  if (!window.is_array() || window.size() != 2 || !window[0].is_number() || !window[1].is_number()) return {};
  const double begin = window[0], end = window[1], span = end - begin;
  const auto speed = summary.value("mill_speed_rad_per_s", nlohmann::ordered_json());
  double first = kFirst * span, later = (1 - kLater) * span;
  if (speed.is_number() && speed.get<double>() != 0) {
    const double turn = 2 * std::numbers::pi / std::fabs(speed.get<double>());
    if (span < 2 * turn) return {};
    first = turn * std::ceil(first / turn);
    later = turn * std::max(1.0, std::floor(later / turn));
  }
  return Times{begin, begin + first, end - later, end};
}

double mean_within(const std::vector<double>& time, const std::vector<double>& value, double from, double to) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] >= from && time[i] < to) sum += value[i], ++count;
  }
  return sum / static_cast<double>(count);  // NaN where there is nothing
}

/// Nothing where the run does not tell both: this check alone reads these files, and must not end a diagnosis for them.
std::optional<Parts> parts_of(const fs::path& run) {
  if (run.empty() || !fs::exists(run / "series.csv")) return {};
  try {
    const std::optional<Times> t = times_of(output::read_json(run / "summary.json"));
    if (!t) return {};
    const output::Series series = output::read_series(run / "series.csv");
    const std::vector<double>& time = series.column("time_s");
    Parts parts;
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
      const std::vector<double>& value = series.column(kQuantities[q].column);
      parts.first[q] = mean_within(time, value, t->first_begin, t->first_end);
      parts.later[q] = mean_within(time, value, t->later_begin, t->later_end);
      if (!std::isfinite(parts.first[q]) || !std::isfinite(parts.later[q])) return {};
    }
    return parts;
  } catch (const base::UserError&) {
    return {};
  }
}

/// Mean and standard error of what the first part has beside the later one, and the mean of the later.
struct Excess {
  double mean = 0, error = 0, later = 0;
  double sureness = 0;  ///< in standard errors; 0 where it is too small to matter
};

Excess excess_of(const std::vector<Parts>& runs, std::size_t quantity) {
  const auto n = static_cast<double>(runs.size());
  Excess e;
  double size = 0;  // that kLeast is part of
  for (const Parts& run : runs) {
    e.mean += (run.first[quantity] - run.later[quantity]) / n;
    e.later += run.later[quantity] / n;
    size += (kQuantities[quantity].length ? std::hypot(run.later[0], run.later[1]) : std::fabs(run.later[quantity])) / n;
  }
  double squares = 0;
  for (const Parts& run : runs) squares += std::pow(run.first[quantity] - run.later[quantity] - e.mean, 2);
  e.error = std::sqrt(squares / (n - 1) / n);
  if (std::fabs(e.mean) > kLeast * size && e.error > 0) e.sureness = std::fabs(e.mean) / e.error;
  return e;
}

std::string sentence(const std::string& condition, const Quantity& quantity, const Excess& e, std::size_t runs) {
  const double scale = quantity.length ? 1e3 : 100 / std::fabs(e.later);
  return fmt::format(
      "the simulations of condition '{}' are not steady when they begin to be looked at: {} is off by {:+.2g} ± {:.2g} {} at the "
      "beginning of that time, in the mean of {} of them, beside its end; in a mill that has long been turning it is not; raise "
      "time.analyze_from_s and time.end_s there",
      condition, quantity.name, scale * e.mean, scale * e.error, quantity.length ? "mm" : "%", runs);
}

}  // namespace

std::vector<std::string> unsettled(const Question& question, const Bank& bank, const std::vector<std::size_t>& conditions) {
  std::vector<std::string> told;
  for (const std::size_t condition : conditions) {
    const std::optional<std::size_t> k = bank.place_of(condition);
    if (!k) continue;
    std::vector<std::optional<Parts>> of_point(bank.points.size());
    base::for_each_item(of_point.size(), base::worker_count(0, of_point.size()), [&](std::size_t p, std::size_t) {
      if (bank.points[p].active.empty() && bank.seen[p][*k]) of_point[p] = parts_of(bank.runs[p][*k]);
    });
    std::vector<Parts> runs;
    for (const std::optional<Parts>& parts : of_point) {
      if (parts) runs.push_back(*parts);
    }
    if (runs.size() < kLeastRuns) continue;
    Excess surest;
    std::size_t quantity = 0;
    for (std::size_t i = 0; i < kQuantities.size(); ++i) {
      const Excess e = excess_of(runs, i);
      if (e.sureness > surest.sureness) surest = e, quantity = i;
    }
    if (surest.sureness >= kSure)
      told.push_back(sentence(question.study.conditions[condition].name, kQuantities[quantity], surest, runs.size()));
  }
  return told;
}

}  // namespace millscope::diagnose
