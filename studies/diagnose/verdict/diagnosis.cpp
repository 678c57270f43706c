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

void note(const Workshop& workshop, std::vector<std::string> lines, Diagnosis& d) {
  for (std::string& line : lines) {
    say(workshop, line);
    d.notes.push_back(std::move(line));
  }
}

/// The bank, with what is compared defined in all of it.
Bank filled(const Question& question, Workshop& workshop, const std::vector<BankPoint>& points, const std::vector<std::size_t>& conditions,
            Diagnosis& d) {
  Bank bank = fill_bank(question, workshop, points, conditions);
  note(workshop, leave_out_undefined(question, workshop, bank), d);
  return bank;
}

struct Screened {
  std::vector<BankPoint> points;
  std::vector<bool> candidate;  ///< whether it cannot matter
};

/// The bank's first runs of each candidate tell which cannot matter; the others get all of theirs.
Screened screened(const Question& question, Workshop& workshop, Diagnosis& d, double noise_units) {
  Screened out{plan_screening(question), std::vector<bool>(question.candidates.size(), false)};
  const std::vector<BankPoint>& points = out.points;
  const Bank bank = filled(question, workshop, points, d.fit, d);
  note(workshop, unsettled(question, bank, d.fit), d);  // before the rest, all with an effect, is simulated in vain
  const Problem problem = problem_of(question, workshop, bank, d.fit);
  const Surrogate surrogate(problem.data);
  const Weighting weighting(problem.covariance, surrogate);
  const FitResult base = Model(problem.data, surrogate, weighting, {}).fit(problem.observed);
  const double limit = kMargin * noise_units;
  for (std::size_t j = 0; j < question.candidates.size(); ++j) {
    if (surrogate.features().count(static_cast<int>(j)) == 0) {
      say(workshop, fmt::format("{}: none of its first simulations came to its end: it is not tested", question.candidates[j].name));
      continue;
    }
    const Visibility seen(problem, surrogate, weighting, base.coded, static_cast<int>(j));
    const double most = std::sqrt(seen.lambda_high());
    const std::string what =
        fmt::format("{}: at its strongest {:.1f} noise units beyond what the parameters imitate, below {:.1f} with 95 %",
                    question.candidates[j].name, std::sqrt(seen.lambda()), most);
    say(workshop, what + (most < limit ? ": it cannot matter here" : ": looked at closely"));
    out.candidate[j] = most < limit;
    if (most < limit) continue;
    for (BankPoint& p : plan_rest(question, static_cast<int>(j))) out.points.push_back(std::move(p));
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
void note_recordings(const Question& question, const Workshop& workshop, Diagnosis& d) {
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
  for (const auto& [what, where] : lines) d.notes.push_back(fmt::format("recording of {}: {}", where, what));
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

Diagnosis diagnose(const Question& question, Workshop& workshop, const NamingOptions& options) {
  Diagnosis d;
  d.fit = question.study.with_role(calibrate::Role::fit);
  d.held = question.study.with_role(calibrate::Role::held_out);
  const Screened screening = screened(question, workshop, d, options.noise_units);
  std::vector<std::size_t> all = d.fit;
  all.insert(all.end(), d.held.begin(), d.held.end());
  d.bank = filled(question, workshop, screening.points, all, d);
  note(workshop, unsettled(question, d.bank, d.held), d);
  d.problem = problem_of(question, workshop, d.bank, d.fit);
  for (Rival& r : d.problem.rivals) r.screened_out = r.candidate >= 0 && screening.candidate[static_cast<std::size_t>(r.candidate)];
  d.naming = name_physics(d.problem, options);
  const HeldOutRequest request{question, workshop, d.bank, d.problem, d.naming, d.fit, kSeeds, options.seed};
  d.alone = fit_alone(request);
  for (const std::size_t condition : d.held) {
    say(workshop, fmt::format("held-out condition '{}'", question.study.conditions[condition].name));
    d.held_out.push_back(hold_against(request, condition));
  }
  if (d.naming.best >= 0 || d.naming.base_p <= options.level) {
    say(workshop, "missing mean acceleration, by place and speed");
    d.missing = missing_force(request);
    d.terms = offer_terms(d.missing);
  }
  d.notes.insert(d.notes.end(), d.problem.data.left_out.begin(), d.problem.data.left_out.end());
  note_recordings(question, workshop, d);
  for (std::size_t c = 0; c < workshop.readings.size(); ++c) {
    if (!workshop.readings[c].empty())
      d.notes.push_back(
          fmt::format("frame of '{}', by the recorded beads: {}", question.study.conditions[c].name, text_of(workshop.readings[c])));
  }
  for (const std::string& line : question.left_out) d.notes.push_back("not tested: " + line);
  conclude(question, workshop, options.level, options.noise_units, d);
  return d;
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
