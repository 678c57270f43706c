// One page of everything that was found, to be mailed and opened without a network.
//
//   write_page("report.html", document_of("Mill 3", sections_of("OUT", registry, {kMovieBytes})));
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace millscope::report {

/// The document that page/DATA.md describes. With a diagnosis among the sections they stand in the order of its answer: diagnosis,
/// calibration, validation, comparison, …, runs; else as given. `live`: served by `watch`, so that the page asks for it again and again.
nlohmann::ordered_json document_of(const std::string& title, std::vector<nlohmann::ordered_json> sections, bool live = false);

/// The page with the document in it.
std::string page_of(const nlohmann::ordered_json& document);

/// Writes it aside and renames it. Throws base::UserError.
void write_page(const std::filesystem::path& file, const nlohmann::ordered_json& document);

}  // namespace millscope::report
