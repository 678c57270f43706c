// What a case will cost, before it is run.
#pragma once

#include <cstdint>

#include "kernel/run/assembly.hpp"

namespace millscope::run {

/// Bytes that a run will write, about.
std::uint64_t disk_estimate(const Assembly& a);

}  // namespace millscope::run
