#include "studies/challenge/page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace millscope::challenge {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSure = 0.95;  // of every one-sided bound

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
  out += "| of the sets with … | counted | the others |\n|---|---|---|\n";
  line("nothing hidden: something is said to be missing (false alarm)", s.false_alarms);
  line("nothing hidden: a name is given", s.false_names);
  line("one effect: named alone, and rightly", s.named_alone);
  line("one effect: the best candidate is the truth (top-1)", s.best_right);
  line("one effect: the truth is among those named", s.in_class);
  line("one effect: the truth is named, alone or in a class of two", s.in_class_of_two);
  line("one effect: said to lie outside the library (wrong abstention)", s.abstained_on_effect);
  line("two effects: both named", s.two_both);
  line("two effects: at least one named", s.two_one);
  line("physics outside the list: said to lie outside (right abstention)", s.outside_abstained);
  line("physics outside the list: something of the list named (wrong)", s.outside_named);
  line("physics outside the list: not noticed", s.outside_missed);
  line("decoy (another camera, or what is believed is wrong): physics is named (wrong)", s.decoys_named);
  line("decoy: said to lie outside the library (wrong)", s.decoys_outside);
  if (std::isfinite(s.mean_class))
    add(out, "\nWhere one effect is hidden and something is named, {:.2f} candidates are named in the mean.\n", s.mean_class);
}

std::string manifests_text(const Page& page) {
  if (page.manifests.size() == 1) return fmt::format("the manifest's own is `{}`", page.manifests[0].second);
  std::string list;
  for (const auto& [folder, hash] : page.manifests) add(list, "{}`{}` ({})", list.empty() ? "" : ", ", hash, folder);
  return "the manifests' own are " + list;
}

Json sets_json(const Page& page) {
  Json out = Json::array();
  for (const Marked& m : page.sets) {
    out.push_back({{"set", m.answer.set},
                   {"truth", label_of(m.answer)},
                   {"diagnosis", m.found ? Json(label_of(*m.found)) : Json()},
                   {"failure", m.found && !m.found->failure.empty() ? Json(m.found->failure) : Json()}});
  }
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
  std::string out = "# Score of a challenge\n\n";
  add(out, "    {}\n\n", page.command);
  add(out,
      "{} sets, {} diagnosed, {} of which failed; {} still to be diagnosed. Every answer has the hash that its manifest gives it; {}.\n\n",
      s.sets, s.diagnosed, s.failed, s.sets - s.diagnosed, manifests_text(page));
  if (s.false_alarms.of > 0)
    add(out, "**False alarms: {} of {}; with 95 % confidence the rate is below {:.1f} %.**\n\n", s.false_alarms.hits, s.false_alarms.of,
        100 * upper_bound(s.false_alarms, kSure));
  add_counts(s, out);
  out +=
      "\nIntervals behind counts are of Clopper and Pearson (1934), 5 % on each side. A diagnosis that failed counts as a miss; where "
      "nothing is hidden it is left out.\n\n";
  return out + tables_text(page);
}

Json score_json(const Page& page) {
  const Score& s = page.score;
  Json theta = Json::object(), power = Json::array(), estimates = Json::array(), recovery = Json::array(), gains = Json::array();
  for (const auto& [name, count] : s.theta) theta[name] = count_json(count);
  for (const PowerBin& b : s.power) power.push_back({{"lambda_from", b.low}, {"lambda_to", b.high}, {"named", count_json(b.named)}});
  for (const Estimated& d : s.estimates)
    estimates.push_back({{"set", d.set}, {"hypothesis", d.hypothesis}, {"truth", d.truth}, {"estimate", d.estimate}, {"named", d.found}});
  for (const Recovery& r : s.recovery)
    recovery.push_back({{"parameter", r.parameter}, {"sets", r.sets}, {"error_retuned", r.retuned}, {"error_unmasked", r.unmasked}});
  for (const GainCount& g : s.gains)
    gains.push_back({{"against", g.model}, {"surely", count_json(g.surely)}, {"median_improvement", g.median}});
  return {{"schema_version", 2},
          {"command", page.command},
          {"manifest_hash", page.manifests.at(0).second},
          {"sets", s.sets},
          {"diagnosed", s.diagnosed},
          {"failed", s.failed},
          {"false_alarms", count_json(s.false_alarms)},
          {"false_names", count_json(s.false_names)},
          {"named_alone", count_json(s.named_alone)},
          {"top_1", count_json(s.best_right)},
          {"in_class", count_json(s.in_class)},
          {"in_class_of_two", count_json(s.in_class_of_two)},
          {"mean_class_size", s.mean_class},
          {"abstained_on_effect", count_json(s.abstained_on_effect)},
          {"two_both", count_json(s.two_both)},
          {"two_at_least_one", count_json(s.two_one)},
          {"outside_abstained", count_json(s.outside_abstained)},
          {"outside_named", count_json(s.outside_named)},
          {"outside_missed", count_json(s.outside_missed)},
          {"decoys_named", count_json(s.decoys_named)},
          {"decoys_outside", count_json(s.decoys_outside)},
          {"strength_coverage", count_json(s.strength)},
          {"parameter_coverage", theta},
          {"power", power},
          {"strengths", {{"slope", s.line.slope}, {"intercept", s.line.intercept}, {"estimates", estimates}, {"at_zero", s.at_zero}}},
          {"recovery", recovery},
          {"held_out", gains},
          {"confusion", {{"truths", s.truths}, {"diagnoses", s.answers}, {"counts", s.confusion}}},
          {"every_set", sets_json(page)}};
}

}  // namespace millscope::challenge
