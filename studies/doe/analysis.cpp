#include "studies/doe/analysis.hpp"

#include <fmt/format.h>

#include "kernel/base/error.hpp"

namespace millscope::doe {
namespace {

Result analyze_response(const TableAnalysis& analysis, const Eigen::VectorXd& values, ModelChoice model) {
  const bool two_level = analysis.table.kind == PlanKind::two_level;
  if (model == ModelChoice::quadratic || (model == ModelChoice::automatic && !two_level)) {
    return fit_surface(analysis.table.design, values, analysis.confidence);
  }
  return analyze_two_level(analysis.table.design, values,
                           model == ModelChoice::interactions ? TwoLevelModel::interactions : TwoLevelModel::main_effects);
}

}  // namespace

TableAnalysis analyze_table(const base::Table& table, const Choice& choice, ModelChoice model, double confidence, const Descent& descent) {
  TableAnalysis analysis{table.file(), recognise(table, choice), confidence, descent, {}};
  for (std::size_t r = 0; r < analysis.table.responses.size(); ++r) {
    try {
      analysis.results.push_back(analyze_response(analysis, analysis.table.values[r], model));
    } catch (const base::UserError& e) {
      throw base::UserError(fmt::format("{}: {}: {}", table.file(), analysis.table.responses[r], e.what()));
    }
  }
  return analysis;
}

}  // namespace millscope::doe
