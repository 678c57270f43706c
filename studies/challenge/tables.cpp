// Tables of the page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "studies/challenge/concealment.hpp"
#include "studies/challenge/page.hpp"

namespace millscope::challenge {
namespace {

constexpr double kMuchLonger = 100;

template <class... Values>
void append(std::string& out, fmt::format_string<Values...> text, Values&&... values) {
  fmt::format_to(std::back_inserter(out), text, std::forward<Values>(values)...);
}

/// λ of the effects, each at its strength; "" where the diagnosis does not tell it.
std::string lambdas(const Marked& m) {
  std::string out;
  for (const TrueEffect& e : m.answer.effects) {
    const std::optional<double> lambda = m.lambda(e);
    if (lambda) append(out, "{}{:.0f}", out.empty() ? "" : ", ", *lambda);
  }
  return out;
}

/// By how much a recording would have to be longer for four of five to tell the effect; "" where this one is long enough.
std::string longer(const Marked& m) {
  if (m.answer.kind != Kind::effect) return "";
  const TrueEffect& e = m.answer.effects.front();
  const std::optional<double> lambda = m.lambda(e);
  if (!lambda || !std::isfinite(m.found->level)) return "";
  const double times = telling_lambda(m.found->level_of(*m.found->find(e.hypothesis))) / *lambda;
  if (times <= 1) return "";
  return times < kMuchLonger ? fmt::format("{:.{}f} ×", times, times < 10 ? 1 : 0) : fmt::format("over {:g} ×", kMuchLonger);
}

/// The strength that was fitted to a set with one effect; "" where there is none.
std::string estimates(const Score& s, const std::string& set) {
  const auto found = std::find_if(s.estimates.begin(), s.estimates.end(), [&](const Estimated& e) { return e.set == set; });
  return found == s.estimates.end() ? "" : fmt::format("{:.2f}", found->estimate);
}

void every_set(const Page& page, std::string& out) {
  out +=
      "## Every set\n\nλ as above; beside another effect it is less. *Longer*: a recording about so many times as long tells the effect in "
      "four sets of five, by the ideal test above; the error of the simulations does not shrink with it.\n\n"
      "| set | hidden | strength (1: the far end of the prior range) | found | λ | longer | diagnosis |\n|---|---|---|---|---|---|---|\n";
  for (const Marked& m : page.sets) {
    std::string strength;
    for (const TrueEffect& e : m.answer.effects) strength += fmt::format("{}{:.2f}", strength.empty() ? "" : ", ", e.strength);
    append(out, "| {} | {} | {} | {} | {} | {} | {}{} |\n", m.answer.set, label_of(m.answer), strength, estimates(page.score, m.answer.set),
           lambdas(m), longer(m), m.found ? label_of(*m.found) : "not diagnosed yet",
           m.found && !m.found->failure.empty() ? ": " + m.found->failure : "");
  }
  out += "\n";
}

/// Every set in which the base lacks something, beside a base that was tuned in one way.
void concealment(const Page& page, Tuned tuned, std::string_view how, std::string& out) {
  const Concealed concealed(page.sets, tuned);
  if (std::none_of(page.sets.begin(), page.sets.end(), [&](const Marked& m) { return m.found && concealed.seen(m); })) return;
  append(out, "**{}**\n\n| set | hidden | power | shoulder | toe | Eq. 4.3 | concealed | diagnosis |\n|---|---|---|---|---|---|---|---|\n",
         how);
  Count found, empty;
  int unknown = 0;
  for (const Marked& m : page.sets) {
    if (!m.found) continue;
    const Concealment* c = concealed.seen(m);
    if (c == nullptr) {
      unknown += m.answer.kind == Kind::effect ? 1 : 0;
      continue;
    }
    if (m.answer.kind == Kind::none) empty.add(concealed(m));
    if (m.answer.kind == Kind::none || m.answer.kind == Kind::decoy) continue;
    append(out, "| {} | {} | {:+.2f} % | {:+.2f}° | {:+.2f}° | {:.2f} | {} | {} |\n", m.answer.set, label_of(m.answer), c->power_percent,
           c->shoulder_deg, c->toe_deg, c->chagas, concealed.word_for(m), label_of(*m.found));
    if (concealed(m) && m.answer.kind == Kind::effect) found.add(!m.missed());
  }
  append(out,
         "\nOf the concealed sets with one effect it is listed, alone or in a class of two, in {}. The same limits hold in {} of the sets "
         "where nothing is hidden, which practice would not suspect either.{}\n\n",
         count_text(found), fmt::format("{} of {}", empty.hits, empty.of),
         unknown == 0 ? "" : fmt::format(" Of {} more with one effect it is not known whether they are concealed.", unknown));
}

/// What practice sees of every set.
void concealment(const Page& page, std::string& out) {
  std::string tables;
  concealment(page, &Practice::to_power, "The base whose friction was retuned to the power alone, less the truth:", tables);
  concealment(page, &Practice::to_all, "The base that was refitted to all numbers of all fitted conditions, less the truth:", tables);
  if (tables.empty()) return;
  append(
      out,
      "## Concealed\n\nLong runs of the truth and of a base that was tuned to its recordings, at the speed where power was retuned. A set "
      "with physics that the base lacks is *concealed* where power agrees within {:g} %, shoulder and toe within {:g}°, and Eq. 4.3 of "
      "Chagas 2015 is below the 90 % quantile of sets without an effect that were recorded alike: of the same mill, played by the same "
      "engine, as many tracers for as long. Where these are fewer than ten, Eq. 4.3 is not asked for.\n\n{}",
      Unsuspicious().power_percent, Unsuspicious().degrees, tables);
}

void power(const Score& s, std::string& out) {
  out +=
      "## Power\n\nλ: squared length, in noise units, of the effect's part that no retuning imitates, by the diagnosis' own "
      "surrogate, at the hidden strength. Sets with one effect. *Ideal*: a test of one number with normal noise of known "
      "size, at the candidate's share of the level (Bonferroni): Φ(√λ − z), mean of the bin's sets.\n\n"
      "| λ | listed, alone or in a class of two | of those [concealed](#concealed) by friction retuned to power | by refitting to "
      "everything | ideal |\n|---|---|---|---|---|\n";
  const auto hits = [](const Count& c) { return c.of == 0 ? "" : fmt::format("{} of {}", c.hits, c.of); };
  for (const PowerBin& b : s.power)
    append(out, "| {} | {} | {} | {} | {} |\n",
           std::isfinite(b.high) ? fmt::format("{:g} … {:g}", b.low, b.high) : fmt::format("{:g} and more", b.low), count_text(b.named),
           hits(b.concealed_to_power), hits(b.concealed_to_all), b.ideals == 0 ? "" : fmt::format("{:.0f} %", 100 * b.ideal));
  out += "\n";
}

void line(const std::string& of, const Line& l, std::string& out) {
  if (!std::isfinite(l.slope)) return;
  append(out, "| {} | {} | {:.2f} | {:.2f} | {} |\n", of, l.points, l.intercept, l.slope,
         std::isfinite(l.slope_low) ? fmt::format("{:.2f} … {:.2f}", l.slope_low, l.slope_high) : "too few sets");
}

void strengths(const Score& s, std::string& out) {
  out += "## Strengths\n\n";
  if (std::isfinite(s.line.slope)) {
    out +=
        "estimate = intercept + slope × hidden strength, least squares, sets that name nothing included (each set below). The strengths of "
        "different candidates have different scales, so that the line through all is a check and no law. A hidden strength is known "
        "exactly; the interval is that of the sets drawn anew, so that errors may differ. An estimate of a one-sided strength cannot be "
        "below 0, nor beyond the reach of the simulations, which lifts faint ones and holds strong ones back. Recordings tell little of "
        "the strength of what is faint, so the others stand for themselves, too.\n\n"
        "| | sets | intercept | slope | 95 % of the slope |\n|---|---|---|---|---|\n";
    line("all", s.line, out);
    line(fmt::format("those with λ of {:g} and more", kFaint), s.line_of_clear, out);
    for (const auto& [hypothesis, l] : s.lines) line(hypothesis, l, out);
    out += "\n";
  }
  if (!s.at_zero.empty()) {
    const double mean = std::accumulate(s.at_zero.begin(), s.at_zero.end(), 0.0) / static_cast<double>(s.at_zero.size());
    append(
        out,
        "Where nothing is hidden, {} fitted strengths have a mean of {:.2f} and a maximum of {:.2f}; one-sided ones cannot be below 0.\n",
        s.at_zero.size(), mean, *std::max_element(s.at_zero.begin(), s.at_zero.end()));
  }
  if (s.estimates.empty() && s.at_zero.empty()) out += "No strength was estimated.\n";
  out += "\n";
}

void coverage(const Score& s, std::string& out) {
  out +=
      "## Coverage of the 90 % intervals\n\np: that intervals which hold the truth in 90 % give such a count, by the exact binomial test, "
      "for "
      "all rows together (Holm 1979).\n\n| of | played by | truth inside | p |\n|---|---|---|---|\n";
  for (const Coverage& c : s.coverage)
    append(out, "| {} | {} | {} | {} |\n", c.truth ? fmt::format("{}, truth {:g}", c.of, *c.truth) : c.of, c.engine, count_text(c.inside),
           c.truth ? "one truth: one trial" : fmt::format("{:.2g}", c.p));
  out +=
      "\nParameters: of the base where nothing is hidden, of the corrected model where its physics is the hidden one. A strength has an "
      "interval "
      "only where some candidate is significant. p takes sets as independent, though those of one mill share one bank.\n\n";
  if (s.recovery.empty()) return;
  out +=
      "## Parameters recovered\n\nMean distance from the truth, in the sets with one effect whose best candidate is right.\n\n"
      "| parameter | sets | retuned base | with the effect |\n|---|---|---|---|\n";
  for (const Recovery& r : s.recovery) append(out, "| {} | {} | {:.3g} | {:.3g} |\n", r.parameter, r.sets, r.retuned, r.unmasked);
  out += "\n";
}

void gains(const Score& s, std::string& out) {
  out += "## Held-out gain\n\n";
  append(
      out,
      "One effect, and the best candidate is it: at the held-out conditions its model is surely better than every rival in {}{}. A verdict "
      "`named` asks for this.\n\n",
      count_text(s.improves), s.not_held_out == 0 ? "" : fmt::format("; {} more were not simulated there", s.not_held_out));
  if (s.gains.empty()) {
    out += "No set with a hidden effect has a right best candidate and a held-out condition: no gain was shown.\n";
    return;
  }
  out +=
      "Where the best candidate is right: by how much the corrected model's misfit on held-out conditions is smaller than that of …\n\n"
      "| … | surely smaller | median improvement |\n|---|---|---|\n";
  for (const GainCount& g : s.gains) append(out, "| {} | {} | {:.2f} |\n", g.model, count_text(g.surely), g.median);
}

void held_out_power(const Score& s, std::string& out) {
  if (s.held_out_power.empty()) return;
  const auto mean = [](double error, int sets) { return sets == 0 ? std::string() : fmt::format("{:.2f} % ({})", error, sets); };
  out +=
      "\nMean error of the power predicted for the held-out conditions (sets). Where nothing is hidden, it says what chance makes of a "
      "base.\n\n"
      "| model | one effect, and the best candidate is it | nothing hidden |\n|---|---|---|\n";
  for (const PowerError& e : s.held_out_power)
    append(out, "| {} | {} | {} |\n", e.model, mean(e.effect, e.effects), mean(e.empty, e.empties));
  out += "\n";
}

}  // namespace

std::string misses_text(const Page& page) {
  std::string out;
  const auto missed = [](const Marked& m) { return m.found && m.missed(); };
  if (std::none_of(page.sets.begin(), page.sets.end(), missed)) return out;
  out +=
      "## Misses\n\nAll sets whose diagnosis is not what is hidden: something missing where nothing is, one effect that is not listed "
      "alone or in a class of two, two that are not listed together, what lies outside not said to, a decoy taken for physics or said to "
      "lie "
      "outside, and those that failed. The remarks are of whoever looked into them, after opening.\n\n"
      "| set | hidden | λ | diagnosis | remark |\n|---|---|---|---|---|\n";
  for (const Marked& m : page.sets) {
    if (missed(m))
      append(out, "| {} | {} | {} | {} | {} |\n", m.answer.set, label_of(m.answer), lambdas(m), label_of(*m.found),
             m.remark.empty() ? "not looked into" : m.remark);
  }
  return out + "\n";
}

std::string figures_text(const Page& page) {
  std::string out;
  power(page.score, out);
  gains(page.score, out);
  held_out_power(page.score, out);
  strengths(page.score, out);
  coverage(page.score, out);
  return out;
}

std::string sets_text(const Page& page) {
  std::string out;
  concealment(page, out);
  every_set(page, out);
  return out;
}

}  // namespace millscope::challenge
