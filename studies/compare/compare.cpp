#include "studies/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/analysis/mirror.hpp"
#include "studies/compare/elements.hpp"
#include "studies/compare/pair.hpp"
#include "studies/picture/results_pictures.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::compare {
namespace {

void align_senses(Comparison& c) {
  const double a = c.a.meta.context.omega, b = c.b.meta.context.omega;
  if (a == 0 || b == 0) {
    c.notes.push_back(fmt::format("the turning sense of {} is unknown and taken to be that of the other", a == 0 ? "A" : "B"));
    return;
  }
  if ((a > 0) == (b > 0)) return;
  std::vector<std::string> done;
  c.b = analysis::mirrored(c.b, done);
  c.notes.push_back(fmt::format("A turns {}, B {}: B is mirrored; {}", a > 0 ? "counter-clockwise" : "clockwise",
                                a > 0 ? "clockwise" : "counter-clockwise",
                                done.empty() ? "no result depends on it" : fmt::format("{}", fmt::join(done, "; "))));
}

/// A quantity without uncertainty: equal, or told.
void tell_given(Comparison& c, const PreparedObservable& prepared) {
  if (prepared.exact_differences == 0 || !prepared.compared.elements.empty() || prepared.compared.too_few > 0) return;
  const analysis::ResultArray &a = c.a.arrays[prepared.compared.array_a], &b = c.b.arrays[prepared.compared.array_b];
  const std::string unit = a.unit == "1" ? "" : " " + a.unit;
  c.given.push_back(a.shape.empty()
                        ? fmt::format("{}: {}{} in A, {}{} in B", prepared.compared.name, picture::significant_text(a.value[0], 5), unit,
                                      picture::significant_text(b.value[0], 5), unit)
                        : fmt::format("{}: {} of {} values differ and have no uncertainty", prepared.compared.name,
                                      prepared.exact_differences, a.size()));
}

/// How much data there are, and how sure something is: told when it differs, never judged.
void tell_bookkeeping(Comparison& c, const ResultPair& pair) {
  const analysis::ResultArray &a = c.a.arrays[pair.a], &b = c.b.arrays[pair.b];
  const std::string name = a.analyzer + "." + a.name, unit = a.unit == "1" ? "" : " " + a.unit;
  const auto same = [](double x, double y) {
    return (std::isnan(x) && std::isnan(y)) || std::abs(x - y) <= 1e-9 * std::max(std::abs(x), std::abs(y));
  };
  std::size_t other = std::max(a.size(), b.size()) - std::min(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) other += same(a.value[i], b.value[i]) ? 0 : 1;
  if (other == 0) return;
  c.given.push_back(a.shape.empty() && b.shape.empty()
                        ? fmt::format("{}: {}{} in A, {}{} in B (says how much data there are, or how sure something is)", name,
                                      picture::significant_text(a.value[0], 5), unit, picture::significant_text(b.value[0], 5), unit)
                        : fmt::format("{}: {} of {} values differ (says how much data there are, or how sure something is)", name, other,
                                      std::max(a.size(), b.size())));
}

void tell_unjudged(Comparison& c, const PreparedObservable& prepared) {
  const ComparedObservable& o = prepared.compared;
  if (!picture::category_names(c.a.arrays[o.array_a]).empty()) c.not_judged.push_back(o.name + ": names, not numbers");
  if (!o.elements.empty() || o.too_few == 0) return;
  const analysis::ResultArray& array = c.a.arrays[o.array_a];
  c.not_judged.push_back(array.draws.empty() && array.size() > analysis::kMostDrawnValues
                             ? fmt::format("{}: more than {} values, for which no resamples are kept", o.name, analysis::kMostDrawnValues)
                             : fmt::format("{}: rests on fewer than 10 independent blocks", o.name));
}

void judge_all(Comparison& c, std::vector<PreparedObservable>& prepared) {
  std::vector<TestedObservable> tested;
  for (PreparedObservable& p : prepared) tested.push_back(std::move(p.tested));
  const std::vector<ObservableVerdict> verdicts = judge(tested, c.options.confidence);
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    ComparedObservable& o = prepared[i].compared;
    o.p = verdicts[i].p, o.adjusted_p = verdicts[i].adjusted_p, o.strongest = verdicts[i].strongest;
    for (std::size_t k = 0; k < o.elements.size(); ++k) o.elements[k].test = verdicts[i].elements[k];
    c.observables.push_back(std::move(o));
  }
  std::stable_sort(c.observables.begin(), c.observables.end(), [](const ComparedObservable& x, const ComparedObservable& y) {
    if (x.adjusted_p != y.adjusted_p) return x.adjusted_p < y.adjusted_p;
    if (x.p != y.p) return x.p < y.p;
    return x.elements[x.strongest].test.deviate > y.elements[y.strongest].test.deviate;
  });
}

std::string level_text(double level) { return fmt::format("{} %", picture::significant_text(100 * level, 1)); }

void conclude(Comparison& c) {
  const std::size_t all = c.observables.size();
  if (all == 0) {
    c.verdict_kind = Verdict::cannot_tell;
    c.verdict = fmt::format("cannot tell: no result rests on 10 independent blocks in both (A has {} blocks, B {}); analyse longer spans",
                            c.a.meta.blocks.size(), c.b.meta.blocks.size());
    return;
  }
  const auto differ = std::count_if(c.observables.begin(), c.observables.end(),
                                    [&](const ComparedObservable& o) { return o.adjusted_p <= c.options.level; });
  if (differ == 0) {
    c.verdict_kind = Verdict::no_difference;
    c.verdict = fmt::format("no difference at {} family-wise in {} observable{}", level_text(c.options.level), all, all == 1 ? "" : "s");
    return;
  }
  const ComparedObservable& first = c.observables.front();
  const ComparedElement& e = first.elements[first.strongest];
  c.verdict_kind = Verdict::differ;
  c.verdict =
      fmt::format("{} of {} observables differ{} at {} family-wise; strongest: {}{}", differ, all, differ == 1 && all == 1 ? "s" : "",
                  level_text(c.options.level), first.name, e.where.empty() ? "" : ", " + e.where);
}

}  // namespace

Comparison compare(const analysis::ResultSet& a, const analysis::ResultSet& b, const CompareOptions& options) {
  Comparison c;
  c.a = a, c.b = b, c.options = options;
  align_senses(c);
  for (std::string& note : condition_notes(c.a, c.b)) c.notes.push_back(std::move(note));
  std::vector<PreparedObservable> prepared;
  std::vector<ResultPair> bookkeeping;
  for (const ResultPair& pair : pair_results(c.a, c.b, options, c.not_judged)) {
    if (is_bookkeeping(c.a, c.b, pair)) {
      bookkeeping.push_back(pair);
      continue;
    }
    PreparedObservable p = prepare_observable(c.a, c.b, pair);
    tell_given(c, p);
    tell_unjudged(c, p);
    if (p.compared.elements.empty()) continue;
    prepared.push_back(std::move(p));
    PreparedObservable regions = prepare_regions(c.a, c.b, pair);
    if (!regions.compared.elements.empty()) prepared.push_back(std::move(regions));
  }
  for (const ResultPair& pair : bookkeeping) tell_bookkeeping(c, pair);  // after what was given
  judge_all(c, prepared);
  conclude(c);
  return c;
}

}  // namespace millscope::compare
