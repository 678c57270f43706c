// What a set hides, sealed: SETS/answers/set_001.json with a salt, and its hash in SETS/manifest.json.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/challenge/plan.hpp"

namespace millscope::challenge {

/// A hypothesis that is true, in the numbers of the study.
struct TrueEffect {
  std::string hypothesis;
  double strength = 0;
  std::string parameter;            ///< as diagnosis.json calls it
  double value = 0;                 ///< of the parameter
  double vanishes_at = 0, far = 1;  ///< strength 0 and 1
};

struct Answer {
  std::string set;  ///< "set_001"
  Kind kind = Kind::none;
  std::string name;  ///< of what lies outside
  std::vector<TrueEffect> effects;
  std::vector<std::pair<std::string, double>> theta;  ///< parameters and nuisances by the study's names
  nlohmann::ordered_json made;                        ///< how: settings, seeds, powers; not scored
};

nlohmann::ordered_json to_json(const Answer& answer, const std::string& salt);
Answer answer_from(const nlohmann::ordered_json& json);

/// 32 hexadecimal digits that nobody can guess.
std::string fresh_salt();

/// Writes the answers with fresh salts, then the manifest with their hashes. `study`: the file that all sets include.
void seal(const std::filesystem::path& sets, const std::vector<Answer>& answers, const std::filesystem::path& study);

/// The names in the manifest. Throws base::UserError when there is none.
std::vector<std::string> set_names(const std::filesystem::path& sets);
/// Answers as sealed. Throws base::UserError when one is missing or is not what the manifest has the hash of.
std::vector<Answer> open_answers(const std::filesystem::path& sets);
/// Of the study that the sets were made for.
std::string study_hash(const std::filesystem::path& sets);
/// Of the manifest's bytes: published beforehand, it binds whoever made the sets.
std::string manifest_hash(const std::filesystem::path& sets);

}  // namespace millscope::challenge
