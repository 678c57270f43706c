// A table of runs analysed: every response, as text, as JSON and as pictures.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "studies/doe/recognise.hpp"

namespace millscope::doe {

enum class ModelChoice { automatic, main_effects, interactions, quadratic };

/// One response's analysis.
using Result = std::variant<Anova, Surface>;

/// Where steepest descent goes: `steps` steps in which the strongest factor moves by `step` (coded); factors with p above `largest_p` stay.
struct Descent {
  double step = 0.5;
  int steps = 4;
  double largest_p = 0.1;
};

struct TableAnalysis {
  std::string file;
  RecognisedTable table;
  double confidence = kConfidence;
  Descent descent;
  std::vector<Result> results;  ///< one a response
};

/// Automatic: main effects for a two-level plan, else the full quadratic. Throws base::UserError that names the file and the response.
TableAnalysis analyze_table(const base::Table& table, const Choice& choice, ModelChoice model, double confidence, const Descent& descent);

std::string analysis_text(const TableAnalysis& analysis);
nlohmann::ordered_json analysis_json(const TableAnalysis& analysis);

/// A map of the fitted surface over the two factors that matter most, or effects with their intervals; STEM-RESPONSE.svg and .png in
/// `directory`. Returns the paths without ending.
std::vector<std::filesystem::path> draw_analysis(const TableAnalysis& analysis, const std::filesystem::path& directory);

}  // namespace millscope::doe
