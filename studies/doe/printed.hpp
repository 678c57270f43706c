// Holds printed figures against what the table gives: does a publication follow from its data?
#pragma once

#include <string>
#include <vector>

#include "studies/doe/analysis.hpp"

namespace millscope::doe {

/// A printed figure beside the same one worked again.
struct PrintedFigure {
  std::string response, term, figure, printed;
  double worked_again = kUndefined;
  bool differs = false;              ///< by more than the last printed digit
  double p_of_printed = kUndefined;  ///< of a printed p: what follows from the printed F and the degrees of freedom
  bool contradicts = false;          ///< the printed p does not follow from the printed F
};

/// `printed`: a table with the columns response, term, figure, printed. Figures: SS, F, p, effect, coefficient, stationary (term: a
/// factor). Terms: names of effects and coefficients, curvature, residual, total, lack of fit, pure error. Throws base::UserError with
/// the line.
std::vector<PrintedFigure> compare_printed(const TableAnalysis& analysis, const base::Table& printed);

nlohmann::ordered_json printed_json(const std::vector<PrintedFigure>& figures);
std::string printed_text(const std::vector<PrintedFigure>& figures);

}  // namespace millscope::doe
