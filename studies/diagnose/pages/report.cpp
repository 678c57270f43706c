// diagnosis.md: the story in order, for the mill's engineer.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "studies/calibrate/methods.hpp"
#include "studies/diagnose/pages/outputs.hpp"

namespace millscope::diagnose {
namespace {

constexpr std::size_t kShown = 8;  // rows of the mismatch
constexpr std::size_t kCells = 4;  // of the missing force, in each condition

template <class... Values>
void add(std::string& out, fmt::format_string<Values...> text, Values&&... values) {
  fmt::format_to(std::back_inserter(out), text, std::forward<Values>(values)...);
}

std::string text(const base::Interval90& i) {
  return i.known() ? fmt::format("{:.3g} ({:.3g} … {:.3g})", i.value, i.low, i.high) : fmt::format("{:.3g}", i.value);
}

std::string fitted(const Told& t, Index j) {
  const naming::Alternative& alternative = t.diagnosis.problem.alternatives[j];
  const naming::Judged& judged = t.diagnosis.naming.judged[j];
  if (alternative.freed) return fmt::format("{} = {}", alternative.name, text(judged.theta[*alternative.freed]));
  const Candidate& c = t.question.candidates[*alternative.candidate];
  if (c.on_or_off()) return fmt::format("strength {:.3g}", judged.strength.value);
  return fmt::format("{} = {}{}", c.parameter, text(parameter_at(c, judged.strength)), c.unit.empty() || c.unit == "1" ? "" : " " + c.unit);
}

void where_it_differs(const Told& t, std::string& out) {
  const naming::Result& n = t.diagnosis.naming;
  add(out,
      "## Where the retuned base differs\n\nThe base with its parameters refitted to everything: Q = {:.1f} over {} observables. A "
      "recording of this very model looks as bad, in Q or in its largest single difference, with p = {:.2g}.\n\n",
      n.base.q, t.diagnosis.problem.observed.size(), n.base_p);
  if (n.mismatch.empty() || n.mismatch.front().p > t.question.level)
    out += "No single observable stands out; the largest differences, which chance alone makes as large:\n\n";
  for (std::size_t i = 0; i < std::min(kShown, n.mismatch.size()); ++i) add(out, "{}. {}\n", i + 1, mismatch_sentence(t, n.mismatch[i]));
  out += "\n";
}

void what_was_tried(const Told& t, std::string& out) {
  const Diagnosis& d = t.diagnosis;
  out +=
      "## What was tried\n\n| candidate | fitted | ΔQ | p, family-wise | visible where it shows best (noise units) | concealed by the "
      "parameters | p against the best |\n|---|---|---|---|---|---|---|\n";
  for (Index j = 0; j < std::ssize(d.naming.judged); ++j) {
    const naming::Judged& g = d.naming.judged[j];
    const bool best = d.naming.best == j;
    if (g.runs == 0 && d.problem.alternatives[j].candidate) continue;
    if (!g.tested) {
      add(out, "| {} | not tested | | | cannot be seen | | |\n", d.problem.alternatives[j].name);
      continue;
    }
    const std::string against = best ? "the best" : !d.naming.best ? "" : fmt::format("{:.2g}", g.against_best_p);
    add(out, "| {}{}{} | {} | {:.1f} | {:.2g} | {:.1f}{} | {:.0f} % | {} |\n", best ? "**" : "", d.problem.alternatives[j].name,
        best ? "**" : "", fitted(t, j), g.delta_q, g.p_family, std::sqrt(g.lambda), g.undetectable ? ", cannot be seen" : "",
        100 * (1 - g.kappa), against);
  }
  out += "\n";
  for (const Candidate& c : t.question.candidates)
    add(out, "- **{}**: {}{}{}\n", c.name, c.sentence, c.equation.empty() ? "" : " `" + c.equation + "`",
        c.citation.empty() ? "" : " " + c.citation);
  for (const naming::Pair& p : d.naming.pairs)
    add(out, "- Two together: {} beside {} has p = {:.2g}, the other way round {:.2g}.\n", d.problem.alternatives[p.second].name,
        d.problem.alternatives[p.first].name, p.p, p.p_first);
  out += "\n";
}

void parameters(const Told& t, std::string& out) {
  const Diagnosis& d = t.diagnosis;
  out += "## Parameters\n\n| | retuned base |";
  if (d.naming.best) add(out, " with {} |", d.problem.alternatives[*d.naming.best].name);
  out += d.naming.best ? "\n|---|---|---|\n" : "\n|---|---|\n";
  for (std::size_t i = 0; i < d.problem.data.theta.size(); ++i) {
    add(out, "| {} | {} |", d.problem.data.theta[i].name, text(d.naming.base_theta[i]));
    if (d.naming.best) add(out, " {} |", text(d.naming.judged[*d.naming.best].theta[i]));
    out += "\n";
  }
  for (const std::string& sentence : moved_by_practice(t)) add(out, "\n{}.\n", sentence);
  out +=
      "\nFitted to each condition alone (intervals from the curvature at the optimum, too narrow where two parameters trade places):\n\n| "
      "condition | parameter | base | "
      "with what is named |\n|---|---|---|---|\n";
  for (const Alone& a : d.alone) {
    for (std::size_t i = 0; i < t.question.study.parameters.size(); ++i)
      add(out, "| {} | {} | {} | {} |\n", t.question.study.conditions[a.condition].name, d.problem.data.theta[i].name, text(a.before[i]),
          a.after.empty() ? "" : text(a.after[i]));
  }
  out += "\n";
}

std::string source(const Prediction& p) {
  return fmt::format("{}{}", p.computed ? "computed from the base, " : "", p.simulated ? "simulated" : "predicted");
}

std::string power(const Score& s) {
  if (!std::isfinite(s.prediction.power)) return "not predicted";
  return fmt::format("{:.4g} W{}", s.prediction.power, std::isfinite(s.power_percent) ? fmt::format(" ({:+.1f} %)", s.power_percent) : "");
}

void held_out(const Told& t, std::string& out) {
  out += "## On data that were not fitted\n\n";
  if (t.diagnosis.held_out.empty()) out += "No condition has the role `held_out`: nothing confirms the choice.\n\n";
  for (const HeldOut& h : t.diagnosis.held_out) {
    const calibrate::PowerFigure& recorded = t.diagnosis.evidence.recorded[h.condition].power;
    add(out,
        "{}, recorded power {}. Misfit: mean squared difference over its variance. About 1 when only chance differs, smaller where errors "
        "were "
        "taken cautiously, larger by what the fitted parameters are off by.\n\n"
        "| model | from | misfit | power | improvement of the corrected model (90 %) |\n|---|---|---|---|---|\n",
        t.question.study.conditions[h.condition].name, recorded.known() ? fmt::format("{:.4g} W", recorded.value) : "unknown");
    for (const Score& s : h.scores) {
      const bool compared = t.diagnosis.naming.best && s.prediction.name != "corrected";
      add(out, "| {}: {} | {} | {:.2f} | {} | {} |\n", s.prediction.name, s.prediction.sentence, source(s.prediction), s.misfit, power(s),
          compared ? fmt::format("{:.2f} ({:.2f} … {:.2f})", s.improvement.value, s.improvement.low, s.improvement.high) : "");
    }
    out += h.simulations > 0 ? fmt::format("\n{} simulations were made for this, beside the bank's.", h.simulations)
                             : "\nNo simulation beside the bank's was needed.";
    if (std::any_of(h.scores.begin(), h.scores.end(), [](const Score& s) { return !s.prediction.simulated; }))
      out +=
          " *Predicted*: by the surrogate of the bank's own simulations in this condition, whose left-out error is below half of the "
          "difference that is judged.";
    out += "\n";
    if (!h.scores.empty()) add(out, "\nA recording of the refitted base would look as bad with p = {:.2g}.\n", h.base_p);
    out += "\n";
  }
}

void missing(const Told& t, std::string& out) {
  if (t.diagnosis.missing.empty()) return;
  out +=
      "## The missing force, without a form\n\nMean acceleration of the recorded beads less that of the retuned base, seen through the "
      "same camera.\n\n";
  for (const MissingForce& m : t.diagnosis.missing) {
    for (std::size_t i = 0; i < std::min(kCells, m.cells.size()); ++i)
      add(out, "- {}\n", force_sentence(t.question, m.condition, m.cells[i]));
  }
  add(out, "\n{}\n\n", sentence_of(t.diagnosis.terms));
}

}  // namespace

base::Interval90 parameter_at(const Candidate& c, const base::Interval90& strength) {
  const auto [low, high] = std::minmax({c.value(strength.low), c.value(strength.high)});
  return {c.value(strength.value), low, high};
}

std::string observable_name(const Told& t, Index observable) {
  Index at = 0;
  for (const std::size_t c : t.diagnosis.fit) {
    const calibrate::Observation& o = t.diagnosis.evidence.recorded[c];
    if (observable < at + o.value.size())
      return fmt::format("{}: {}", t.question.study.conditions[c].name, o.observables[observable - at].name);
    at += o.value.size();
  }
  return "";
}

std::vector<std::string> moved_by_practice(const Told& t) {
  std::vector<std::string> out;
  for (const HeldOut& h : t.diagnosis.held_out) {
    const auto practice = std::find_if(h.scores.begin(), h.scores.end(), [](const Score& s) { return s.prediction.name == kToPower; });
    if (practice == h.scores.end()) continue;
    for (std::size_t i = 0; i < t.question.study.parameters.size(); ++i) {
      const base::Interval90& all = t.diagnosis.naming.base_theta[i];
      const std::string said = calibrate::outside_interval(t.diagnosis.problem.data.theta[i].name, "the power alone",
                                                           {practice->prediction.theta[static_cast<Index>(i)], all.low, all.high});
      if (!said.empty()) out.push_back(said);
    }
    break;  // it is retuned to a fitted condition: the same wherever it is tried
  }
  return out;
}

std::string mismatch_sentence(const Told& t, const naming::Mismatch& m) {
  Index at = 0;
  for (const std::size_t c : t.diagnosis.fit) {
    const calibrate::Observation& o = t.diagnosis.evidence.recorded[c];
    if (m.observable >= at + o.value.size()) {
      at += o.value.size();
      continue;
    }
    return fmt::format(
        "{}: recording {:.4g}, retuned base {:.4g} {}: {:.1f} standard deviations {} (p = {:.2g} for all observables together).",
        observable_name(t, m.observable), o.value[m.observable - at], m.base, o.observables[m.observable - at].unit, std::fabs(m.z),
        m.z > 0 ? "above" : "below", m.p);
  }
  return "";
}

std::string diagnosis_text(const Told& t, const std::vector<std::filesystem::path>& pictures) {
  const Diagnosis& d = t.diagnosis;
  std::string out =
      fmt::format("# Diagnosis of {}\n\n**{}** {}\n\n", t.question.study.file.filename().string(), name_of(d.verdict), d.sentence);
  if (!d.next_experiment.empty()) add(out, "Next: {}\n\n", d.next_experiment);
  for (const campaign::SharedDoubt& doubt : d.doubts) add(out, "- Doubt: {}\n", campaign::sentence_of(doubt));
  if (!d.doubts.empty()) out += "\n";
  where_it_differs(t, out);
  what_was_tried(t, out);
  parameters(t, out);
  held_out(t, out);
  missing(t, out);
  if (!pictures.empty()) out += "## Pictures\n\n";
  for (const auto& p : pictures) add(out, "![{}](pictures/{})\n\n", p.stem().string(), p.filename().string());
  out += "## How sure\n\n";
  add(out,
      "p-values come from pseudo-recordings made of left-out runs of the bank ({} parameter sets, {} used), each refitted in full; they "
      "hold for all candidates together. Of the runs' scatter about the surrogate at least {:.0f} % is chance of single runs; the rest is "
      "what the surrogate cannot follow, and counts as error.\n\n",
      d.bank.points.size(), d.problem.data.rows.size(), 100 * d.naming.chance);
  for (const std::string& note : d.notes) add(out, "- {}\n", note);
  return out;
}

}  // namespace millscope::diagnose
