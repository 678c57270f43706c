#include "studies/challenge/score.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "kernel/base/statistics.hpp"
#include "studies/challenge/concealment.hpp"

namespace millscope::challenge {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCovered = 0.9;  // of the intervals

bool says_missing(const Found& f) { return f.verdict == "named" || f.verdict == "ambiguous" || f.verdict == "outside_library"; }

bool best_is(const Found& f, const std::string& name) {
  const Tested* best = f.best();
  return best != nullptr && best->name == name;
}

/// The strength that a value stands for.
double strength_of(const TrueEffect& e, double value) { return (value - e.vanishes_at) / (e.far - e.vanishes_at); }

void score_none(const Marked& m, Score& s) {
  if (!m.found->failure.empty()) return;
  s.false_alarms.add(says_missing(*m.found));
  s.false_names.add(!m.found->named.empty());
  s.false_physics.add(m.found->names_physics());
  if (std::isfinite(m.found->base_p)) s.empty_base_p.push_back(m.found->base_p);
  if (std::isfinite(m.found->base_q)) s.empty_base_q.push_back(m.found->base_q);
  if (std::isfinite(m.found->smallest_p())) s.empty_p.push_back(m.found->smallest_p());
}

bool names_all(const Marked& m) {
  return std::all_of(m.answer.effects.begin(), m.answer.effects.end(), [&](const auto& e) { return m.found->names(e.hypothesis); });
}

/// One effect: named alone, or in a class of two of which one is true; two effects: listed together.
bool is_right(const Marked& m) {
  const bool two = m.answer.kind == Kind::two;
  return names_all(m) && m.found->together == two && m.found->named.size() <= 2;
}

/// Returns the size of the class that was named; 0: none.
std::size_t score_effect(const Marked& m, Score& s) {
  const Found& f = *m.found;
  const std::string& truth = m.answer.effects.front().hypothesis;
  const bool named = f.names(truth);
  s.named_alone.add(f.verdict == "named" && named && f.named.size() == 1);
  s.best_right.add(best_is(f, truth));
  s.in_class.add(named);
  s.in_class_of_two.add(is_right(m));
  const std::optional<double> lambda = m.lambda(m.answer.effects.front());
  if (lambda && *lambda < kFaint) {
    const auto other = [&](const std::string& name) { return name != truth && f.is_physics(name); };
    s.faint_nothing_else.add(std::none_of(f.named.begin(), f.named.end(), other));
  }
  if (f.failure.empty()) s.abstained_on_effect.add(f.verdict == "outside_library");
  return f.named.size();
}

void score_two(const Marked& m, Score& s) {
  const bool first = m.found->names(m.answer.effects[0].hypothesis), second = m.found->names(m.answer.effects[1].hypothesis);
  s.two_both.add(is_right(m));
  s.two_class.add(first && second);
  s.two_one.add(first || second);
}

void score_outside(const Found& f, Score& s) {
  s.outside_abstained.add(f.verdict == "outside_library");
  if (!f.failure.empty()) return;
  s.outside_named.add(!f.named.empty());
  s.outside_missed.add(f.verdict == "no_mismatch" || f.verdict == "undetectable");
}

void score_decoy(const Found& f, Score& s) {
  if (!f.failure.empty()) return;
  s.decoys_named.add(f.names_physics());
  s.decoys_outside.add(f.verdict == "outside_library");
}

/// Of sets with one effect: beside another one λ is another.
void add_power(const Marked& m, const Concealed& to_power, const Concealed& to_all, Score& s) {
  if (m.answer.kind != Kind::effect) return;
  const TrueEffect& e = m.answer.effects.front();
  const std::optional<double> lambda = m.lambda(e);
  if (!lambda) return;
  PowerBin& bin = *std::find_if(s.power.begin(), s.power.end(), [&](const PowerBin& b) { return *lambda >= b.low && *lambda < b.high; });
  bin.named.add(is_right(m));
  if (to_power(m)) bin.concealed_to_power.add(is_right(m));
  if (to_all(m)) bin.concealed_to_all.add(is_right(m));
  const double ideal = ideal_power(*lambda, m.found->level_of(*m.found->find(e.hypothesis)));
  if (std::isfinite(ideal)) bin.ideal += (ideal - bin.ideal) / ++bin.ideals;
}

/// The row of a quantity; made where there is none yet.
Count& covered(Score& s, const std::string& of, const std::string& engine, std::optional<double> truth = {}) {
  const auto row = std::find_if(s.coverage.begin(), s.coverage.end(),
                                [&](const Coverage& c) { return c.of == of && c.engine == engine && c.truth == truth; });
  return row != s.coverage.end() ? row->inside : s.coverage.emplace_back(Coverage{of, engine, truth}).inside;
}

/// The parameters whose truth is drawn for each set. What a challenge gives all of its sets takes few values.
std::set<std::string> drawn_parameters(const std::vector<Marked>& sets) {
  constexpr std::size_t kMany = 10;
  std::map<std::string, std::vector<double>> truths;
  for (const Marked& m : sets) {
    for (const auto& [name, value] : m.answer.theta) truths[name].push_back(value);
  }
  std::set<std::string> drawn;
  for (const auto& [name, all] : truths) {
    const std::size_t values = std::set<double>(all.begin(), all.end()).size();
    if (values > std::max<std::size_t>(1, std::min(kMany, all.size() / 2))) drawn.insert(name);
  }
  return drawn;
}

void judge_coverage(Score& s) {
  std::sort(s.coverage.begin(), s.coverage.end(),
            [](const Coverage& a, const Coverage& b) { return std::tie(a.of, a.engine, a.truth) < std::tie(b.of, b.engine, b.truth); });
  std::vector<double> p;
  for (const Coverage& c : s.coverage) {
    if (!c.truth) p.push_back(binomial_p(c.inside, kCovered));
  }
  p = base::holm(p);
  auto next = p.begin();
  for (Coverage& c : s.coverage) {
    if (!c.truth) c.p = *next++;
  }
}

/// Whether the corrected model was shown to be better, where it is the right one.
void add_held_out(const Marked& m, Score& s) {
  if (m.answer.kind != Kind::effect || !best_is(*m.found, m.answer.effects.front().hypothesis)) return;
  if (m.found->improves)
    s.improves.add(*m.found->improves);
  else
    ++s.not_held_out;
}

void add_estimate(const Marked& m, Score& s) {
  if (m.answer.kind != Kind::effect) return;
  const TrueEffect& e = m.answer.effects.front();
  const Tested* tested = m.found->find(e.hypothesis);
  if (tested == nullptr || !tested->strength) return;
  s.estimates.push_back({m.answer.set, e.hypothesis, e.strength, strength_of(e, tested->strength->value), m.found->names(e.hypothesis),
                         m.lambda(e).value_or(0) < kFaint});
  if (tested->strength->known()) covered(s, kStrengthRow, m.engine()).add(tested->strength->holds(e.value));
}

/// The model that is right for the set: the base where nothing is hidden, the best candidate where that is the truth.
const std::map<std::string, base::Interval90>* right_parameters(const Marked& m) {
  if (m.answer.kind == Kind::none) return &m.found->retuned;
  if (m.answer.kind == Kind::effect && best_is(*m.found, m.answer.effects.front().hypothesis)) return &m.found->unmasked;
  return nullptr;
}

void add_theta(const Marked& m, const std::set<std::string>& drawn, Score& s) {
  const auto* parameters = right_parameters(m);
  if (parameters == nullptr) return;
  for (const auto& [name, truth] : m.answer.theta) {
    const auto interval = parameters->find(name);
    if (interval == parameters->end() || !interval->second.known()) continue;
    covered(s, name, m.engine(), drawn.count(name) > 0 ? std::nullopt : std::optional(truth)).add(interval->second.holds(truth));
  }
}

void add_recovery(const Marked& m, Score& s) {
  if (m.answer.kind != Kind::effect || right_parameters(m) == nullptr) return;
  for (const auto& [name, truth] : m.answer.theta) {
    const auto before = m.found->retuned.find(name), after = m.found->unmasked.find(name);
    if (before == m.found->retuned.end() || after == m.found->unmasked.end()) continue;
    auto r = std::find_if(s.recovery.begin(), s.recovery.end(), [&, &n = name](const auto& t) { return t.parameter == n; });
    if (r == s.recovery.end()) r = s.recovery.insert(s.recovery.end(), {name, 0, 0, 0});
    ++r->sets;
    r->retuned += (std::fabs(before->second.value - truth) - r->retuned) / r->sets;
    r->unmasked += (std::fabs(after->second.value - truth) - r->unmasked) / r->sets;
  }
}

/// Of all hypotheses, and of each.
void add_lines(Score& s) {
  std::vector<std::pair<double, double>> all, clear;
  std::map<std::string, std::vector<std::pair<double, double>>> each;
  for (const Estimated& e : s.estimates) {
    all.emplace_back(e.truth, e.estimate), each[e.hypothesis].push_back(all.back());
    if (!e.faint) clear.push_back(all.back());
  }
  s.line = line_through(all), s.line_of_clear = line_through(clear);
  for (const auto& [hypothesis, points] : each) s.lines.emplace_back(hypothesis, line_through(points));
}

/// What is estimated where there is nothing; only of hypotheses whose range the answers tell.
void add_at_zero(const std::vector<Marked>& sets, Score& s) {
  std::map<std::pair<std::string, std::string>, TrueEffect> known;  // of each study: two mills have two lifters
  for (const Marked& m : sets) {
    for (const TrueEffect& e : m.answer.effects) known.emplace(std::pair{m.study, e.hypothesis}, e);
  }
  for (const Marked& m : sets) {
    if (!m.found || m.answer.kind != Kind::none) continue;
    for (const Tested& t : m.found->hypotheses) {
      const auto e = known.find({m.study, t.name});
      if (e != known.end() && t.strength) s.at_zero.push_back(strength_of(e->second, t.strength->value));
    }
  }
}

/// Held-out gain of the sets with effects in which something right was best.
void add_gains(const std::vector<Marked>& sets, Score& s) {
  std::map<std::string, std::vector<base::Interval90>> by_model;
  for (const Marked& m : sets) {
    if (!m.found || m.answer.effects.empty()) continue;
    const bool right =
        std::any_of(m.answer.effects.begin(), m.answer.effects.end(), [&](const auto& e) { return best_is(*m.found, e.hypothesis); });
    if (!right) continue;
    for (const Gain& g : m.found->gains) by_model[g.model].push_back(g.improvement);
  }
  for (auto& [model, all] : by_model) {
    GainCount count{model, {}, 0};
    for (const base::Interval90& i : all) count.surely.add(i.low > 0);
    std::sort(all.begin(), all.end(), [](const base::Interval90& a, const base::Interval90& b) { return a.value < b.value; });
    count.median = 0.5 * (all[(all.size() - 1) / 2].value + all[all.size() / 2].value);
    s.gains.push_back(count);
  }
}

/// What a diagnosis says, whatever the names.
std::string statement_of(const Found& f) {
  if (!f.failure.empty()) return "nothing: it failed";
  if (f.verdict != "ambiguous") return f.verdict;
  if (f.together) return "ambiguous: two together";
  return f.named.size() == 1 ? "ambiguous: one listed, not confirmed by a held-out condition" : "ambiguous: a list of two and more";
}

/// Of what is hidden something is listed; of a belief that is wrong, something that is no physics.
bool lists_some(const Marked& m) {
  if (m.answer.kind == Kind::decoy) {
    return std::any_of(m.found->named.begin(), m.found->named.end(), [&](const std::string& name) {
      const Tested* tested = m.found->find(name);
      return tested != nullptr && !tested->physics;
    });
  }
  return std::any_of(m.answer.effects.begin(), m.answer.effects.end(), [&](const auto& e) { return m.found->names(e.hypothesis); });
}

void add_said(const std::vector<Marked>& sets, Score& s) {
  for (const Marked& m : sets) {
    if (!m.found) continue;
    const std::string what = statement_of(*m.found);
    auto row = std::find_if(s.said.begin(), s.said.end(), [&](const Said& one) { return one.what == what; });
    if (row == s.said.end()) row = s.said.insert(row, {what});
    ++(!m.missed() ? row->right : lists_some(m) ? row->part : row->wrong);
  }
  std::sort(s.said.begin(), s.said.end(), [](const Said& a, const Said& b) { return a.what < b.what; });
}

/// Where the right candidate is best, and where there is none, so that one can be held against the other.
void add_power_errors(const std::vector<Marked>& sets, Score& s) {
  std::map<std::string, PowerError> by_model;
  for (const Marked& m : sets) {
    if (!m.found) continue;
    const bool empty = m.answer.kind == Kind::none;
    if (!empty && (m.answer.kind != Kind::effect || !best_is(*m.found, m.answer.effects.front().hypothesis))) continue;
    for (const auto& [model, error] : m.found->power) {
      PowerError& row = by_model.try_emplace(model, PowerError{model}).first->second;
      double& mean = empty ? row.empty : row.effect;
      mean += (error - mean) / ++(empty ? row.empties : row.effects);
    }
  }
  for (const auto& [model, row] : by_model) s.held_out_power.push_back(row);
}

std::size_t place(std::vector<std::string>& labels, const std::string& label) {
  const auto found = std::find(labels.begin(), labels.end(), label);
  if (found != labels.end()) return found - labels.begin();
  labels.push_back(label);
  return labels.size() - 1;
}

void add_confusion(const std::vector<Marked>& sets, Score& s) {
  for (const Marked& m : sets) {
    if (m.found) place(s.truths, label_of(m.answer)), place(s.answers, label_of(*m.found));
  }
  std::sort(s.truths.begin(), s.truths.end());
  std::sort(s.answers.begin(), s.answers.end());
  s.confusion.assign(s.truths.size(), std::vector<int>(s.answers.size(), 0));
  for (const Marked& m : sets) {
    if (m.found) ++s.confusion[place(s.truths, label_of(m.answer))][place(s.answers, label_of(*m.found))];
  }
}

}  // namespace

bool Marked::missed() const {
  const Found& f = *found;
  if (!f.failure.empty()) return true;
  switch (answer.kind) {
    case Kind::none:
      return says_missing(f);
    case Kind::outside:
      return f.verdict != "outside_library";
    case Kind::decoy:
      return f.names_physics() || f.verdict == "outside_library";
    default:
      return !is_right(*this);
  }
}

std::vector<Group> groups_of(const std::vector<Marked>& sets) {
  std::vector<Group> groups;
  for (const Marked& m : sets) {
    auto own = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.sets.front().study == m.study && g.engine == m.engine() && g.program == m.program;
    });
    if (own == groups.end()) own = groups.insert(own, {m.engine(), m.program, "", {}});
    const std::string folder = m.folder();
    if (own->sets.empty() || own->sets.back().folder() != folder) own->folders += (own->folders.empty() ? "" : ", ") + folder;
    own->sets.push_back(m);
  }
  return groups;
}

std::string label_of(const Answer& a) {
  if (a.kind == Kind::none) return "none";
  if (a.kind == Kind::outside || a.kind == Kind::decoy) return fmt::format("{}: {}", name_of(a.kind), a.name);
  std::string out;
  for (const TrueEffect& e : a.effects) out += (out.empty() ? "" : " + ") + e.hypothesis;
  return out;
}

std::string label_of(const Found& f) {
  if (!f.failure.empty()) return "failed";
  return f.named.empty() ? f.verdict : fmt::format("{}: {}", f.verdict, fmt::join(f.named, f.together ? " + " : ", "));
}

Score score(const std::vector<Marked>& sets) {
  Score s;
  s.power = {{0, 3}, {3, 10}, {10, 30}, {30, 100}, {100, kInfinity}};
  const Concealed to_power(sets, &Practice::to_power), to_all(sets, &Practice::to_all);
  const std::set<std::string> drawn = drawn_parameters(sets);
  double class_sum = 0;
  int classes = 0;
  for (const Marked& m : sets) {
    ++s.sets;
    if (!m.found) continue;
    ++s.diagnosed;
    if (!m.found->failure.empty()) ++s.failed;
    if (m.answer.kind == Kind::none) score_none(m, s);
    if (m.answer.kind == Kind::two) score_two(m, s);
    if (m.answer.kind == Kind::outside) score_outside(*m.found, s);
    if (m.answer.kind == Kind::decoy) score_decoy(*m.found, s);
    if (m.answer.kind == Kind::effect) {
      const std::size_t size = score_effect(m, s);
      class_sum += static_cast<double>(size);
      classes += size > 0 ? 1 : 0;
    }
    add_held_out(m, s);
    add_power(m, to_power, to_all, s);
    add_estimate(m, s);
    add_theta(m, drawn, s);
    add_recovery(m, s);
  }
  if (classes > 0) s.mean_class = class_sum / classes;
  add_lines(s);
  judge_coverage(s);
  add_at_zero(sets, s);
  add_gains(sets, s);
  add_confusion(sets, s);
  add_said(sets, s);
  add_power_errors(sets, s);
  return s;
}

}  // namespace millscope::challenge
