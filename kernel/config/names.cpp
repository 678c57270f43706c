// The normal spelling of pairs.
#include "kernel/base/text.hpp"
#include "kernel/config/document.hpp"

namespace millscope::config {

std::string normal_pair(std::string_view key) {
  const std::size_t tilde = key.find('~');
  if (tilde == std::string_view::npos || key.find('~', tilde + 1) != std::string_view::npos) return std::string(key);
  std::string first = base::trimmed(key.substr(0, tilde), " "), second = base::trimmed(key.substr(tilde + 1), " ");
  if (second < first) std::swap(first, second);
  return first + "~" + second;
}

}  // namespace millscope::config
