// What a recording is good for, with the figures that say so.
#pragma once

#include <vector>

#include "studies/inspect/inspect.hpp"

namespace millscope::studies {

std::vector<Verdict> judge(const Recording& recording, const Inspection& inspection);

}  // namespace millscope::studies
