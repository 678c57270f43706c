// From figures to a verdict and what would tell more.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "studies/diagnose/naming/visibility.hpp"
#include "studies/diagnose/verdict/diagnosis.hpp"
#include "studies/diagnose/verdict/reach.hpp"

namespace millscope::diagnose {
namespace {

constexpr double kLongest = 1e4;  // times the recording, that are thought of
constexpr double kNear = 5;       // times the level: p of a candidate that a recording a few times as long would decide on

std::string name_of(const Diagnosis& diagnosis, Index alternative) { return diagnosis.problem.alternatives[alternative].name; }

std::string meaning(const Question& question, const Diagnosis& diagnosis, Index alternative) {
  const naming::Alternative& r = diagnosis.problem.alternatives[alternative];
  if (r.candidate) return question.candidates[*r.candidate].sentence;
  const naming::Coordinate& c = diagnosis.problem.data.theta[*r.freed];
  const double value = diagnosis.naming.judged[alternative].theta[*r.freed].value;
  if (c.logarithmic)
    return fmt::format("'{}' is {:.4g} and not {:.4g} times or over {:.2g}.", c.name, value, c.prior_mean,
                       std::exp(c.prior_sigma / c.prior_mean));
  return fmt::format("'{}' is {:.4g} and not {:.4g} ± {:.2g}.", c.name, value, c.prior_mean, c.prior_sigma);
}

double seconds(const Evidence& evidence, const std::vector<std::size_t>& conditions) {
  double sum = 0;
  for (const std::size_t c : conditions) sum += evidence.recorded[c].bead_seconds;
  return sum;
}

/// Squared distance, in noise units, between the predictions of two fitted candidates in one condition.
double separation(const Question& question, const Diagnosis& diagnosis, std::size_t condition, Index a, Index b) {
  const naming::Problem one = problem_alone(question, diagnosis.evidence, diagnosis.bank, condition, diagnosis.problem.data);
  const naming::Surrogate s(one.data);
  const MatrixXd w = naming::Weighting(one.covariance, s).whitener;
  const auto at = [&](Index alternative) {
    const naming::FitResult& fit = diagnosis.naming.judged[alternative].fit;
    return s.at(fit.coded, naming::active_of(diagnosis.problem.alternatives[alternative], fit));
  };
  return (w * (at(a) - at(b))).squaredNorm();
}

std::string to_separate(const Question& question, const Diagnosis& diagnosis) {
  const Index best = *diagnosis.naming.best;
  const Index other = *std::max_element(diagnosis.naming.kept.begin() + 1, diagnosis.naming.kept.end(), [&](Index a, Index b) {
    return diagnosis.naming.judged[a].against_best_p < diagnosis.naming.judged[b].against_best_p;
  });
  std::size_t where = diagnosis.bank.conditions.front();
  double most = -1;
  for (const std::size_t c : diagnosis.bank.conditions) {
    const double distance = separation(question, diagnosis, c, best, other);
    if (distance > most) most = distance, where = c;
  }
  const calibrate::Observation& there = diagnosis.evidence.recorded[where];
  return fmt::format("Of the conditions that were simulated, '{}' separates {} from {} best: {:.1f} noise units with {}.",
                     question.study.conditions[where].name, name_of(diagnosis, best), name_of(diagnosis, other), std::sqrt(most),
                     there.of_tracks() ? fmt::format("the {:.0f} s recorded there", there.bead_seconds) : "the errors stated there");
}

/// λ of a candidate if the recordings were longer by a factor; what the surrogate cannot follow stays.
double lambda_if(const Diagnosis& diagnosis, Index alternative, double longer) {
  const naming::Surrogate s(diagnosis.problem.data);
  const naming::Weighting weighting(diagnosis.problem.covariance, s, longer);
  return naming::Visibility(diagnosis.problem, s, weighting, {diagnosis.naming.judged[alternative].fit.coded}, alternative).lambda();
}

std::string to_see(const Diagnosis& diagnosis, double noise_units) {
  std::optional<Index> which;
  for (Index j = 0; j < std::ssize(diagnosis.naming.judged); ++j) {
    if (diagnosis.problem.alternatives[j].candidate &&
        (!which || diagnosis.naming.judged[j].lambda > diagnosis.naming.judged[*which].lambda))
      which = j;
  }
  if (!which) return "";
  double longer = 1;
  while (longer < kLongest && std::sqrt(lambda_if(diagnosis, *which, longer)) < noise_units) longer *= 1.25;
  const std::string now = fmt::format("The most visible candidate, {}, stands {:.1f} noise units out where it shows best",
                                      name_of(diagnosis, *which), std::sqrt(diagnosis.naming.judged[*which].lambda));
  if (longer >= kLongest) return now + "; a longer recording alone would not show it: the bank has to grow (bank.base, bank.each).";
  const double recorded = seconds(diagnosis.evidence, diagnosis.fit);
  if (!(recorded > 0))
    return now + fmt::format("; errors smaller by {:.2g} times would bring it to {:.0f}.", std::sqrt(longer), noise_units);
  return now + fmt::format("; about {:.2g} times the {:.0f} s recorded would bring it to {:.0f}.", longer, recorded, noise_units);
}

/// Contact parameters of the base that the study neither fits nor doubts, with their values: "pairs.glass~glass.restitution (0.8)".
std::vector<std::string> taken_for_granted(const Question& question) {
  const std::size_t first = question.study.with_role(calibrate::Role::fit).front();
  const config::Case base = config::read_case(question.study.base.string(), question.study.conditions[first].settings);
  std::set<std::string> doubted;
  for (const calibrate::Parameter& p : question.study.parameters) {
    doubted.insert(p.path);
    doubted.insert(p.tied.begin(), p.tied.end());
  }
  for (const Nuisance& n : question.nuisances) doubted.insert(n.path);
  for (const Candidate& c : question.candidates) doubted.insert(c.paths.begin(), c.paths.end());
  std::vector<std::string> out;
  for (const std::string& key : base.pairs.keys()) {
    for (const char* name : {"restitution", "static_friction"}) {
      const std::string path = fmt::format("pairs.{}.{}", key, name);
      if (doubted.contains(path) || !base.pairs.section().at(key).has(name)) continue;
      try {
        out.push_back(fmt::format("{} ({:.4g})", path, value_in(base, path, base.root.where())));
      } catch (const base::UserError&) {  // no plain number: nothing to ask for
      }
    }
  }
  return out;
}

/// What to do where no candidate suffices: ask for what nobody fits; the surest cell of the missing acceleration says where to look.
std::string to_extend(const Question& question, const Diagnosis& diagnosis, double level) {
  const MissingForce* surest = nullptr;
  for (const MissingForce& m : diagnosis.missing) {
    if (!m.cells.empty() && m.cells.front().p <= (surest == nullptr ? level : surest->cells.front().p)) surest = &m;
  }
  const std::vector<std::string> granted = taken_for_granted(question);
  const std::string first = granted.empty() ? ""
                                            : fmt::format(
                                                  "First ask whether what this study does not fit is right: {}; give it a range under "
                                                  "'parameters'. ",
                                                  fmt::join(granted, ", "));
  return first + "Add a candidate of your own under 'hypotheses', with a 'path' or a 'set' of the case or as a plugin." +
         (surest == nullptr
              ? ""
              : " What the retuned base lacks most surely: " + force_sentence(question, surest->condition, surest->cells.front()));
}

bool is_nuisance(const Diagnosis& diagnosis) { return !diagnosis.problem.alternatives[*diagnosis.naming.best].candidate; }

/// Physics has to predict better than every rival model. A nuisance beyond its prior and the base refitted to everything differ by the
/// prior alone, so that both predict alike: there it is enough that no rival model predicts surely better.
bool held_out_confirms(const Diagnosis& diagnosis) {
  return !diagnosis.held_out.empty() &&
         std::all_of(diagnosis.held_out.begin(), diagnosis.held_out.end(), [nuisance = is_nuisance(diagnosis)](const HeldOut& h) {
           if (!h.rests_on_simulations()) return false;
           return nuisance ? h.failures.empty() && !h.contradicts : h.improves;
         });
}

/// The second beside the best where both are asked for; null: it is not so.
const naming::Pair* second_beside(const naming::Result& naming, double level) {
  if (naming.pairs.empty()) return nullptr;
  const naming::Pair& pair = naming.pairs.front();
  return pair.p <= level && pair.p_first <= level && pair.goodness_p > level ? &pair : nullptr;
}

/// What lies outside the ranges that the study gave, and what stands at the end of all that was simulated.
void tell_ranges(const Question& asked, Diagnosis& diagnosis) {
  const auto [fit, active] = fit_of(diagnosis);
  const std::vector<std::string> outside = outside_ranges(asked, diagnosis.problem, fit, active);
  if (!outside.empty()) {
    diagnosis.sentence += fmt::format(" The range is too narrow: {}.", fmt::join(outside, "; "));
    if (diagnosis.next_experiment.empty()) diagnosis.next_experiment = "Widen the range in the study if such a value is possible.";
  }
  const std::vector<std::string> ends = naming::ends_of(diagnosis.problem, fit.coded, active);
  if (diagnosis.naming.best && !ends.empty())
    diagnosis.sentence += fmt::format(" The fit stands at an end of what was simulated ({}): {} not known.", fmt::join(ends, ", "),
                                      active.empty() ? "the value is" : "how strong the effect is, and what friction is beside it, is");
}

/// What could be seen for itself, but not beside the best: it may be there as well.
void tell_hidden(double noise_units, Diagnosis& diagnosis) {
  if (!diagnosis.naming.best || diagnosis.two_effects || diagnosis.verdict == Verdict::outside_library) return;
  std::vector<std::string> hidden;
  for (Index j = 0; j < std::ssize(diagnosis.naming.judged); ++j) {
    const naming::Judged& g = diagnosis.naming.judged[j];
    const bool named = std::find(diagnosis.naming.kept.begin(), diagnosis.naming.kept.end(), j) != diagnosis.naming.kept.end();
    const bool physics = diagnosis.problem.alternatives[j].candidate.has_value();
    if (physics && !named && !g.undetectable && g.lambda_beside < noise_units * noise_units)
      hidden.push_back(fmt::format("{} ({:.1f} noise units)", diagnosis.problem.alternatives[j].name, std::sqrt(g.lambda_beside)));
  }
  if (hidden.empty()) return;
  diagnosis.notes.push_back(
      fmt::format("beside {}, these data could not show at any strength: {}. It may be there as well; another speed, filling or a longer "
                  "recording would tell",
                  name_of(diagnosis, *diagnosis.naming.best), fmt::join(hidden, ", ")));
}

/// Two that are both asked for but do not describe the recordings either, though the bank may have them together.
void tell_sum(double level, Diagnosis& diagnosis) {
  if (diagnosis.naming.pairs.empty()) return;
  const naming::Pair& pair = diagnosis.naming.pairs.front();
  const auto physics = [&](Index k) { return diagnosis.problem.alternatives[k].candidate.has_value(); };
  if (pair.p > level || pair.p_first > level || !physics(pair.first) || !physics(pair.second)) return;
  const std::string first = name_of(diagnosis, pair.first), second = name_of(diagnosis, pair.second);
  const bool together =
      naming::Features(diagnosis.problem.data)
          .product(*diagnosis.problem.alternatives[pair.first].candidate, *diagnosis.problem.alternatives[pair.second].candidate)
          .has_value();
  diagnosis.sentence +=
      fmt::format(" {} beside it helps significantly, too (p = {:.2g}), but the two do not suffice either{}.", second, pair.p,
                  together ? ", with simulations of both" : ": each was simulated alone, and together they may act otherwise");
  if (together) return;
  diagnosis.next_experiment = fmt::format(
      "Put {} into the base case, with a range for its strength under 'parameters', and diagnose again: "
      "then {} is simulated together with it. {}",
      first, second, diagnosis.next_experiment);
}

/// What limits the verdict, whatever it is.
void reservations(Diagnosis& diagnosis) {
  for (const std::string& name : diagnosis.naming.at_limit)
    diagnosis.notes.push_back(
        fmt::format("the retuned {} lies at an end of its range: a wider range might conceal more; widen it and diagnose again", name));
  for (std::size_t j = 0; j < diagnosis.naming.judged.size(); ++j) {
    const naming::Alternative& r = diagnosis.problem.alternatives[j];
    if (diagnosis.naming.judged[j].tested) continue;
    diagnosis.notes.push_back(fmt::format("{} was not tested: {}", r.name,
                                          r.screened_out
                                              ? "its first simulations differ too little, at any strength, from what the parameters imitate"
                                              : "none of its simulations came to its end"));
  }
  for (const HeldOut& h : diagnosis.held_out) {
    for (const std::string& f : h.failures) diagnosis.notes.push_back("held out, failed: " + f);
    for (const std::string& name : h.not_compared)
      diagnosis.notes.push_back(fmt::format("held out, not compared: '{}', where some prediction throws no bead", name));
  }
}

/// Held-out conditions that the retuned base does not describe, at the level for all of them together (Bonferroni).
void tell_held_out(const Question& question, double level, Diagnosis& diagnosis) {
  std::vector<std::string> differ;
  for (const HeldOut& h : diagnosis.held_out) {
    if (h.base_p > level / static_cast<double>(diagnosis.held_out.size())) continue;
    differ.push_back(question.study.conditions[h.condition].name);
    diagnosis.sentence +=
        fmt::format(" But the retuned base does not describe the held-out condition '{}' (p = {:.2g}): something differs there.",
                    differ.back(), h.base_p);
  }
  if (!differ.empty())
    diagnosis.next_experiment =
        fmt::format("Give {} the role fit and hold another condition out: only what is fitted can be named.", fmt::join(differ, " and "));
}

/// The alternative with the smallest p.
Index nearest(const Diagnosis& diagnosis) {
  const std::vector<naming::Judged>& judged = diagnosis.naming.judged;
  const auto smaller = [](const naming::Judged& a, const naming::Judged& b) { return a.p_family < b.p_family; };
  return std::min_element(judged.begin(), judged.end(), smaller) - judged.begin();
}

/// Where the base is rejected and no alternative is significant: the one that comes near; nothing: none does.
std::optional<Index> near_one(const Diagnosis& diagnosis, double level) {
  if (diagnosis.naming.judged.empty()) return {};
  const Index j = nearest(diagnosis);
  return diagnosis.naming.judged[j].p_family <= kNear * level ? std::optional(j) : std::nullopt;
}

void something_missing(const Question& question, double level, Diagnosis& diagnosis) {
  diagnosis.verdict = Verdict::outside_library;
  const std::string begin =
      fmt::format("The base does not describe the recordings (p = {:.2g}), and no candidate helps significantly", diagnosis.naming.base_p);
  diagnosis.next_experiment = to_extend(question, diagnosis, level);
  const std::optional<Index> near = near_one(diagnosis, level);
  if (!near) {
    diagnosis.sentence = begin + ": something is missing that is not in the library.";
    return;
  }
  const std::string name = name_of(diagnosis, *near);
  diagnosis.sentence = begin + fmt::format(". {} comes nearest (family-wise p = {:.2g}): it may be that, or what is not in the library.",
                                           name, diagnosis.naming.judged[*near].p_family);
  diagnosis.next_experiment = fmt::format("Record for longer: then {} shows, or drops out. {}", name, diagnosis.next_experiment);
}

void nothing_named(const Question& question, double level, double noise_units, Diagnosis& diagnosis) {
  // A nuisance that would be seen says nothing of physics.
  bool blind = true;
  const bool physics = std::any_of(diagnosis.problem.alternatives.begin(), diagnosis.problem.alternatives.end(),
                                   [](const naming::Alternative& r) { return r.candidate.has_value(); });
  for (std::size_t j = 0; j < diagnosis.naming.judged.size(); ++j)
    blind = blind && (diagnosis.naming.judged[j].undetectable || (physics && !diagnosis.problem.alternatives[j].candidate));
  if (diagnosis.naming.base_p <= level) return something_missing(question, level, diagnosis);
  diagnosis.verdict = blind ? Verdict::undetectable : Verdict::no_mismatch;
  if (blind) {
    diagnosis.sentence = fmt::format(
        "The recordings look like the retuned base (p = {:.2g}), but no candidate could be seen in them at any strength: these data "
        "cannot tell.",
        diagnosis.naming.base_p);
    diagnosis.next_experiment = to_see(diagnosis, noise_units);
  } else {
    const double least = diagnosis.naming.judged[nearest(diagnosis)].p_family;
    diagnosis.sentence = fmt::format(
        "The recordings look like the base with its parameters retuned (p = {:.2g}); no candidate improves on it (smallest family-wise p = "
        "{:.2g}).",
        diagnosis.naming.base_p, least);
  }
  tell_held_out(question, level, diagnosis);
}

void decide(double level, double noise_units, Diagnosis& diagnosis) {
  const Question& question = diagnosis.question;
  if (!diagnosis.naming.best) return nothing_named(question, level, noise_units, diagnosis);
  const naming::Judged& best = diagnosis.naming.judged[*diagnosis.naming.best];
  const std::string name = name_of(diagnosis, *diagnosis.naming.best);
  for (const Index k : diagnosis.naming.kept) diagnosis.named.push_back(name_of(diagnosis, k));
  if (const naming::Pair* pair = second_beside(diagnosis.naming, level)) {
    diagnosis.named = {name, name_of(diagnosis, pair->second)};
    diagnosis.two_effects = true;
    diagnosis.verdict = Verdict::ambiguous;
    diagnosis.sentence = fmt::format(
        "Two effects together are asked for: {} and {} (p of the second beside the first {:.2g}, of the first beside the second {:.2g}).",
        name, diagnosis.named[1], pair->p, pair->p_first);
    diagnosis.next_experiment = "Hold both against a condition that was not fitted: put them into the base case and diagnose again.";
    return;
  }
  if (best.goodness_p <= level) {
    diagnosis.verdict = Verdict::outside_library;
    diagnosis.sentence = fmt::format(
        "{} helps most (family-wise p = {:.2g}) but does not suffice: with it the recordings still do not look like the model (p = "
        "{:.2g}).",
        name, best.p_family, best.goodness_p);
    diagnosis.named.clear();
    diagnosis.next_experiment = to_extend(question, diagnosis, level);
    tell_sum(level, diagnosis);
    return;
  }
  if (diagnosis.naming.kept.size() > 1) {
    diagnosis.verdict = Verdict::ambiguous;
    diagnosis.sentence = fmt::format("Something is missing (family-wise p = {:.2g}); these data cannot choose between {}.", best.p_family,
                                     fmt::join(diagnosis.named, ", "));
    diagnosis.next_experiment = to_separate(question, diagnosis);
    return;
  }
  if (!held_out_confirms(diagnosis)) {
    diagnosis.verdict = Verdict::ambiguous;
    diagnosis.sentence =
        fmt::format("{} explains the fitted conditions (family-wise p = {:.2g}), but {}: it is not counted as found.", name, best.p_family,
                    diagnosis.held_out.empty() ? "no condition was held out to confirm it"
                                               : "does not predict the held-out condition surely better than every rival model");
    diagnosis.next_experiment = diagnosis.held_out.empty()
                                    ? "Record the mill at another speed or filling and give it the role held_out."
                                    : "Record the held-out condition longer, or one farther from those that were fitted.";
    return;
  }
  diagnosis.verdict = Verdict::named;
  diagnosis.sentence = fmt::format("{} ({}; family-wise p = {:.2g}; every other candidate is rejected and the held-out conditions {}.)",
                                   meaning(question, diagnosis, *diagnosis.naming.best), name, best.p_family,
                                   is_nuisance(diagnosis) ? "do not contradict" : "are predicted better");
}

}  // namespace

bool about_to_name(const naming::Result& naming, double level) {
  return naming.best && second_beside(naming, level) == nullptr && naming.judged[*naming.best].goodness_p > level &&
         naming.kept.size() == 1;
}

std::pair<naming::FitResult, std::vector<naming::ActiveCandidate>> fit_of(const Diagnosis& diagnosis) {
  const naming::Result& n = diagnosis.naming;
  if (!n.best) return {n.base, {}};
  const auto& alternatives = diagnosis.problem.alternatives;
  if (!diagnosis.two_effects) return {n.judged[*n.best].fit, naming::active_of(alternatives[*n.best], n.judged[*n.best].fit)};
  const naming::Pair& pair = n.pairs.front();
  std::vector<naming::ActiveCandidate> active;
  for (const Index k : {pair.first, pair.second}) {
    if (alternatives[k].candidate) active.push_back({*alternatives[k].candidate, pair.fit.strengths.at(active.size())});
  }
  return {pair.fit, active};
}

void conclude(const Question& asked, double level, double noise_units, Diagnosis& diagnosis) {
  reservations(diagnosis);
  decide(level, noise_units, diagnosis);
  tell_ranges(asked, diagnosis);
  tell_hidden(noise_units, diagnosis);
}

}  // namespace millscope::diagnose
