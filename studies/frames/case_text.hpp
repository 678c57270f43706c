// The case that an imported run leaves: its mill and its charge.
#pragma once

#include <string>

#include "studies/frames/gather.hpp"
#include "studies/frames/turning.hpp"

namespace millscope::frames {

/// `count`: beads that are there on average.
struct CaseOfImport {
  const MillFile& mill;
  const Census& census;
  Turning turning;
  double count = 0;
  double end = 0, analyze_from = 0;  ///< s
};

std::string case_text(const CaseOfImport& c);

}  // namespace millscope::frames
