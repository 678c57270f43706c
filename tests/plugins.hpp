// The plugins of this build, for tests.
#pragma once

#include "kernel/host/registry.hpp"

namespace testing {

inline const millscope::host::Registry& registry() {
  static const millscope::host::Registry all({{MILLSCOPE_BINARY_DIR "/lib/millscope/plugins"}, false, {}});
  return all;
}

}  // namespace testing
