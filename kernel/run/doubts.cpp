#include "kernel/run/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace millscope::run {
namespace {

// Where the limits come from, with the commands: docs/doubts.md.
constexpr double kOverlap = 0.05;  // of the beads' radius
constexpr double kContactSteps = 10;
constexpr double kTurns = 2;
constexpr double kDrift = 3;  // standard errors, as steadiness() judges
constexpr double kGapFill = 0.5;

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

void add_overlap(const Soundness& run, std::vector<Doubt>& out) {
  const auto shallower = [](const DeepestContact& a, const DeepestContact& b) { return a.overlap < b.overlap; };
  const auto deepest = std::max_element(run.deepest.begin(), run.deepest.end(), shallower);
  if (deepest == run.deepest.end() || !(deepest->overlap > kOverlap)) return;
  const double part = deepest->overlap;
  const auto [radii, power] = softness_of(run);
  const double centre = radii * run.bead_radius;
  if (power < run.power_error && centre < run.centre_error) return;
  out.push_back(
      {"overlap", deepest->pair, part, kOverlap, "bead radii",
       fmt::format("{}: beads sink in by up to {:.0f} % of their radius, over {:.0f} %", deepest->pair, 100 * part, 100 * kOverlap),
       fmt::format("the charge may lie some {:.1g} mm too low, its power be off by {:.1g} %, and fitted friction with them", 1e3 * centre,
                   100 * power),
       // δ ∝ E^(−2/5) at one closing speed (Hertz)
       fmt::format("make contacts some {:.0f} times as stiff (stiffness_factor)", std::pow(part / kOverlap, 2.5))});
}

void add_contact_steps(const Soundness& run, std::vector<Doubt>& out) {
  if (!run.contact_steps || *run.contact_steps >= kContactSteps || std::abs(run.imbalance) < run.power_error) return;
  out.push_back(
      {"contact_steps", "", *run.contact_steps, kContactSteps, "time steps",
       fmt::format("the shortest contact lasts {:.2g} time steps, under {:.0f}", *run.contact_steps, kContactSteps),
       fmt::format("impacts lose other energies than the law says, here {:.2g} % of all in the end", 100 * std::abs(run.imbalance)),
       "lower time.step_fraction"});
}

void add_short_window(const Soundness& run, std::vector<Doubt>& out) {
  if (run.turn == 0 || run.window >= kTurns * run.turn) return;
  const double turns = run.window / run.turn;
  out.push_back({"short_window", "", turns, kTurns, "turns",
                 fmt::format("means are over {:.2g} turns of the mill, under {:.0f}", turns, kTurns),
                 "they may be off by more than their standard errors",
                 fmt::format("raise time.end_s by {:.2g} s or more", kTurns * run.turn - run.window)});
}

void add_not_steady(const Soundness& run, std::vector<Doubt>& out) {
  if (run.steady) return;
  out.push_back({"not_steady", "", run.drift, kDrift, "standard errors",
                 fmt::format("the power of the window's halves differs by {:.2g} of its standard errors, over {:.0f}", run.drift, kDrift),
                 "the means are of a mill that still changes", "raise time.analyze_from_s and time.end_s"});
}

void add_lifter_gap(const Soundness& run, std::vector<Doubt>& out) {
  if (!run.gap) return;
  const double fill = 2 * run.bead_radius / run.gap->width;
  if (!(fill > kGapFill)) return;
  out.push_back({"lifter_gap", run.gap->body, fill, kGapFill, "gap widths",
                 fmt::format("{}: a bead fills {:.0f} % of the gap of {:.3g} mm between lifters, over {:.0f} %", run.gap->body, 100 * fill,
                             1e3 * run.gap->width, 100 * kGapFill),
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
