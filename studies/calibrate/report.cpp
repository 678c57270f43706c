// report.md: what was found, how sure it is, and what does not fit, for the mill's engineer.
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "studies/calibrate/outputs.hpp"

namespace millscope::calibrate {
namespace {

template <class... Values>
void add(std::string& out, fmt::format_string<Values...> text, Values&&... values) {
  fmt::format_to(std::back_inserter(out), text, std::forward<Values>(values)...);
}

void parameters(const Study& study, const Calibration& c, std::string& out) {
  out += "| parameter | range | value | most likely by all observables | 90 % interval | determined |\n|---|---|---|---|---|---|\n";
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const Parameter& of = study.parameters[p];
    add(out, "| {} | {:.4g} … {:.4g} | **{:.4g}** |", of.name, of.low, of.high, c.best[static_cast<Eigen::Index>(p)]);
    if (c.inference) {
      const emulate::Marginal& m = c.inference->posterior.marginal[p];
      const char* word = m.determined == emulate::Determined::well     ? "well"
                         : m.determined == emulate::Determined::weakly ? "weakly"
                                                                       : "hardly";
      add(out, " {:.4g} | {:.4g} … {:.4g} | {} |\n", m.mode, m.low90, m.high90, word);
    } else {
      out += " not known | not known | not known |\n";
    }
  }
  out += "\n";
  if (!c.inference) return;
  for (const emulate::Marginal& m : c.inference->posterior.marginal) add(out, "- {}\n", m.statement);
  for (const std::string& s : c.inference->posterior.statements) add(out, "- {}\n", s);
  for (std::size_t p = 0; p < study.parameters.size(); ++p) {
    const emulate::Profile& f = c.inference->profiles[p];
    add(out, "- {}: {:.0f} % of what it does to the observables can be concealed by the other parameters.\n", study.parameters[p].name,
        100 * f.concealed);
  }
  add(out, "- The emulator's 90 % intervals hold {:.0f} % of the left-out runs.\n\n", 100 * c.inference->diagnostics.coverage90_all);
}

void objective(const Evaluator& evaluator, const Calibration& c, std::string& out) {
  add(out, "Objective `{}`", name_of(evaluator.study().objective.kind));
  if (std::isfinite(c.predicted)) add(out, ": {:.4g} expected", c.predicted);
  if (c.at_best && !c.at_best->failed) {
    add(out, "{} {:.4g} simulated there (Eq. 4.3: {:.3g} = |ΔP| {:.3g} W + x {:.3g} % + speed {:.3g} %; misfit {:.4g} of {} observables)",
        std::isfinite(c.predicted) ? "," : ":", evaluator.objective(*c.at_best), c.at_best->chagas.value(), c.at_best->chagas.power,
        c.at_best->chagas.x, c.at_best->chagas.speed, c.at_best->misfit, [&] {
          Eigen::Index n = 0;
          for (const Observation& o : c.at_best->observed) n += o.value.size();
          return n;
        }());
  }
  out += ".\n\n";
}

void screening(const Screening& s, std::string& out) {
  add(out, "## Screening\n\n{} runs, resolution {}.\n\n| factor | effect | SS | F | p |\n|---|---|---|---|---|\n", s.run.trials.size(),
      s.run.design.resolution);
  for (const doe::Effect& e : s.anova.effects) {
    if (!e.pooled) add(out, "| {} | {:.4g} | {:.4g} | {:.4g} | {:.3g} |\n", e.name, e.value, e.sum.value, e.sum.F, e.sum.p);
  }
  if (s.anova.curvature)
    add(out, "| curvature | | {:.4g} | {:.4g} | {:.3g} |\n", s.anova.curvature->value, s.anova.curvature->F, s.anova.curvature->p);
  add(out, "\nThe dominant factor is **{}**.\n", s.anova.factors[s.kept.front()].name);
  for (const std::string& alias : s.run.design.aliases) add(out, "- alias: {}\n", alias);
  for (const std::string& note : s.anova.notes) add(out, "- {}\n", note);
  out += "\n";
}

void surface(const Composite& c, std::string& out) {
  const doe::Surface& s = c.surface;
  add(out,
      "## Response surface\n\n{} runs of a central composite design.\n\n| term | coefficient (coded) | standard error | F | p "
      "|\n|---|---|---|---|---|\n",
      c.run.trials.size());
  for (const doe::Coefficient& k : s.coefficients)
    add(out, "| {} | {:.4g} | {:.3g} | {:.4g} | {:.3g} |\n", k.name, k.value, k.standard_error, k.F, k.p);
  add(out, "\n- {}\n", s.lack_of_fit_sentence);
  if (s.stationary) add(out, "- {}\n", s.stationary->sentence);
  if (s.stationary && s.stationary->region) {
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
      const auto i = static_cast<Eigen::Index>(f);
      const doe::Factor& of = s.factors[f];
      add(out, "- {}: the {:.0f} % confidence region of the stationary point runs from {:.4g} to {:.4g}{}.\n", of.name,
          100 * s.stationary->region->confidence, of.centre + of.step * s.stationary->region->low[i],
          of.centre + of.step * s.stationary->region->high[i],
          s.stationary->region->bounded[f] ? "" : ", which is as far as the runs reach: they do not determine it better");
    }
  }
  for (const std::string& note : s.notes) add(out, "- {}\n", note);
  out += "\n";
}

void conditions(const Evaluator& evaluator, std::string& out) {
  const Study& study = evaluator.study();
  out += "## Recordings\n\n| condition | role | power (W) | which power | seconds of beads |\n|---|---|---|---|---|\n";
  for (std::size_t c = 0; c < study.conditions.size(); ++c) {
    const Observation& o = evaluator.recorded(c);
    add(out, "| {} | {} | {} | {} | {:.4g} |\n", study.conditions[c].name, study.conditions[c].role == Role::fit ? "fit" : "held out",
        o.power.known() ? fmt::format("{:.4g} ± {:.2g}", o.power.value, o.power.sem) : "", o.power.how, o.bead_seconds);
  }
  out += "\n";
  for (std::size_t c = 0; c < study.conditions.size(); ++c) {
    for (const std::string& note : evaluator.recorded(c).notes) add(out, "- {}: {}\n", study.conditions[c].name, note);
  }
  if (!evaluator.trials().empty()) {
    for (const Trial& t : evaluator.trials()) {
      if (t.failed || !t.observed.front().of_tracks()) continue;
      add(out, "- Simulations: {:.4g} s of beads seen through the same camera; power: {}.\n", t.observed.front().bead_seconds,
          t.observed.front().power.how);
      break;
    }
  }
  out += "\n";
}

}  // namespace

std::string report_text(const Evaluator& evaluator, const Calibration& c, const std::vector<std::filesystem::path>& pictures) {
  const Study& study = evaluator.study();
  std::size_t failed = 0;
  for (const Trial& t : evaluator.trials()) failed += t.failed ? 1 : 0;
  std::string out;
  add(out, "# Calibration of {}\n\nMethod `{}`, {} simulations{}. The set below is {}.\n\n", study.base.filename().string(),
      name_of(study.method), evaluator.simulations(),
      failed > 0 ? fmt::format(", {} parameter sets failed and are left out (runs.csv says why)", failed) : "", c.how);
  for (const campaign::SharedDoubt& doubt : c.doubts) add(out, "- Doubt: {}\n", campaign::sentence_of(doubt));
  if (!c.doubts.empty()) out += "\n";
  parameters(study, c, out);
  objective(evaluator, c, out);
  for (const std::string& note : c.notes) add(out, "- {}\n", note);
  if (!c.notes.empty()) out += "\n";
  if (c.screening) screening(*c.screening, out);
  if (!c.descent.empty()) {
    out += "## Steepest descent\n\n";
    for (const Trial& t : c.descent) {
      out += "-";
      for (std::size_t p = 0; p < study.parameters.size(); ++p)
        add(out, " {} {:.4g}{}", study.parameters[p].name, t.point[static_cast<Eigen::Index>(p)],
            p + 1 < study.parameters.size() ? "," : ":");
      add(out, " {:.4g}\n", evaluator.objective(t));
    }
    out += "\n";
  }
  if (c.composite) surface(*c.composite, out);
  conditions(evaluator, out);
  if (!pictures.empty()) out += "## Pictures\n\n";
  for (const std::filesystem::path& p : pictures) add(out, "![{}](pictures/{})\n\n", p.stem().string(), p.filename().string());
  out +=
      "Numbers: calibration.json; every simulation: runs.csv; a case with the found values: calibrated.yaml.\nHeld-out conditions: "
      "`millscope validate`.\n";
  return out;
}

}  // namespace millscope::calibrate
