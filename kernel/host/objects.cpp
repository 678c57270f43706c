#include "kernel/host/objects.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace millscope::host::detail {

void refuse(const Loaded& plugin, const Location& where, const Failure& failure) {
  std::string message(failure.message, std::find(std::begin(failure.message), std::end(failure.message), '\0'));
  std::replace(message.begin(), message.end(), '\n', ' ');
  if (message.empty()) message = "the plugin failed without saying why";
  const std::string line = fmt::format("{} '{}': {}", text(plugin.kind()), plugin.name(), message);
  if (where.file.empty()) throw UserError(line);
  throw UserError(where, line);
}

}  // namespace millscope::host::detail
