// Results as tables and as a summary, for people and spreadsheets.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/analysis/results.hpp"

namespace millscope::analysis {

/// Writes DIRECTORY/numbers.csv (all single numbers) and one table for each set of axes of an analyzer, ANALYZER.AXES.csv: a row for each
/// cell with the bounds of its axes, then value, _sem, _low and _high of each result. Returns the files. Throws base::UserError.
std::vector<std::filesystem::path> write_tables(const std::filesystem::path& directory, const ResultSet& results);

/// Provenance, notes and all single numbers with their uncertainty: results.json.
nlohmann::ordered_json summary_json(const ResultSet& results);

/// The first `most` single numbers of each analyzer as a page: value ± sem, interval, unit, what is doubtful. Those that are undefined are
/// counted.
std::string number_table(const ResultSet& results, std::size_t most);

/// "few blocks, correlated"; "" when nothing is doubtful.
std::string flag_text(std::uint8_t flags);

}  // namespace millscope::analysis
