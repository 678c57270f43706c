#include "kernel/config/existing_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace millscope::config {
namespace {

namespace fs = std::filesystem;

/// "" of a file that can be read.
std::string wrong_with(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return "no such file";
  if (fs::is_directory(file, ignored)) return "it is a folder";
  return std::ifstream(file).is_open() ? "" : "it cannot be opened";
}

}  // namespace

std::string existing_file(const Node& node, const std::string& remedy) {
  const std::string file = resolve_file(node), wrong = wrong_with(file);
  if (!wrong.empty()) node.fail(fmt::format("is '{}': {}; {}", node.text(), wrong, remedy));
  return file;
}

}  // namespace millscope::config
