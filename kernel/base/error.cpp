#include "kernel/base/error.hpp"

#include <fmt/format.h>

namespace millscope::base {

std::string Location::text() const { return line > 0 ? fmt::format("{}:{}", file, line) : file; }

UserError::UserError(const std::string& message, int exit_code) : std::runtime_error(message), exit_code_(exit_code) {}

UserError::UserError(const Location& where, const std::string& message, int exit_code)
    : UserError(where.text() + ": " + message, exit_code) {}

}  // namespace millscope::base
