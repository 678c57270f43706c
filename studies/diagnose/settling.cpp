// A mill that starts from rest needs some turns until it is steady. What is left of that when the analysis begins is small beside one
// run's chance, but the same in all runs: pooled over the bank it shows.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/output/series.hpp"
#include "studies/analysis/parallel.hpp"
#include "studies/diagnose/bank.hpp"

namespace millscope::diagnose {
namespace {

namespace fs = std::filesystem;

struct Quantity {
  const char* column;
  const char* name;
};
constexpr std::array kQuantities = {Quantity{"com_x_m", "the centre of mass x"}, Quantity{"com_y_m", "the centre of mass y"},
                                    Quantity{"translational_energy_J", "the translational energy"},
                                    Quantity{"rotational_energy_J", "the rotational energy"}};
constexpr double kFirst = 0.125, kLater = 0.5;  // of the analysed time: what is compared with what comes after kLater
constexpr std::size_t kLeastRuns = 16;
constexpr double kSure = 4.5;  // standard errors: one of 10⁴ banks by chance, over all conditions and quantities

/// Of each quantity, mean over the first part of the analysed time and over the later one.
struct Parts {
  std::array<double, kQuantities.size()> first{}, later{};
};

double mean_within(const std::vector<double>& time, const std::vector<double>& value, double from, double to) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] >= from && time[i] < to) sum += value[i], ++count;
  }
  return sum / static_cast<double>(count);  // NaN where there is nothing
}

/// Nothing where the run has not told both.
std::optional<Parts> parts_of(const fs::path& run) {
  std::ifstream in(run / "summary.json", std::ios::binary);
  const auto summary = nlohmann::json::parse(in, nullptr, false);
  if (!summary.is_object() || !summary.contains("window_s") || !fs::exists(run / "series.csv")) return {};
  const double begin = summary["window_s"].at(0), end = summary["window_s"].at(1), span = end - begin;
  const output::Series series = output::read_series(run / "series.csv");
  const std::vector<double>& time = series.column("time_s");
  Parts parts;
  for (std::size_t q = 0; q < kQuantities.size(); ++q) {
    const std::vector<double>& value = series.column(kQuantities[q].column);
    parts.first[q] = mean_within(time, value, begin, begin + kFirst * span);
    parts.later[q] = mean_within(time, value, begin + kLater * span, end);
    if (!std::isfinite(parts.first[q]) || !std::isfinite(parts.later[q])) return {};
  }
  return parts;
}

/// Mean and standard error of what the first part has beside the later one, and the mean of the later.
struct Excess {
  double mean = 0, error = 0, later = 0;
  double sureness() const { return error > 0 ? std::fabs(mean) / error : 0; }
};

Excess excess_of(const std::vector<std::optional<Parts>>& runs, std::size_t quantity) {
  double sum = 0, squares = 0, later = 0, n = 0;
  for (const std::optional<Parts>& run : runs) {
    if (!run) continue;
    const double d = run->first[quantity] - run->later[quantity];
    sum += d, squares += d * d, later += run->later[quantity], n += 1;
  }
  if (n < kLeastRuns) return {};
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1)), later / n};
}

}  // namespace

std::vector<std::string> unsettled(const Question& q, const Bank& bank) {
  std::vector<std::string> told;
  for (std::size_t k = 0; k < bank.conditions.size(); ++k) {
    std::vector<std::optional<Parts>> runs(bank.runs.size());
    studies::for_each_item(runs.size(), studies::worker_count(0, runs.size()), [&](std::size_t p, std::size_t) {
      if (k < bank.runs[p].size() && bank.seen[p][k]) runs[p] = parts_of(bank.runs[p][k]);
    });
    std::size_t most = 0;
    std::array<Excess, kQuantities.size()> excess;
    for (std::size_t i = 0; i < excess.size(); ++i) {
      excess[i] = excess_of(runs, i);
      if (excess[i].sureness() > excess[most].sureness()) most = i;
    }
    const Excess& e = excess[most];
    if (e.sureness() < kSure) continue;
    const double percent = 100 / std::fabs(e.later);
    told.push_back(
        fmt::format("the simulations of condition '{}' are not steady when they begin to be looked at: in the first eighth of that time {} "
                    "differs from "
                    "the second half by {:+.2g} ± {:.1g} % of itself, which the whole bank shares and the recording does not; raise "
                    "time.analyze_from_s and time.end_s there",
                    q.study.conditions[bank.conditions[k]].name, kQuantities[most].name, percent * e.mean, percent * e.error));
  }
  return told;
}

}  // namespace millscope::diagnose
