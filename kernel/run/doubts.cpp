#include "kernel/run/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/run/window.hpp"

namespace millscope::run {
namespace {

// Where the limits come from, with the commands: docs/doubts.md.
constexpr double kOverlap = 0.05;  // of the beads' radius
constexpr double kContactSteps = 10, kAlwaysContactSteps = 6;
constexpr double kUnaccounted = 0.1;  // of the energy that goes through; a developed mill closes within 0.5 %, one that starts within 7
constexpr double kTurns = 2;
constexpr double kDrift = 3, kDriftPart = 0.01;  // standard errors, and of the mean: as steadiness() judges
constexpr double kGapFill = 0.5;

/// With so many significant digits at least, never as a power of ten.
std::string rounded(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return fmt::format("{}", value);
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double scale = std::pow(10.0, decimals);
  return fmt::format("{:.{}f}", std::round(value * scale) / scale, std::max(decimals, 0));
}

/// With so many significant digits, or as many as tell it from the limit that it is beyond.
std::string beyond(double value, double limit, int digits) {
  while (digits < 9 && std::stod(rounded(value, digits)) == limit) ++digits;
  return rounded(value, digits);
}

/// What beads that sink in may change, over the part of their radius by which they do.
struct Softness {
  double centre;  ///< of the centre of mass, in radii
  double power;   ///< part of it
};
constexpr Softness kBeads{2.5, 0.16}, kWall{0.6, 0.04};

/// The most that any pair's overlap stands for: all grow together in one mill, and the one that matters is not known.
Softness softness_of(const Soundness& run) {
  Softness most{0, 0};
  for (const DeepestContact& c : run.deepest) {
    const Softness& of = c.wall ? kWall : kBeads;
    most = {std::max(most.centre, of.centre * c.overlap), std::max(most.power, of.power * c.overlap)};
  }
  return most;
}

/// What would make contacts of that overlap as stiff as they should be, and its cost.
std::string stiffer(const Soundness& run, double overlap) {
  if (!run.stiffness_from_young) return "give the contact law a higher stiffness";
  // δ ∝ E^(−2/5) at one closing speed (Hertz); more than the materials are as stiff as they are is not to be had
  const double wanted = std::min(1.0, run.stiffness_factor * std::pow(overlap / kOverlap, 2.5));
  // the Rayleigh time, and the time step with it, ∝ E^(−1/2)
  return fmt::format("raise stiffness_factor to {}, at about {} times the time", rounded(wanted, 2),
                     rounded(std::sqrt(wanted / run.stiffness_factor), 2));
}

void add_overlap(const Soundness& run, std::vector<Doubt>& out) {
  if (run.stiffness_from_young && run.stiffness_factor >= 1) return;  // so soft are the bodies themselves
  const auto shallower = [](const DeepestContact& a, const DeepestContact& b) { return a.overlap < b.overlap; };
  const auto deepest = std::max_element(run.deepest.begin(), run.deepest.end(), shallower);
  if (deepest == run.deepest.end() || !(deepest->overlap > kOverlap)) return;
  const auto [radii, power] = softness_of(run);
  const double centre = radii * run.bead_radius;
  if (power < run.power_error && centre < run.centre_error) return;
  const std::string and_power = run.turn > 0 ? fmt::format(", its power be off by {} %", rounded(100 * power, 1)) : "";
  out.push_back({"overlap", deepest->pair, deepest->overlap, kOverlap, "bead radii",
                 fmt::format("{}: beads {} by up to {} % of their radius, over {:.0f} %", deepest->pair,
                             deepest->wall ? "sink in" : "overlap", beyond(100 * deepest->overlap, 100 * kOverlap, 2), 100 * kOverlap),
                 fmt::format("the charge may lie some {} mm too low{}, and fitted friction be off", rounded(1e3 * centre, 1), and_power),
                 stiffer(run, deepest->overlap)});
}

/// The book's imbalance is a sum with signs, which may be small by chance: it silences only where steps are not far too few.
bool book_holds(const Soundness& run) {
  return *run.contact_steps >= kAlwaysContactSteps && run.imbalance && std::abs(*run.imbalance) < run.power_error;
}

void add_contact_steps(const Soundness& run, std::vector<Doubt>& out) {
  if (!run.contact_steps || *run.contact_steps >= kContactSteps || book_holds(run)) return;
  const std::string part =
      run.imbalance ? fmt::format(", here {} % of all in sum", rounded(100 * std::abs(*run.imbalance), 2)) : std::string();
  out.push_back(
      {"contact_steps", "", *run.contact_steps, kContactSteps, "time steps",
       fmt::format("the shortest contact lasts {} time steps, under {:.0f}", beyond(*run.contact_steps, kContactSteps, 2), kContactSteps),
       "impacts lose other energies than the law says" + part, "lower time.step_fraction"});
}

/// Too long a step for many contacts of one bead at once makes energy that no single contact shows.
void add_energy(const Soundness& run, std::vector<Doubt>& out) {
  if (!run.unaccounted || *run.unaccounted <= kUnaccounted) return;
  if (run.contact_steps && *run.contact_steps < kContactSteps) return;  // which says it
  out.push_back({"energy", "", *run.unaccounted, kUnaccounted, "of the energy that goes through",
                 fmt::format("{} % of the energy that goes through is not accounted for, over {:.0f} %",
                             beyond(100 * *run.unaccounted, 100 * kUnaccounted, 2), 100 * kUnaccounted),
                 "no mean of this run can be trusted", "lower time.step_fraction, to half at first"});
}

void add_short_window(const Soundness& run, std::vector<Doubt>& out) {
  if (run.turn == 0) return;
  if (!run.window) {
    out.push_back({"short_window", "", 0, kTurns, "turns", "the analysis window is too short for any mean",
                   "power and centre of mass are missing", fmt::format("raise time.end_s by {} s or more", rounded(kTurns * run.turn, 2))});
    return;
  }
  // The first and the last sample are each up to one sample within the window.
  const double missing = kTurns * run.turn - *run.window, turns = *run.window / run.turn;
  if (missing <= 2 * kSampleInterval) return;
  out.push_back({"short_window", "", turns, kTurns, "turns",
                 fmt::format("means are over {} turns of the mill, under {:.0f}", beyond(turns, kTurns, 2), kTurns),
                 "they may be off by more than their standard errors",
                 fmt::format("raise time.end_s by {} s or more", rounded(missing, 2))});
}

void add_not_steady(const Soundness& run, std::vector<Doubt>& out) {
  if (run.steady) return;
  const auto [errors, part] = run.drift;
  out.push_back(
      {"not_steady", "", errors, kDrift, "standard errors",
       fmt::format(
           "the power of the window's halves differs by {} of its standard errors, over {:.0f}, and by {} % of itself, over {:.0f} %",
           beyond(errors, kDrift, 2), kDrift, beyond(100 * part, 100 * kDriftPart, 2), 100 * kDriftPart),
       "the means are of a mill that still changes", "raise time.analyze_from_s and time.end_s"});
}

void add_lifter_gap(const Soundness& run, std::vector<Doubt>& out) {
  if (!run.gap) return;
  const double fill = 2 * run.bead_radius / run.gap->width;
  if (!(fill > kGapFill)) return;
  out.push_back({"lifter_gap", run.gap->body, fill, kGapFill, "gap widths",
                 fmt::format("{}: a bead fills {} % of the gap of {} mm between lifters, over {:.0f} %", run.gap->body,
                             beyond(100 * fill, 100 * kGapFill, 2), rounded(1e3 * run.gap->width, 3), 100 * kGapFill),
                 "the power hangs on the gap's very width and the beads' size", "take both from the mill itself"});
}

}  // namespace

void to_json(nlohmann::ordered_json& j, const Doubt& doubt) {
  j = {{"name", doubt.name}, {"of", doubt.of},           {"value", doubt.value},           {"limit", doubt.limit},
       {"unit", doubt.unit}, {"finding", doubt.finding}, {"may_change", doubt.may_change}, {"remedy", doubt.remedy}};
}

void from_json(const nlohmann::ordered_json& j, Doubt& doubt) {
  j.at("name").get_to(doubt.name);
  j.at("of").get_to(doubt.of);
  // A file has null for infinity: a drift where nothing scatters.
  doubt.value = j.at("value").is_null() ? std::numeric_limits<double>::infinity() : j.at("value").get<double>();
  j.at("limit").get_to(doubt.limit);
  j.at("unit").get_to(doubt.unit);
  j.at("finding").get_to(doubt.finding);
  j.at("may_change").get_to(doubt.may_change);
  j.at("remedy").get_to(doubt.remedy);
}

std::vector<Doubt> doubts_of(const Soundness& run) {
  std::vector<Doubt> out;
  add_overlap(run, out);
  add_contact_steps(run, out);
  add_energy(run, out);
  add_short_window(run, out);
  add_not_steady(run, out);
  add_lifter_gap(run, out);
  return out;
}

std::string sentence_of(const Doubt& doubt) { return doubt.finding + "; " + doubt.may_change + "; " + doubt.remedy; }

std::vector<Doubt> doubts_in(const nlohmann::ordered_json& summary) {
  if (!summary.is_object() || !summary.contains("doubts")) return {};
  try {
    return summary["doubts"].get<std::vector<Doubt>>();
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

}  // namespace millscope::run
