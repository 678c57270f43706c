// Diagnoses of all sets, from one bank.
#pragma once

#include <filesystem>

#include "studies/calibrate/session.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::challenge {

struct RunCount {
  int done = 0, known = 0, failed = 0;
};

/// Diagnoses every set that has no diagnosis yet into SETS/set_001/diagnosis. `session`: its output is chosen here; its cache empty:
/// SETS/cache. A set whose diagnosis throws is noted in its diagnosis/failed.txt and tried again in the next call; the rest goes on. Throws
/// what stops everything: an interruption, a full disk.
RunCount run(const std::filesystem::path& sets, const host::Registry& registry, calibrate::SessionOptions session,
             const naming::Options& naming);

}  // namespace millscope::challenge
