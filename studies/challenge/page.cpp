#include "studies/challenge/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "kernel/base/statistics.hpp"
#include "studies/challenge/concealment.hpp"

namespace millscope::challenge {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSure = 0.95;  // of every one-sided bound
constexpr double kStrong = 30;  // λ

template <class... Values>
void add(std::string& out, fmt::format_string<Values...> text, Values&&... values) {
  fmt::format_to(std::back_inserter(out), text, std::forward<Values>(values)...);
}

Json count_json(const Count& c) {
  if (c.of == 0) return {{"hits", 0}, {"of", 0}};
  return {{"hits", c.hits}, {"of", c.of}, {"share", c.share()}, {"low95", lower_bound(c, kSure)}, {"high95", upper_bound(c, kSure)}};
}

/// Lines of counts, misses beside hits.
void add_counts(const Score& s, std::string& out) {
  const auto line = [&](const char* what, const Count& c) { add(out, "| {} | {} | {} |\n", what, count_text(c), c.of - c.hits); };
  out += "## Counted\n\n| of the sets with … | counted | the others |\n|---|---|---|\n";
  line("nothing hidden: something is said to be missing (false alarm)", s.false_alarms);
  line("nothing hidden: physics is named or listed", s.false_physics);
  line("one effect: the verdict is `named`, and right", s.named_alone);
  line("one effect: the best candidate is the truth (top-1)", s.best_right);
  line("one effect: the truth is listed, alone or in a class of two", s.in_class_of_two);
  line("one effect: the truth is listed", s.in_class);
  line(fmt::format("one effect, faint (λ below {:g}): no physics is listed but the truth", kFaint).c_str(), s.faint_nothing_else);
  line("one effect: said to lie outside the library (wrong abstention)", s.abstained_on_effect);
  line("two effects: both listed, as two at once", s.two_both);
  line("two effects: at least one listed", s.two_one);
  line("physics outside the list: said to lie outside (right abstention)", s.outside_abstained);
  line("physics outside the list: something of the list named (wrong)", s.outside_named);
  line("physics outside the list: not noticed", s.outside_missed);
  line("decoy (another camera, or what is believed is wrong): physics is listed (wrong)", s.decoys_named);
  line("decoy: said to lie outside the library (wrong)", s.decoys_outside);
  if (std::isfinite(s.mean_class))
    add(out, "\nWhere one effect is hidden and something is listed, {:.2f} candidates are listed in the mean.\n", s.mean_class);
  out +=
      "\nIntervals behind counts are of Clopper and Pearson (1934), 5 % on each side. They take sets as independent; sets of one mill "
      "share one bank of simulations. A diagnosis that failed counts as a miss where something is to be found, and nowhere else.\n\n";
}

/// Of which sets, by whom, against which candidates.
void add_tried(const Page& page, std::string& out) {
  std::map<std::string, int> engines, candidates;
  std::set<double> levels;
  for (const Marked& m : page.sets) {
    if (!m.engine().empty()) ++engines[m.engine()];
    if (!m.found) continue;
    if (std::isfinite(m.found->level)) levels.insert(100 * m.found->level);
    for (const Tested& t : m.found->hypotheses) candidates[t.name] += t.physics ? 0 : 1;
  }
  std::vector<std::string> played, physics, nuisances;
  for (const auto& [engine, sets] : engines) played.push_back(fmt::format("{} ({} sets)", engine, sets));
  for (const auto& [name, beliefs] : candidates) (beliefs == 0 ? physics : nuisances).push_back(name);
  out += "**No recording here is of a real mill.** Each is a simulation that a made-up camera has seen";
  if (!played.empty()) add(out, ", played by {}", fmt::join(played, ", "));
  out += ". ";
  if (!candidates.empty())
    add(out, "Candidates: {}. Beliefs that may be wrong: {}. ", physics.empty() ? "none" : fmt::format("{}", fmt::join(physics, ", ")),
        nuisances.empty() ? "none" : fmt::format("{}", fmt::join(nuisances, ", ")));
  if (!levels.empty()) add(out, "A false alarm is allowed in {:g} % of the sets. ", fmt::join(levels, ", "));
  out += "All sets of one mill share one bank of simulations.\n\n";
}

/// What a reader of a diagnosis wants to know first.
void add_said(const Score& s, std::string& out) {
  out +=
      "## When it says …\n\nThe shares hang on the mix of sets that was drawn.\n\n"
      "| it says | sets | right | in part: the truth is among more, or not all of it | wrong |\n|---|---|---|---|---|\n";
  const auto brief = [](int count) { return count == 0 ? std::string() : std::to_string(count); };
  for (const Said& one : s.said)
    add(out, "| {} | {} | {} | {} | {} |\n", one.what, one.right + one.part + one.wrong, brief(one.right), brief(one.part),
        brief(one.wrong));
  out += "\n";
}

/// How many of each kind of decoy are right, by Marked::missed().
std::map<std::string, Count> right_decoys(const std::vector<Marked>& sets) {
  std::map<std::string, Count> kinds;
  for (const Marked& m : sets) {
    if (m.found && m.found->failure.empty() && m.answer.kind == Kind::decoy) kinds[m.answer.name].add(!m.missed());
  }
  return kinds;
}

/// Each kind of decoy for itself: a camera is another thing than a belief.
void add_decoys(const Page& page, std::string& out) {
  const std::map<std::string, Count> kinds = right_decoys(page.sets);
  if (kinds.empty()) return;
  out += "| decoy | right: no physics listed, nor said to lie outside |\n|---|---|\n";
  for (const auto& [name, right] : kinds) add(out, "| {} | {} of {} |\n", name, right.hits, right.of);
  out += "\n";
}

double median_of(std::vector<double> values) { return base::quantile(values, 0.5); }

/// "Half of them lie above 0.6": in a test whose errors are right, half lie above a half.
void add_p_values(const char* of, const std::vector<double>& p, std::string& out) {
  if (p.empty()) return;
  add(out,
      "- **{}**: half of them lie above {:.2f}, the smallest is {:.2g}. Even ones would come out so low with a probability of {:.2g}, so "
      "high with {:.2g} (Kolmogorov, one-sided).\n",
      of, median_of(p), *std::min_element(p.begin(), p.end()), low_p(p), high_p(p));
}

struct ScoredGroup {
  Group group;
  Score score;
};

/// By who played which mill and which program diagnosed it, and after these all of an engine with several; none where all is one.
std::vector<ScoredGroup> scored_groups(const Page& page) {
  std::vector<Group> groups = groups_of(page.sets);
  if (groups.size() < 2) return {};
  std::map<std::string, std::vector<Group>> engines;
  for (const Group& g : groups) engines[g.engine].push_back(g);
  for (const auto& [engine, own] : engines) {
    if (engines.size() < 2 || own.size() < 2) continue;
    Group all{engine, "", "all of this engine", {}};
    for (const Group& g : own) all.sets.insert(all.sets.end(), g.sets.begin(), g.sets.end());
    groups.push_back(std::move(all));
  }
  std::vector<ScoredGroup> out;
  for (Group& g : groups) {
    Score s = score(g.sets);
    out.push_back({std::move(g), std::move(s)});
  }
  return out;
}

/// "3 of 4"; nothing where none was tried.
std::string brief(const Count& c) { return c.of == 0 ? std::string() : fmt::format("{} of {}", c.hits, c.of); }

/// Of all quantities together.
Count covered_by_intervals(const Score& s) {
  Count all;
  for (const Coverage& c : s.coverage) {
    if (!c.truth) all += c.inside;
  }
  return all;
}

/// The same of each group: how many beads are recorded at once hangs on the challenge.
void add_calibration_of_groups(const std::vector<ScoredGroup>& groups, std::string& out) {
  const auto p_values = [](const std::vector<double>& p) {
    return p.empty() ? std::string(" |  | ") : fmt::format("{:.2f} | {:.2g} | {:.2g}", median_of(p), low_p(p), high_p(p));
  };
  std::string rows;
  for (const auto& [g, s] : groups) {
    if (s.empty_p.empty() && s.empty_base_p.empty()) continue;
    const std::string misfit = s.empty_base_q.empty() ? std::string() : fmt::format("{:.2f}", median_of(s.empty_base_q));
    add(rows, "| {} | {} | {} | {} | {} | {} | {} | {} |\n", g.engine, g.program, g.folders, s.false_alarms.of, p_values(s.empty_base_p),
        p_values(s.empty_p), misfit, brief(covered_by_intervals(s)));
  }
  if (rows.empty()) return;
  out +=
      "| played by | diagnosed by commit | sets of | nothing hidden | p of the base: half above | so low by chance | so high | smallest p "
      "of a hypothesis: half above | so low by chance | so high | misfit, median | 90 % intervals that hold |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n" +
      rows + "\n";
}

/// Whether errors are as large as they are said to be.
void add_calibration(const Score& s, const std::vector<ScoredGroup>& groups, std::string& out) {
  if (s.empty_p.empty() && s.empty_base_p.empty()) return;
  out +=
      "## Are the errors right?\n\nIn the sets with nothing hidden the p-values should lie evenly between 0 and 1. Low ones mean false "
      "alarms, high ones a test that is milder than it says.\n\n";
  add_p_values("Smallest p of a hypothesis, for all of them", s.empty_p, out);
  add_p_values("p of the base", s.empty_base_p, out);
  if (!s.empty_base_q.empty())
    add(out,
        "- **Misfit of the refitted base, of each number**: median {:.2f}, from {:.2f} to {:.2f}. Right errors give 1, less what the fit "
        "itself takes; far below that, errors are taken for larger than they are.\n",
        median_of(s.empty_base_q), *std::min_element(s.empty_base_q.begin(), s.empty_base_q.end()),
        *std::max_element(s.empty_base_q.begin(), s.empty_base_q.end()));
  const Count all = covered_by_intervals(s);
  if (all.of > 0) add(out, "- **90 % intervals** hold the truth in {} of {}, all quantities above together.\n", all.hits, all.of);
  out += "\n";
  add_calibration_of_groups(groups, out);
}

/// One effect that is listed, alone or in a class of two, where λ lies in a range: of whole bins.
Count named_between(const Score& s, double low, double high) {
  Count out;
  for (const PowerBin& b : s.power) {
    if (b.low >= low && b.high <= high) out += b.named;
  }
  return out;
}

/// The counts that matter most.
void add_groups(const std::vector<ScoredGroup>& groups, std::string& out) {
  if (groups.empty()) return;
  out +=
      "Each group of sets for itself, in the order of their folders. *Listed*: one effect, alone or in a class of two, by [its "
      "λ](#power).\n\n"
      "| played by | diagnosed by commit | sets of | nothing hidden: physics listed | listed, λ below 10 | λ 10 … 30 | λ ≥ 30 "
      "| one effect: `named`, and right | two: both listed together | outside: said so | decoy: right |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  constexpr double kAny = std::numeric_limits<double>::infinity();
  for (const auto& [g, s] : groups) {
    Count decoys;
    for (const auto& [name, right] : right_decoys(g.sets)) decoys += right;
    add(out, "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", g.engine, g.program, g.folders, brief(s.false_physics),
        brief(named_between(s, 0, kFaint)), brief(named_between(s, kFaint, kStrong)), brief(named_between(s, kStrong, kAny)),
        brief(s.named_alone), brief(s.two_both), brief(s.outside_abstained), brief(decoys));
  }
  out += "\n";
}

std::string manifests_text(const Page& page) {
  if (page.manifests.size() == 1) return fmt::format("the manifest's own is `{}`", page.manifests[0].second);
  std::string list;
  for (const auto& [folder, hash] : page.manifests) add(list, "{}`{}` ({})", list.empty() ? "" : ", ", hash, folder);
  return "the manifests' own are " + list;
}

Json line_json(const Line& l) {
  return {{"intercept", l.intercept}, {"slope", l.slope}, {"slope_low95", l.slope_low}, {"slope_high95", l.slope_high}};
}

Json practice_json(const Marked& m, const Concealed& concealed) {
  const Concealment* c = concealed.seen(m);
  if (c == nullptr) return {};
  return {{"power_percent", c->power_percent},
          {"shoulder_deg", c->shoulder_deg},
          {"toe_deg", c->toe_deg},
          {"chagas2015", c->chagas},
          {"unsuspicious", concealed(m)}};
}

Json sets_json(const Page& page) {
  const Concealed to_power(page.sets, &Practice::to_power), to_all(page.sets, &Practice::to_all);
  Json out = Json::array();
  for (const Marked& m : page.sets) {
    out.push_back({{"set", m.answer.set},
                   {"truth", label_of(m.answer)},
                   {"diagnosis", m.found ? Json(label_of(*m.found)) : Json()},
                   {"failure", m.found && !m.found->failure.empty() ? Json(m.found->failure) : Json()},
                   {"missed", m.found ? Json(m.missed()) : Json()},
                   {"practice", {{"to_power", practice_json(m, to_power)}, {"to_all", practice_json(m, to_all)}}}});
  }
  return out;
}

Json power_json(const Score& s) {
  Json out = Json::array();
  for (const PowerBin& b : s.power)
    out.push_back({{"lambda_from", b.low},
                   {"lambda_to", b.high},
                   {"named", count_json(b.named)},
                   {"concealed", {{"to_power", count_json(b.concealed_to_power)}, {"to_all", count_json(b.concealed_to_all)}}},
                   {"ideal", b.ideals > 0 ? Json(b.ideal) : Json()}});
  return out;
}

Json strengths_json(const Score& s) {
  Json lines = Json::object(), estimates = Json::array();
  for (const auto& [hypothesis, l] : s.lines) lines[hypothesis] = line_json(l);
  for (const Estimated& d : s.estimates)
    estimates.push_back({{"set", d.set},
                         {"hypothesis", d.hypothesis},
                         {"truth", d.truth},
                         {"estimate", d.estimate},
                         {"named", d.found},
                         {"faint", d.faint}});
  Json out = line_json(s.line);
  out["without_faint"] = line_json(s.line_of_clear);
  out["by_hypothesis"] = lines;
  out["estimates"] = estimates;
  out["at_zero"] = s.at_zero;
  return out;
}

Json coverage_json(const Score& s) {
  Json out = Json::array();
  for (const Coverage& c : s.coverage)
    out.push_back({{"of", c.of},
                   {"engine", c.engine},
                   {"truth", c.truth ? Json(*c.truth) : Json()},
                   {"inside", count_json(c.inside)},
                   {"p_holm", c.p}});
  return out;
}

}  // namespace

std::string count_text(const Count& c) {
  if (c.of == 0) return "none tried";
  return fmt::format("{} of {} ({:.0f} %; 90 %: {:.0f} … {:.0f} %)", c.hits, c.of, 100 * c.share(), 100 * lower_bound(c, kSure),
                     100 * upper_bound(c, kSure));
}

std::string page_text(const Page& page) {
  const Score& s = page.score;
  const std::vector<ScoredGroup> groups = scored_groups(page);
  std::string out = "# Score of a challenge\n\n";
  add(out, "    {}\n\n", page.command);
  add(out, "{} sets, {} diagnosed, {} of which failed; {} still to be diagnosed.\n\n", s.sets, s.diagnosed, s.failed, s.sets - s.diagnosed);
  add_tried(page, out);
  if (s.false_physics.of > 0)
    add(out,
        "**Nothing hidden: physics is named or listed in {} of {}; with 95 % confidence the rate is below {:.1f} %. Something is said to "
        "be missing in {} of {}; below {:.1f} %.**\n\n",
        s.false_physics.hits, s.false_physics.of, 100 * upper_bound(s.false_physics, kSure), s.false_alarms.hits, s.false_alarms.of,
        100 * upper_bound(s.false_alarms, kSure));
  add_groups(groups, out);
  add_said(s, out);
  add_decoys(page, out);
  out += misses_text(page);
  add_counts(s, out);
  out += figures_text(page);
  add_calibration(s, groups, out);
  out += sets_text(page);
  add(out, "## Hashes\n\nEvery answer has the hash that its manifest gives it; {}.\n", manifests_text(page));
  return out;
}

Json score_json(const Page& page) {
  const Score& s = page.score;
  Json recovery = Json::array(), gains = Json::array();
  for (const Recovery& r : s.recovery)
    recovery.push_back({{"parameter", r.parameter}, {"sets", r.sets}, {"error_retuned", r.retuned}, {"error_unmasked", r.unmasked}});
  for (const GainCount& g : s.gains)
    gains.push_back({{"against", g.model}, {"surely", count_json(g.surely)}, {"median_improvement", g.median}});
  Json said = Json::array(), power_errors = Json::array();
  for (const Said& one : s.said) said.push_back({{"what", one.what}, {"right", one.right}, {"in_part", one.part}, {"wrong", one.wrong}});
  for (const PowerError& e : s.held_out_power)
    power_errors.push_back({{"model", e.model},
                            {"one_effect", {{"mean", e.effect}, {"sets", e.effects}}},
                            {"empty", {{"mean", e.empty}, {"sets", e.empties}}}});
  return {{"schema_version", 3},
          {"command", page.command},
          {"manifest_hash", page.manifests.at(0).second},
          {"sets", s.sets},
          {"diagnosed", s.diagnosed},
          {"failed", s.failed},
          {"false_alarms", count_json(s.false_alarms)},
          {"false_names", count_json(s.false_names)},
          {"false_physics", count_json(s.false_physics)},
          {"p_values_of_empty_sets", {{"smallest", s.empty_p}, {"base", s.empty_base_p}}},
          {"named_alone", count_json(s.named_alone)},
          {"top_1", count_json(s.best_right)},
          {"in_class", count_json(s.in_class)},
          {"in_class_of_two", count_json(s.in_class_of_two)},
          {"mean_class_size", s.mean_class},
          {"faint_nothing_else", count_json(s.faint_nothing_else)},
          {"abstained_on_effect", count_json(s.abstained_on_effect)},
          {"two_both", count_json(s.two_both)},
          {"two_both_in_class", count_json(s.two_class)},
          {"two_at_least_one", count_json(s.two_one)},
          {"outside_abstained", count_json(s.outside_abstained)},
          {"outside_named", count_json(s.outside_named)},
          {"outside_missed", count_json(s.outside_missed)},
          {"decoys_named", count_json(s.decoys_named)},
          {"decoys_outside", count_json(s.decoys_outside)},
          {"coverage", coverage_json(s)},
          {"power", power_json(s)},
          {"strengths", strengths_json(s)},
          {"recovery", recovery},
          {"held_out", gains},
          {"held_out_power_percent", power_errors},
          {"said", said},
          {"held_out_better_than_every_rival", count_json(s.improves)},
          {"not_held_out", s.not_held_out},
          {"confusion", {{"truths", s.truths}, {"diagnoses", s.answers}, {"counts", s.confusion}}},
          {"every_set", sets_json(page)}};
}

}  // namespace millscope::challenge
