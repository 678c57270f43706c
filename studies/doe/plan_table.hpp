// A plan as a table that is filled in and handed to `doe analyze`.
#pragma once

#include <string>

#include "studies/doe/doe.hpp"

namespace millscope::doe {

/// CSV: run, kind, and a column of natural values for each factor; comments above say what the plan can tell apart.
std::string plan_table(const Design& design);

/// "CFPP=0.2:0.4": the natural values at −1 and +1. Throws base::UserError.
Factor parse_factor(const std::string& text);

}  // namespace millscope::doe
