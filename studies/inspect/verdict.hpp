// What a recording is good for, with the figures that say so.
#pragma once

#include <vector>

#include "studies/inspect/inspect.hpp"

namespace millscope::inspect {

std::vector<Verdict> judge(const recording::Recording& recording, const Inspection& inspection);

}  // namespace millscope::inspect
