// How the suites are tested: plugins that are wrong in one thing each, and the check that must say so.
#pragma once

#include <catch2/catch.hpp>

#include "millscope/conformance/values.hpp"

namespace sdk_test {

using namespace millscope;
using namespace millscope::conformance;

/// Whether one of the violations is of this check; all are shown when the test fails.
inline bool names(const Violations& violations, const char* check) {
  bool found = false;
  for (const Violation& v : violations) {
    UNSCOPED_INFO(v.check << ": " << v.message);
    found = found || v.check == check;
  }
  return found;
}

inline constexpr Values kNoValues{nullptr, 0};

}  // namespace sdk_test
