// How far a bank is: which of its planned simulations the cache has, and how long the others will take.
#pragma once

#include <string>
#include <vector>

#include "studies/campaign/campaign.hpp"
#include "studies/diagnose/question/question.hpp"

namespace millscope::diagnose {

/// One simulation of the bank.
struct PlannedRun {
  std::string group;          ///< "base", the name of a candidate or of a nuisance that is varied apart, or "candidate*nuisance"
  std::size_t condition = 0;  ///< of the study
  campaign::Simulation simulation;
};

/// The base group first, then those of nuisances that are varied apart, then every candidate's, first alone and then with these; the
/// conditions that are fitted before those that are held out. A diagnosis asks for less where it screens a candidate out, or where those of
/// its class suffice in a held-out condition; and for more where one helps: simulations of it in held-out conditions, among others.
std::vector<PlannedRun> planned_runs(const Question& question);

/// Runs of one group in one condition.
struct BankCell {
  std::string group;
  std::size_t condition = 0;
  int planned = 0, done = 0, failed = 0, running = 0;
  double wall_s = 0;  ///< of those that are done, together
  double rest_s = 0;  ///< estimate for those that are neither done nor failed, on one core
  int waiting() const { return planned - done - failed - running; }
};

struct BankStatus {
  std::vector<BankCell> cells;
  std::vector<std::string> failures;  ///< "base_3_speed75: …"
  std::string other_programs = {};    ///< campaign::other_programs_sentence
  BankCell total;
  bool estimated = false;  ///< some run is done, so that there is a time to go by
};

/// Looks every planned run up in the cache; starts nothing. A rest takes as long for its work (beads × simulated time) as the runs of its
/// own group and condition did; where none is done, as all together did.
BankStatus bank_status(const Question& question, const campaign::Options& options);

/// A table for people; `slots`: simulations at once.
std::string status_text(const Question& question, const BankStatus& status, int slots);

/// "40 s", "12 min", "3.5 h".
std::string duration_text(double seconds);

}  // namespace millscope::diagnose
