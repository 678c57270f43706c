// A comparison as table, files and pictures.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "studies/compare/compare.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::compare {

/// The ranked table as text, at most `rows` observables: where, A, B, B − A with interval, adjusted p.
std::string comparison_table(const Comparison& comparison, std::size_t rows);

/// Verdict, conditions, notes and every observable with its strongest element.
nlohmann::ordered_json comparison_json(const Comparison& comparison);

/// OUT/comparison.json, observables.csv (ranked), elements.csv (every number, bin, cell and region that was judged); each whole or not at
/// all. The directory is made. Throws base::UserError.
void write_comparison(const Comparison& comparison, const std::filesystem::path& directory);

/// A difference map with the differing cells framed for every map, both curves for every curve. Returns what was written, without ending.
std::vector<std::filesystem::path> draw_comparison(const Comparison& comparison, const std::filesystem::path& directory,
                                                   const picture::MillOutline& mill);

}  // namespace millscope::compare
