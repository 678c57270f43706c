// The whole chain: recordings, bank, naming, held-out conditions, verdict.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "studies/calibrate/session.hpp"
#include "studies/campaign/doubts.hpp"
#include "studies/diagnose/verdict/missing_force.hpp"
#include "studies/diagnose/verdict/terms.hpp"

namespace millscope::diagnose {

enum class Verdict { no_mismatch, named, ambiguous, outside_library, undetectable };
const char* name_of(Verdict verdict);

struct Diagnosis {
  Question question;  ///< as it was answered: what was too narrow is wider (reach.hpp)
  Verdict verdict = Verdict::undetectable;
  std::string sentence;            ///< the verdict in words
  std::vector<std::string> named;  ///< hypotheses; several: two together, or a class that these data cannot split
  bool two_effects = false;        ///< `named` are two that are asked for together
  std::string next_experiment;     ///< what would tell more; "" when nothing is needed
  std::vector<std::string> notes;
  std::vector<campaign::SharedDoubt> doubts;  ///< of all simulations that were used

  std::vector<std::size_t> fit, held;
  Evidence evidence;  ///< as it was compared
  Bank bank;
  naming::Problem problem;
  naming::Result naming;
  std::vector<HeldOut> held_out;
  std::vector<Alone> alone;
  std::vector<MissingForce> missing;  ///< where the base does not describe the recordings
  TermOffer terms;                    ///< that would describe `missing`
};

/// What the session's recordings show; what they tell of a frame that the study doubts is part of it.
Evidence evidence_of(const Question& question, const host::Registry& registry, const calibrate::Session& session);

/// Everything from the bank on, at the question's level. Throws base::UserError where the draws are too few for that.
Diagnosis diagnose(const Question& asked, const calibrate::Machinery& machinery, Evidence evidence, const naming::Options& how);

/// The fit that the verdict speaks of, with the candidates that are on: of two together, of the best, or the base's.
std::pair<naming::FitResult, std::vector<naming::ActiveCandidate>> fit_of(const Diagnosis& diagnosis);

/// Whether one candidate would be named if the held-out conditions confirm it: significant, sufficient, alone in its class, and no second
/// beside it.
bool about_to_name(const naming::Result& naming, double level);

/// Verdict, sentence, names and next experiment of a diagnosis that has everything else.
void conclude(const Question& asked, double level, double noise_units, Diagnosis& diagnosis);

}  // namespace millscope::diagnose
