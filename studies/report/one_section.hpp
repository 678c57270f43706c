// The makers of sections, one for each kind. Each throws base::UserError for a file that cannot be read.
#pragma once

#include <filesystem>

#include "studies/report/sections.hpp"

namespace millscope::report {

using Json = nlohmann::ordered_json;

/// kind, title, source and an empty list of notes: what each section begins with.
Json begun(const char* kind, const std::string& title, const std::filesystem::path& folder);

/// Throws base::UserError with the file's name when it cannot be read or is no JSON object.
Json json_object_of(const std::filesystem::path& file);

Json run_section(const std::filesystem::path& folder, const host::Registry& registry, const SectionOptions& options);
Json analysis_section(const std::filesystem::path& folder, const host::Registry& registry);
Json comparison_section(const std::filesystem::path& folder);
Json crosscheck_section(const std::filesystem::path& folder);
Json wear_section(const std::filesystem::path& folder);
/// Of a folder with the cache of a study or a campaign.
Json campaign_section(const std::filesystem::path& folder);
Json calibration_section(const std::filesystem::path& folder);
Json validation_section(const std::filesystem::path& folder);
Json diagnosis_section(const std::filesystem::path& folder);
Json challenge_section(const std::filesystem::path& folder);

/// What a run or a study in this folder is at.
enum class State { running, done, stopped };
/// `done`: the result file that is written at the end. A folder that nobody holds and that lacks it was stopped.
State state_of(const std::filesystem::path& folder, const char* done);
const char* text(State state);

}  // namespace millscope::report
