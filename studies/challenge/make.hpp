// Sets of recordings whose physics is drawn and hidden.
//
// SETS/set_001/study.yaml, r_NAME.yaml, r_NAME_1.a, …   what one who diagnoses gets
// SETS/manifest.json                                    hashes of the answers
// SETS/answers/set_001.json                             the answers, each with a salt
// SETS/answers/cache                                    the truths' simulations
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "studies/campaign/campaign.hpp"
#include "studies/challenge/plan.hpp"

namespace millscope::challenge {

struct MakeOptions {
  std::filesystem::path output;
  campaign::Options campaign;  ///< its cache empty: OUTPUT/answers/cache
  std::function<void(const std::string&)> say;
};

/// Simulates, records and seals. Stopped, it goes on from its cache. Throws base::UserError: a truth that cannot be simulated, a folder
/// that holds sealed sets already.
void make(const Challenge& challenge, const diagnose::Question& question, const host::Registry& registry, MakeOptions options);

}  // namespace millscope::challenge
