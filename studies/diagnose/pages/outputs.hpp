// What `diagnose` leaves: diagnosis.json, diagnosis.md with pictures, corrected/ with a runnable study.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/diagnose/verdict/diagnosis.hpp"

namespace millscope::diagnose {

/// A diagnosis with what it was made from.
struct Told {
  const Question& question;
  const Diagnosis& diagnosis;
};

nlohmann::ordered_json diagnosis_json(const Told& told);
/// Markdown that names the pictures in `pictures`.
std::string diagnosis_text(const Told& told, const std::vector<std::filesystem::path>& pictures);
/// Candidates, mismatch before and after, power and friction over the conditions. SVG and PNG below `folder`; returns the SVG files.
std::vector<std::filesystem::path> draw(const Told& told, const std::filesystem::path& folder);
/// corrected/case.yaml and corrected/study.yaml: the base with the best candidate's physics and parameters; nothing where none was found.
void write_corrected(const Told& told, const std::filesystem::path& folder);

/// The candidate's own parameter over the interval of its strength, low end first.
base::Interval90 parameter_at(const Candidate& candidate, const base::Interval90& strength);
/// An observable's name with its condition: "speed75: speed in region 3 (m/s)".
std::string observable_name(const Told& told, Index observable);
/// "recording 0.30, retuned base 0.27 (z = 3.1 …)" of one row of the mismatch.
std::string mismatch_sentence(const Told& told, const naming::Mismatch& m);

/// Every number of a held-out condition less what a model says there, over its standard deviation; NaN where the model leaves it undefined.
VectorXd deviations(const Told& told, const HeldOut& held, const Score& score);
/// A sentence for each contact parameter that the practice moves out of the interval that the recordings as a whole give it.
std::vector<std::string> moved_by_practice(const Told& told);

/// All of the above into `folder`.
void write_outputs(const Told& told, const std::filesystem::path& folder);

}  // namespace millscope::diagnose
