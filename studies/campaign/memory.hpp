// How much this machine lets simulations use.
#pragma once

#include <cstdint>

namespace millscope::campaign {

/// Bytes that can be had now without swapping, within the control group's limit.
std::uint64_t available_memory();

/// Cores that this process may use.
int available_cores();

}  // namespace millscope::campaign
