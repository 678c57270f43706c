#include "kernel/base/hash.hpp"

#include <fmt/format.h>

namespace millscope::base {

std::string Hash::text() const { return fmt::format("{:016x}", value_); }

}  // namespace millscope::base
