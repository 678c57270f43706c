// From a table of runs in natural units to a plan: which columns are factors, their levels, what kind of plan it is.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/table.hpp"
#include "studies/doe/doe.hpp"

namespace millscope::doe {

struct Choice {
  std::vector<std::string> factors, responses;  ///< empty: told from the table
  std::vector<std::string> generators;          ///< what the runs are said to obey; checked
  std::string axial = "auto";                   ///< "auto", "as-written", "rotatable", or a number of steps
};

enum class PlanKind { two_level, central_composite, other };

struct RecognisedTable {
  Design design;
  PlanKind kind = PlanKind::other;
  std::string description;              ///< "two-level plan, 8 runs and 3 centre runs, resolution IV"
  std::vector<std::string> generators;  ///< that the runs obey, found from the runs: "CRPP*CFPP*CRPG*CFPG = +1"
  std::vector<std::string> labels;      ///< of the runs: the column "case", "run", …, or numbers from 1
  std::vector<std::string> responses;
  std::vector<Eigen::VectorXd> values;  ///< of each response
  std::vector<std::string> notes;       ///< columns left aside, axial distances that were rounded
};

/// Throws base::UserError with the file and, where one is to blame, the line.
RecognisedTable recognise(const base::Table& table, const Choice& choice);

}  // namespace millscope::doe
