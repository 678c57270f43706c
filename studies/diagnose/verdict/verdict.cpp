// From figures to a verdict and what would tell more.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "studies/diagnose/naming/visibility.hpp"
#include "studies/diagnose/verdict/diagnosis.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kLongest = 1e4;  // times the recording, that are thought of

std::string rival_name(const Diagnosis& d, int rival) { return d.problem.rivals[static_cast<std::size_t>(rival)].name; }

std::string meaning(const Question& q, const Diagnosis& d, int rival) {
  const Rival& r = d.problem.rivals[static_cast<std::size_t>(rival)];
  if (r.candidate >= 0) return q.candidates[static_cast<std::size_t>(r.candidate)].sentence;
  const Coordinate& c = d.problem.data.theta[static_cast<std::size_t>(r.freed)];
  const double value = d.naming.judged[static_cast<std::size_t>(rival)].theta[static_cast<std::size_t>(r.freed)].value;
  if (c.logarithmic)
    return fmt::format("'{}' is {:.4g} and not {:.4g} times or over {:.2g}.", c.name, value, c.prior_mean,
                       std::exp(c.prior_sigma / c.prior_mean));
  return fmt::format("'{}' is {:.4g} and not {:.4g} ± {:.2g}.", c.name, value, c.prior_mean, c.prior_sigma);
}

double seconds(const Workshop& workshop, const std::vector<std::size_t>& conditions) {
  double sum = 0;
  for (const std::size_t c : conditions) sum += workshop.recorded[c].bead_seconds;
  return sum;
}

/// Squared distance, in noise units, between the predictions of two fitted candidates in one condition.
double separation(const Question& q, const Workshop& workshop, const Diagnosis& d, std::size_t condition, int a, int b) {
  const Problem one = problem_alone(q, workshop, d.bank, condition, d.problem.data);
  const Surrogate s(one.data);
  const MatrixXd w = Weighting(one.covariance, s).whitener;
  const auto at = [&](int rival) {
    const FitResult& fit = d.naming.judged[static_cast<std::size_t>(rival)].fit;
    return s.at(fit.coded, effects_of(d.problem.rivals[static_cast<std::size_t>(rival)], fit));
  };
  return (w * (at(a) - at(b))).squaredNorm();
}

std::string to_separate(const Question& q, const Workshop& workshop, const Diagnosis& d) {
  const int best = d.naming.best;
  const int other = *std::max_element(d.naming.kept.begin() + 1, d.naming.kept.end(), [&](int a, int b) {
    return d.naming.judged[static_cast<std::size_t>(a)].against_best_p < d.naming.judged[static_cast<std::size_t>(b)].against_best_p;
  });
  std::size_t where = d.bank.conditions.front();
  double most = -1;
  for (const std::size_t c : d.bank.conditions) {
    const double distance = separation(q, workshop, d, c, best, other);
    if (distance > most) most = distance, where = c;
  }
  const calibrate::Observation& there = workshop.recorded[where];
  return fmt::format("Of the conditions that were simulated, '{}' separates {} from {} best: {:.1f} noise units with {}.",
                     q.study.conditions[where].name, rival_name(d, best), rival_name(d, other), std::sqrt(most),
                     there.of_tracks() ? fmt::format("the {:.0f} s recorded there", there.bead_seconds) : "the errors stated there");
}

/// λ of a candidate if the recordings were longer by a factor; what the surrogate cannot follow stays.
double lambda_if(const Diagnosis& d, int rival, double longer) {
  const Surrogate s(d.problem.data);
  const Weighting weighting(d.problem.covariance, s, longer);
  return Visibility(d.problem, s, weighting, d.naming.judged[static_cast<std::size_t>(rival)].fit.coded, rival).lambda();
}

std::string to_see(const Workshop& workshop, const Diagnosis& d, double noise_units) {
  int which = -1;
  for (std::size_t j = 0; j < d.naming.judged.size(); ++j) {
    if (d.problem.rivals[j].candidate >= 0 &&
        (which < 0 || d.naming.judged[j].lambda > d.naming.judged[static_cast<std::size_t>(which)].lambda))
      which = static_cast<int>(j);
  }
  if (which < 0) return "";
  double longer = 1;
  while (longer < kLongest && std::sqrt(lambda_if(d, which, longer)) < noise_units) longer *= 1.25;
  const std::string now = fmt::format("The most visible candidate, {}, stands {:.1f} noise units out at its strongest",
                                      rival_name(d, which), std::sqrt(d.naming.judged[static_cast<std::size_t>(which)].lambda));
  if (longer >= kLongest) return now + "; a longer recording alone would not show it: the bank has to grow (bank.base, bank.each).";
  const double recorded = seconds(workshop, d.fit);
  if (!(recorded > 0))
    return now + fmt::format("; errors smaller by {:.2g} times would bring it to {:.0f}.", std::sqrt(longer), noise_units);
  return now + fmt::format("; about {:.2g} times the {:.0f} s recorded would bring it to {:.0f}.", longer, recorded, noise_units);
}

/// What to do where no candidate suffices: the surest cell of the missing acceleration says where to look.
std::string to_extend(const Question& q, const Diagnosis& d, double level) {
  const MissingForce* surest = nullptr;
  for (const MissingForce& m : d.missing) {
    if (!m.cells.empty() && m.cells.front().p <= (surest == nullptr ? level : surest->cells.front().p)) surest = &m;
  }
  return "Add a candidate of your own under 'hypotheses', with a 'path' or a 'set' of the case or as a plugin." +
         (surest == nullptr ? ""
                            : " What the retuned base lacks most surely: " + force_sentence(q, surest->condition, surest->cells.front()));
}

bool is_nuisance(const Diagnosis& d) { return d.problem.rivals[static_cast<std::size_t>(d.naming.best)].candidate < 0; }

/// Physics has to predict better than every rival. A nuisance beyond its prior and the base refitted to everything differ by the prior
/// alone, so that both predict alike: there it is enough that no rival predicts surely better.
bool held_out_confirms(const Diagnosis& d) {
  return !d.held_out.empty() && std::all_of(d.held_out.begin(), d.held_out.end(), [nuisance = is_nuisance(d)](const HeldOut& h) {
    return nuisance ? h.failures.empty() && !h.contradicts : h.improves;
  });
}

/// What limits the verdict, whatever it is.
void reservations(Diagnosis& d) {
  for (const std::string& name : d.naming.at_limit)
    d.notes.push_back(
        fmt::format("the retuned {} lies at an end of its range: a wider range might conceal more; widen it and diagnose again", name));
  for (std::size_t j = 0; j < d.naming.judged.size(); ++j) {
    const Rival& r = d.problem.rivals[j];
    if (d.naming.judged[j].tested) continue;
    d.notes.push_back(fmt::format("{} was not tested: {}", r.name,
                                  r.screened_out
                                      ? "even at its strongest its first simulations differ too little from what the parameters imitate"
                                      : "none of its simulations came to its end"));
  }
  for (const HeldOut& h : d.held_out) {
    for (const std::string& f : h.failures) d.notes.push_back("held out, failed: " + f);
    for (const std::string& name : h.not_compared)
      d.notes.push_back(fmt::format("held out, not compared: '{}', where some prediction throws no bead", name));
  }
}

/// Held-out conditions that the retuned base does not describe, at the level for all of them together (Bonferroni).
void tell_held_out(const Question& q, double level, Diagnosis& d) {
  std::vector<std::string> differ;
  for (const HeldOut& h : d.held_out) {
    if (h.base_p > level / static_cast<double>(d.held_out.size())) continue;
    differ.push_back(q.study.conditions[h.condition].name);
    d.sentence += fmt::format(" But the retuned base does not describe the held-out condition '{}' (p = {:.2g}): something differs there.",
                              differ.back(), h.base_p);
  }
  if (!differ.empty())
    d.next_experiment =
        fmt::format("Give {} the role fit and hold another condition out: only what is fitted can be named.", fmt::join(differ, " and "));
}

void nothing_named(const Question& q, const Workshop& workshop, double level, double noise_units, Diagnosis& d) {
  // A nuisance that would be seen says nothing of physics.
  bool blind = true;
  const bool physics = std::any_of(d.problem.rivals.begin(), d.problem.rivals.end(), [](const Rival& r) { return r.candidate >= 0; });
  for (std::size_t j = 0; j < d.naming.judged.size(); ++j)
    blind = blind && (d.naming.judged[j].undetectable || (physics && d.problem.rivals[j].candidate < 0));
  if (d.naming.base_p <= level) {
    d.verdict = Verdict::outside_library;
    d.sentence = fmt::format(
        "The base does not describe the recordings (p = {:.2g}) and no candidate helps significantly: something is missing that is not in "
        "the library.",
        d.naming.base_p);
    d.next_experiment = to_extend(q, d, level);
    return;
  }
  d.verdict = blind ? Verdict::undetectable : Verdict::no_mismatch;
  if (blind) {
    d.sentence = fmt::format(
        "The recordings look like the retuned base (p = {:.2g}), but no candidate could be seen in them even at its strongest: these data "
        "cannot tell.",
        d.naming.base_p);
    d.next_experiment = to_see(workshop, d, noise_units);
  } else {
    const double least = std::min_element(d.naming.judged.begin(), d.naming.judged.end(), [](const Judged& a, const Judged& b) {
                           return a.p_family < b.p_family;
                         })->p_family;
    d.sentence = fmt::format(
        "The recordings look like the base with its parameters retuned (p = {:.2g}); no candidate improves on it (smallest family-wise p = "
        "{:.2g}).",
        d.naming.base_p, least);
  }
  tell_held_out(q, level, d);
}

}  // namespace

void conclude(const Question& q, const Workshop& workshop, double level, double noise_units, Diagnosis& d) {
  reservations(d);
  if (d.naming.best < 0) return nothing_named(q, workshop, level, noise_units, d);
  const Judged& best = d.naming.judged[static_cast<std::size_t>(d.naming.best)];
  const std::string name = rival_name(d, d.naming.best);
  for (const int k : d.naming.kept) d.named.push_back(rival_name(d, k));
  if (!d.naming.pairs.empty()) {
    const Pair& pair = d.naming.pairs.front();
    if (pair.p <= level && pair.p_first <= level && pair.goodness_p > level) {
      d.named = {name, rival_name(d, pair.second)};
      d.two_effects = true;
      d.verdict = Verdict::ambiguous;
      d.sentence = fmt::format(
          "Two effects together are asked for: {} and {} (p of the second beside the first {:.2g}, of the first beside the second {:.2g}).",
          name, d.named[1], pair.p, pair.p_first);
      d.next_experiment = "Hold both against a condition that was not fitted: put them into the base case and diagnose again.";
      return;
    }
  }
  if (best.goodness_p <= level) {
    d.verdict = Verdict::outside_library;
    d.sentence = fmt::format(
        "{} helps most (family-wise p = {:.2g}) but does not suffice: with it the recordings still do not look like the model (p = "
        "{:.2g}).",
        name, best.p_family, best.goodness_p);
    d.named.clear();
    d.next_experiment = to_extend(q, d, level);
    return;
  }
  if (d.naming.kept.size() > 1) {
    d.verdict = Verdict::ambiguous;
    d.sentence = fmt::format("Something is missing (family-wise p = {:.2g}); these data cannot choose between {}.", best.p_family,
                             fmt::join(d.named, ", "));
    d.next_experiment = to_separate(q, workshop, d);
    return;
  }
  if (!held_out_confirms(d)) {
    d.verdict = Verdict::ambiguous;
    d.sentence =
        fmt::format("{} explains the fitted conditions (family-wise p = {:.2g}), but {}: it is not counted as found.", name, best.p_family,
                    d.held_out.empty() ? "no condition was held out to confirm it"
                                       : "does not predict the held-out condition surely better than every rival");
    d.next_experiment = d.held_out.empty() ? "Record the mill at another speed or filling and give it the role held_out."
                                           : "Record the held-out condition longer, or one farther from those that were fitted.";
    return;
  }
  d.verdict = Verdict::named;
  d.sentence =
      fmt::format("{} ({}; family-wise p = {:.2g}; every rival is rejected and the held-out conditions {}.)", meaning(q, d, d.naming.best),
                  name, best.p_family, is_nuisance(d) ? "do not contradict" : "are predicted better");
}

}  // namespace millscope::diagnose
