// What a report is made of: a section for each folder that a command of millscope wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "kernel/host/registry.hpp"

namespace millscope::report {

struct SectionOptions {
  std::uint64_t movie_bytes = 0;  ///< of each movie, see movie_of
};

/// The sections of OUT (page/DATA.md): of the folder itself, else of the folders below it, at most three deep, in the order in which a
/// study goes: runs, analyses, comparisons, cross-checks, wear, simulations of studies, calibrations, validations, diagnoses, challenges.
/// The runs that a study made for itself (below `cache`) are told together. Throws base::UserError for a folder without any result, and for
/// a file that cannot be read.
std::vector<nlohmann::ordered_json> sections_of(const std::filesystem::path& out, const host::Registry& registry,
                                                const SectionOptions& options);

}  // namespace millscope::report
