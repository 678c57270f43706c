// What the practice sees of a truth: long runs of it, of the base whose friction was retuned to its power, and
// of the base that was refitted to all numbers of the recordings; all at the condition where power was retuned. Power, shoulder, toe and
// Eq. 4.3 of Chagas 2015, of the beads as they were, without a camera.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "studies/campaign/campaign.hpp"
#include "studies/challenge/score.hpp"

namespace millscope::challenge {

inline constexpr const char* kConcealmentFile = "concealment.json";

struct ConcealOptions {
  double seconds = 40;  ///< that are looked at of every run
  campaign::Options campaign;
};

/// Three runs for every set with a diagnosis that is no decoy, by its opened answer, into SETS/concealment.json; what stands there is kept.
/// Where the diagnosis does not tell a tuned base, or a run fails, NaN.
void conceal(const diagnose::Question& question, const std::filesystem::path& sets, const host::Registry& registry,
             const ConcealOptions& options);

/// By set; empty where nobody has looked.
std::map<std::string, Practice> read_concealment(const std::filesystem::path& sets);

/// Limits within which the practice takes base and truth for one, for sets that were recorded alike: shorter recordings leave a base
/// farther off.
struct Unsuspicious {
  double power_percent = 1, degrees = 1.5;
  double chagas = std::numeric_limits<double>::infinity();  ///< 90 % quantile of what sets without an effect have, of ten or more
  bool holds(const Concealment& c) const;
};
/// By Marked::peers(), for one way to tune.
std::map<std::string, Unsuspicious> unsuspicious(const std::vector<Marked>& sets, Tuned tuned);

/// Which sets the practice would take for the base that it tuned in one way.
class Concealed {
 public:
  Concealed(const std::vector<Marked>& sets, Tuned tuned) : tuned_(tuned), limits_(unsuspicious(sets, tuned)) {}
  /// The long runs of a set; nullptr: nobody has looked, or they tell nothing.
  const Concealment* seen(const Marked& m) const;
  bool operator()(const Marked& m) const;
  /// "yes", "no", or "yes, without Eq. 4.3" where too few sets without an effect tell its limit.
  const char* word_for(const Marked& m) const;

 private:
  Tuned tuned_;
  std::map<std::string, Unsuspicious> limits_;
};

}  // namespace millscope::challenge
