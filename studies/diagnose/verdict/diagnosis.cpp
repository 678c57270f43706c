#include "studies/diagnose/verdict/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>

#include "studies/diagnose/naming/visibility.hpp"
#include "studies/diagnose/question/camera_frame.hpp"
#include "studies/diagnose/verdict/reach.hpp"

namespace millscope::diagnose {
namespace {

constexpr std::ptrdiff_t kFewestBeyond = 3;  // parameter sets beyond an end, for a range to be widened
constexpr int kSeeds = 6;                    // of every model in a held-out condition
constexpr double kMargin =
    0.7;  // of the noise units: at other frictions, or other values of what is varied apart, it may act more strongly

void note(const calibrate::Machinery& machinery, std::vector<std::string> lines, Diagnosis& diagnosis) {
  for (std::string& line : lines) {
    machinery.say(line);
    diagnosis.notes.push_back(std::move(line));
  }
}

/// The bank; what some of it leaves undefined is no evidence any more.
Bank filled(const Question& question, const calibrate::Machinery& machinery, const std::vector<BankPoint>& points,
            const std::vector<std::size_t>& conditions, Diagnosis& diagnosis) {
  Bank bank = fill_bank(question, machinery, diagnosis.evidence, points, conditions);
  const Undefined undefined = undefined_in(question, bank);
  note(machinery, undefined.notes, diagnosis);
  diagnosis.evidence = leave_out(std::move(diagnosis.evidence), undefined);
  return leave_out(std::move(bank), undefined);
}

struct Screened {
  std::vector<BankPoint> points;
  std::vector<bool> candidate;  ///< whether it cannot matter
};

/// The bank's first runs of each candidate tell which cannot matter; the others get all of theirs.
Screened screened(const Question& question, const calibrate::Machinery& machinery, Diagnosis& diagnosis, double noise_units) {
  Screened out{plan_screening(question), std::vector<bool>(question.candidates.size(), false)};
  const std::vector<BankPoint>& points = out.points;
  const Bank bank = filled(question, machinery, points, diagnosis.fit, diagnosis);
  note(machinery, unsettled(question, bank, diagnosis.fit), diagnosis);  // before the rest, all with a candidate, is simulated in vain
  const naming::Problem problem = problem_of(question, diagnosis.evidence, bank, diagnosis.fit);
  const naming::Surrogate surrogate(problem.data);
  const naming::Weighting weighting(problem.covariance, surrogate);
  const naming::FitResult base = naming::Model(problem.data, surrogate, weighting, {}).fit(problem.observed);
  const double limit = kMargin * noise_units;
  for (Index j = 0; j < std::ssize(question.candidates); ++j) {
    if (surrogate.features().count(j) == 0) {
      machinery.say(fmt::format("{}: none of its first simulations came to its end: it is not tested", question.candidates[j].name));
      continue;
    }
    const naming::Visibility seen(problem, surrogate, weighting, {base.coded}, j);
    const double most = std::sqrt(seen.lambda_high());
    const std::string what =
        fmt::format("{}: where it shows best {:.1f} noise units beyond what the parameters imitate, below {:.1f} with 95 %",
                    question.candidates[j].name, std::sqrt(seen.lambda()), most);
    machinery.say(what + (most < limit ? ": it cannot matter here" : ": looked at closely"));
    out.candidate[j] = most < limit;
    if (most < limit) continue;
    for (BankPoint& p : plan_rest(question, j)) out.points.push_back(std::move(p));
  }
  return out;
}

/// Parameter sets of a group that came to their end in every condition.
std::ptrdiff_t finished(const Bank& bank, const std::string& group) {
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < bank.points.size(); ++i) {
    const auto& seen = bank.seen[i];
    if (bank.points[i].group == group && std::all_of(seen.begin(), seen.end(), [](const auto& o) { return o.has_value(); })) ++count;
  }
  return count;
}

/// What is asked for in held-out conditions: the best candidate, and those that were not rejected against it.
AskedCandidates asked_of(const Diagnosis& diagnosis) {
  const naming::Features features(diagnosis.problem.data);
  AskedCandidates asked;
  for (const Index k : diagnosis.naming.kept) {
    if (const auto& candidate = diagnosis.problem.alternatives[k].candidate) {
      asked.which.insert(*candidate);
      asked.coefficients += features.count(*candidate);
    }
  }
  return asked;
}

/// The bank of the held-out conditions, beside that of the fitted ones.
void hold_out(const Question& asked, const calibrate::Machinery& machinery, Diagnosis& diagnosis) {
  if (diagnosis.held.empty()) return;
  const Bank held = filled(asked, machinery, held_out_points(asked, diagnosis.bank.points, asked_of(diagnosis)), diagnosis.held, diagnosis);
  note(machinery, unsettled(asked, held, diagnosis.held), diagnosis);
  if (!held.failures.empty())
    note(machinery,
         {fmt::format("{} simulations of held-out conditions failed and are left out, the first: {}", held.failures.size(),
                      held.failures.front())},
         diagnosis);
  diagnosis.bank = joined(std::move(diagnosis.bank), held);
}

naming::Problem problem_after(const Screened& screening, const Diagnosis& diagnosis) {
  naming::Problem problem = problem_of(diagnosis.question, diagnosis.evidence, diagnosis.bank, diagnosis.fit);
  for (naming::Alternative& r : problem.alternatives) r.screened_out = r.candidate && screening.candidate[*r.candidate];
  return problem;
}

/// Where a fit stands at an end of a range, simulations beyond it: once. The bank is that of the question as it was asked, whose plan says
/// where each of its simulations begins; only what is learnt from it has the wider ranges.
void reach_farther(const calibrate::Machinery& machinery, Screened& screening, Diagnosis& diagnosis) {
  std::vector<std::pair<End, std::string>> beyond;  // the group of its simulations
  for (const End& end : ends_reached(diagnosis.question, diagnosis.problem)) {
    const std::vector<BankPoint> points = plan_beyond(diagnosis.question, end);
    if (std::ssize(points) < kFewestBeyond) continue;  // the study's constraints leave too little
    note(machinery, {sentence_of(diagnosis.question, end)}, diagnosis);
    screening.points.insert(screening.points.end(), points.begin(), points.end());
    beyond.emplace_back(end, points.front().group);
  }
  if (beyond.empty()) return;
  diagnosis.bank = filled(diagnosis.question, machinery, screening.points, diagnosis.bank.conditions, diagnosis);
  for (const auto& [end, group] : beyond) {
    if (finished(diagnosis.bank, group) >= kFewestBeyond) diagnosis.question = widened(std::move(diagnosis.question), end);
  }
  diagnosis.problem = problem_after(screening, diagnosis);
}

/// As many simulations again with each candidate that helps, and those of two at once; of the question as it was asked.
void simulate_further(const Question& asked, const calibrate::Machinery& machinery, double noise_units, Screened& screening,
                      Diagnosis& diagnosis) {
  const AskedFor further = asked_for(diagnosis.problem, kMargin * noise_units);
  const auto& alternatives = diagnosis.problem.alternatives;
  const auto add = [&](const std::vector<BankPoint>& points) {
    screening.points.insert(screening.points.end(), points.begin(), points.end());
  };
  std::vector<std::string> helpful, together;
  for (const Index a : further.helpful) {
    helpful.push_back(alternatives[a].name);
    add(plan_more(asked, *alternatives[a].candidate));
  }
  for (const auto& [first, second] : further.pairs) {
    together.push_back(alternatives[first].name + " with " + alternatives[second].name);
    add(plan_pair(asked, *alternatives[first].candidate, *alternatives[second].candidate));
  }
  if (helpful.empty()) return;
  note(machinery, {fmt::format("simulated twice as often, for it helps: {}", fmt::join(helpful, ", "))}, diagnosis);
  if (!together.empty()) note(machinery, {fmt::format("simulated together: {}", fmt::join(together, ", "))}, diagnosis);
  diagnosis.bank = filled(asked, machinery, screening.points, diagnosis.bank.conditions, diagnosis);
  diagnosis.problem = problem_after(screening, diagnosis);
}

/// What was noted of the recordings; what holds for several is said once.
void note_recordings(const Question& question, Diagnosis& diagnosis) {
  std::vector<std::pair<std::string, std::string>> lines;  // what; of which conditions
  for (std::size_t c = 0; c < diagnosis.evidence.recorded.size(); ++c) {
    for (const std::string& what : diagnosis.evidence.recorded[c].notes) {
      const std::string name = "'" + question.study.conditions[c].name + "'";
      const auto known = std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.first == what; });
      if (known == lines.end())
        lines.emplace_back(what, name);
      else
        known->second += ", " + name;
    }
  }
  for (const auto& [what, where] : lines) diagnosis.notes.push_back(fmt::format("recording of {}: {}", where, what));
}

/// The study's level, which the draws have to resolve: the smallest family-wise p of n alternatives is n over the draws.
naming::Options at_level_of(const Question& question, naming::Options options) {
  constexpr int kFiner = 4;  // than what would just do
  constexpr double kComparisons = 10;
  options.level = question.level;
  const std::size_t alternatives = std::max<std::size_t>(2, question.candidates.size() + question.nuisances.size());
  const int least = static_cast<int>(std::ceil(static_cast<double>(alternatives) / options.level));
  if (options.draws == 0) {
    options.draws = std::max(naming::Options{}.draws, kFiner * least);
    options.comparison_draws = std::max(options.comparison_draws, static_cast<int>(std::ceil(kComparisons / options.level)));
  }
  if (options.draws < least)
    throw base::UserError(fmt::format("--draws {}: too few for {} candidates and nuisances at the study's level of {:.3g}; give {} or more",
                                      options.draws, alternatives, options.level, least));
  return options;
}

/// The same machinery, which notes where the simulations are that it is asked for.
calibrate::Machinery noting(const calibrate::Machinery& machinery, std::set<std::filesystem::path>& runs) {
  calibrate::Machinery out = machinery;
  out.run = [&runs, run = machinery.run](std::span<const campaign::Simulation> simulations) {
    std::vector<campaign::Outcome> outcomes = run(simulations);
    for (const campaign::Outcome& outcome : outcomes) runs.insert(outcome.folder);
    return outcomes;
  };
  return out;
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_mismatch:
      return "no_mismatch";
    case Verdict::named:
      return "named";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::outside_library:
      return "outside_library";
    case Verdict::undetectable:
      return "undetectable";
  }
  return "";
}

Diagnosis diagnose(const Question& asked, const calibrate::Machinery& given, Evidence evidence, const naming::Options& how) {
  const naming::Options options = at_level_of(asked, how);
  std::set<std::filesystem::path> runs;
  const calibrate::Machinery machinery = noting(given, runs);
  Diagnosis diagnosis;
  diagnosis.question = asked;
  const Question& question = diagnosis.question;
  diagnosis.evidence = std::move(evidence);
  diagnosis.fit = question.study.with_role(calibrate::Role::fit);
  diagnosis.held = question.study.with_role(calibrate::Role::held_out);
  Screened screening = screened(question, machinery, diagnosis, options.noise_units);
  diagnosis.bank = filled(question, machinery, screening.points, diagnosis.fit, diagnosis);
  diagnosis.problem = problem_after(screening, diagnosis);
  reach_farther(machinery, screening, diagnosis);
  simulate_further(asked, machinery, options.noise_units, screening, diagnosis);
  diagnosis.naming = naming::name_candidates(diagnosis.problem, options);
  hold_out(asked, machinery, diagnosis);
  const HeldOutRequest request{.question = question,
                               .machinery = machinery,
                               .evidence = diagnosis.evidence,
                               .bank = diagnosis.bank,
                               .problem = diagnosis.problem,
                               .naming = diagnosis.naming,
                               .fit = diagnosis.fit,
                               .at_stake = about_to_name(diagnosis.naming, options.level),
                               .alarm = options.level / static_cast<double>(std::max<std::size_t>(1, diagnosis.held.size())),
                               .seeds = kSeeds,
                               .seed = options.seed};
  diagnosis.alone = fit_alone(request);
  for (const std::size_t condition : diagnosis.held) {
    diagnosis.held_out.push_back(hold_against(request, condition));
    machinery.say(
        fmt::format("held-out condition '{}': {}", question.study.conditions[condition].name, sources_sentence(diagnosis.held_out.back())));
  }
  if (diagnosis.naming.best || diagnosis.naming.base_p <= options.level) {
    machinery.say("missing mean acceleration, by place and speed");
    diagnosis.missing = missing_force(request);
    diagnosis.terms = offer_terms(diagnosis.missing);
  }
  diagnosis.notes.insert(diagnosis.notes.end(), diagnosis.problem.data.left_out.begin(), diagnosis.problem.data.left_out.end());
  note_recordings(question, diagnosis);
  for (std::size_t c = 0; c < diagnosis.evidence.readings.size(); ++c) {
    if (!diagnosis.evidence.readings[c].empty())
      diagnosis.notes.push_back(fmt::format("frame of '{}', by the recorded beads: {}", question.study.conditions[c].name,
                                            text_of(diagnosis.evidence.readings[c])));
  }
  for (const std::string& line : question.left_out) diagnosis.notes.push_back("not tested: " + line);
  diagnosis.doubts = campaign::shared_doubts(runs);
  conclude(asked, options.level, options.noise_units, diagnosis);
  return diagnosis;
}

Evidence evidence_of(const Question& question, const host::Registry& registry, const calibrate::Session& session) {
  check_recorded_frames(question, session.observer());
  Evidence evidence{session.recorded()};
  const auto of_camera = [](const Nuisance& n) { return n.of_camera(); };
  if (std::none_of(question.nuisances.begin(), question.nuisances.end(), of_camera)) return evidence;
  for (std::size_t c = 0; c < evidence.recorded.size(); ++c)
    evidence.readings.push_back(read_frame(question, expected_mill(question, c, registry), session.observer().recording(c)));
  share_errors(evidence.readings);
  for (std::size_t c = 0; c < evidence.recorded.size(); ++c) {
    const std::vector<FrameReading>& readings = evidence.readings[c];
    add_readings(readings, evidence.recorded[c]);
    if (!readings.empty())
      session.machinery().say(
          fmt::format("condition '{}', its frame by its own beads: {}", question.study.conditions[c].name, text_of(readings)));
  }
  return evidence;
}

}  // namespace millscope::diagnose
