#include "studies/diagnose/verdict/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/diagnose/naming/visibility.hpp"
#include "studies/diagnose/question/camera_frame.hpp"

namespace millscope::diagnose {
namespace {

constexpr int kSeeds = 6;  // of every model in a held-out condition
constexpr double kMargin =
    0.7;  // of the noise units: at other frictions, or other values of what is varied apart, it may act more strongly

void say(const Workshop& workshop, const std::string& line) {
  if (workshop.say) workshop.say(line);
}

void note(const Workshop& workshop, std::vector<std::string> lines, Diagnosis& diagnosis) {
  for (std::string& line : lines) {
    say(workshop, line);
    diagnosis.notes.push_back(std::move(line));
  }
}

/// The bank, with what is compared defined in all of it.
Bank filled(const Question& question, Workshop& workshop, const std::vector<BankPoint>& points, const std::vector<std::size_t>& conditions,
            Diagnosis& diagnosis) {
  Bank bank = fill_bank(question, workshop, points, conditions);
  note(workshop, leave_out_undefined(question, workshop, bank), diagnosis);
  return bank;
}

struct Screened {
  std::vector<BankPoint> points;
  std::vector<bool> candidate;  ///< whether it cannot matter
};

/// The bank's first runs of each candidate tell which cannot matter; the others get all of theirs.
Screened screened(const Question& question, Workshop& workshop, Diagnosis& diagnosis, double noise_units) {
  Screened out{plan_screening(question), std::vector<bool>(question.candidates.size(), false)};
  const std::vector<BankPoint>& points = out.points;
  const Bank bank = filled(question, workshop, points, diagnosis.fit, diagnosis);
  note(workshop, unsettled(question, bank, diagnosis.fit), diagnosis);  // before the rest, all with a candidate, is simulated in vain
  const naming::Problem problem = problem_of(question, workshop, bank, diagnosis.fit);
  const naming::Surrogate surrogate(problem.data);
  const naming::Weighting weighting(problem.covariance, surrogate);
  const naming::FitResult base = naming::Model(problem.data, surrogate, weighting, {}).fit(problem.observed);
  const double limit = kMargin * noise_units;
  for (Index j = 0; j < std::ssize(question.candidates); ++j) {
    if (surrogate.features().count(j) == 0) {
      say(workshop, fmt::format("{}: none of its first simulations came to its end: it is not tested", question.candidates[j].name));
      continue;
    }
    const naming::Visibility seen(problem, surrogate, weighting, base.coded, j);
    const double most = std::sqrt(seen.lambda_high());
    const std::string what =
        fmt::format("{}: at its strongest {:.1f} noise units beyond what the parameters imitate, below {:.1f} with 95 %",
                    question.candidates[j].name, std::sqrt(seen.lambda()), most);
    say(workshop, what + (most < limit ? ": it cannot matter here" : ": looked at closely"));
    out.candidate[j] = most < limit;
    if (most < limit) continue;
    for (BankPoint& p : plan_rest(question, j)) out.points.push_back(std::move(p));
  }
  return out;
}

/// What the recordings tell of a frame that the study doubts becomes part of what they show.
void read_frames(const Question& question, const host::Registry& registry, Workshop& workshop) {
  const auto of_camera = [](const Nuisance& n) { return n.of_camera(); };
  if (std::none_of(question.nuisances.begin(), question.nuisances.end(), of_camera)) return;
  for (std::size_t c = 0; c < question.study.conditions.size(); ++c) {
    const studies::Recording recording = studies::read_recording(question.study.conditions[c].recording);
    workshop.readings.push_back(read_frame(question, expected_mill(question, c, registry), recording));
  }
  share_errors(workshop.readings);
  for (std::size_t c = 0; c < workshop.readings.size(); ++c) {
    add_readings(workshop.readings[c], workshop.recorded[c]);
    if (!workshop.readings[c].empty())
      say(workshop,
          fmt::format("condition '{}', its frame by its own beads: {}", question.study.conditions[c].name, text_of(workshop.readings[c])));
  }
}

/// What was noted of the recordings; what holds for several is said once.
void note_recordings(const Question& question, const Workshop& workshop, Diagnosis& diagnosis) {
  std::vector<std::pair<std::string, std::string>> lines;  // what; of which conditions
  for (std::size_t c = 0; c < workshop.recorded.size(); ++c) {
    for (const std::string& what : workshop.recorded[c].notes) {
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

Diagnosis diagnose(const Question& question, Workshop& workshop, const naming::Options& options) {
  Diagnosis diagnosis;
  diagnosis.fit = question.study.with_role(calibrate::Role::fit);
  diagnosis.held = question.study.with_role(calibrate::Role::held_out);
  const Screened screening = screened(question, workshop, diagnosis, options.noise_units);
  std::vector<std::size_t> all = diagnosis.fit;
  all.insert(all.end(), diagnosis.held.begin(), diagnosis.held.end());
  diagnosis.bank = filled(question, workshop, screening.points, all, diagnosis);
  note(workshop, unsettled(question, diagnosis.bank, diagnosis.held), diagnosis);
  diagnosis.problem = problem_of(question, workshop, diagnosis.bank, diagnosis.fit);
  for (naming::Alternative& r : diagnosis.problem.alternatives) r.screened_out = r.candidate && screening.candidate[*r.candidate];
  diagnosis.naming = naming::name_candidates(diagnosis.problem, options);
  const HeldOutRequest request{question,         workshop,      diagnosis.bank, diagnosis.problem,
                               diagnosis.naming, diagnosis.fit, kSeeds,         options.seed};
  diagnosis.alone = fit_alone(request);
  for (const std::size_t condition : diagnosis.held) {
    say(workshop, fmt::format("held-out condition '{}'", question.study.conditions[condition].name));
    diagnosis.held_out.push_back(hold_against(request, condition));
  }
  if (diagnosis.naming.best || diagnosis.naming.base_p <= options.level) {
    say(workshop, "missing mean acceleration, by place and speed");
    diagnosis.missing = missing_force(request);
    diagnosis.terms = offer_terms(diagnosis.missing);
  }
  diagnosis.notes.insert(diagnosis.notes.end(), diagnosis.problem.data.left_out.begin(), diagnosis.problem.data.left_out.end());
  note_recordings(question, workshop, diagnosis);
  for (std::size_t c = 0; c < workshop.readings.size(); ++c) {
    if (!workshop.readings[c].empty())
      diagnosis.notes.push_back(
          fmt::format("frame of '{}', by the recorded beads: {}", question.study.conditions[c].name, text_of(workshop.readings[c])));
  }
  for (const std::string& line : question.left_out) diagnosis.notes.push_back("not tested: " + line);
  conclude(question, workshop, options.level, options.noise_units, diagnosis);
  return diagnosis;
}

Workshop workshop_of(const Question& question, const host::Registry& registry, calibrate::Session& session,
                     std::function<void(const std::string&)> say) {
  check_recorded_frames(question, session.observer());
  const calibrate::Machinery& m = session.evaluator().machinery();
  const auto seen = [&session](std::size_t condition, const campaign::Outcome& outcome, const std::string& camera) {
    return session.observer().simulated(condition, outcome.folder, outcome.key, camera);
  };
  const auto again = [&session](std::size_t condition, const campaign::Outcome& outcome, const std::string& analyzers,
                                const std::string& camera) {
    return session.observer().results(condition, outcome.folder, outcome.key, analyzers, camera);
  };
  std::vector<calibrate::Observation> recorded;
  for (std::size_t c = 0; c < session.evaluator().study().conditions.size(); ++c) recorded.push_back(session.observer().recorded(c));
  Workshop workshop{m.run, seen, std::move(recorded), std::move(say), again};
  read_frames(question, registry, workshop);
  return workshop;
}

}  // namespace millscope::diagnose
