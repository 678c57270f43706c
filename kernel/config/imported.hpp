// A case whose beads another program moved: `run: {engine: imported}`. `millscope import` writes such cases. They say the mill and its
// charge; of physics they have densities and gravity alone, so that nothing is invented that nobody stated.
#pragma once

#include "kernel/config/case.hpp"

namespace millscope::config {

inline constexpr const char* kImported = "imported";

inline bool is_imported(const Case& c) { return c.run.engine == kImported; }

/// Throws UserError, at its line, for a case that holds no physics to run with.
inline void refuse_imported(const Case& c) {
  if (!is_imported(c)) return;
  c.root.at("run").at("engine").fail(
      "is 'imported': another program moved these beads, and its physics is not here; let that program run it, or write a case of its own "
      "('millscope new')");
}

}  // namespace millscope::config
