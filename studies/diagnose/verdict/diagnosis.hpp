// The whole chain: recordings, bank, naming, held-out conditions, verdict.
#pragma once

#include <string>
#include <vector>

#include "studies/calibrate/session.hpp"
#include "studies/diagnose/verdict/missing_force.hpp"
#include "studies/diagnose/verdict/terms.hpp"

namespace millscope::diagnose {

enum class Verdict { no_mismatch, named, ambiguous, outside_library, undetectable };
const char* name_of(Verdict verdict);

struct Diagnosis {
  Verdict verdict = Verdict::undetectable;
  std::string sentence;            ///< the verdict in words
  std::vector<std::string> named;  ///< hypotheses; several: two together, or a class that these data cannot split
  bool two_effects = false;        ///< `named` are two that are asked for together
  std::string next_experiment;     ///< what would tell more; "" when nothing is needed
  std::vector<std::string> notes;

  std::vector<std::size_t> fit, held;
  Bank bank;
  naming::Problem problem;
  naming::Result naming;
  std::vector<HeldOut> held_out;
  std::vector<Alone> alone;
  std::vector<MissingForce> missing;  ///< where the base does not describe the recordings
  TermOffer terms;                    ///< that would describe `missing`
};

/// Everything from the bank on.
Diagnosis diagnose(const Question& question, Workshop& workshop, const naming::Options& options);

/// Verdict, sentence, names and next experiment of a diagnosis that has everything else.
void conclude(const Question& question, const Workshop& workshop, double level, double noise_units, Diagnosis& diagnosis);

/// The workshop of a session.
Workshop workshop_of(const Question& question, const host::Registry& registry, calibrate::Session& session,
                     std::function<void(const std::string&)> say);

}  // namespace millscope::diagnose
