#include "kernel/config/existing_file.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
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
  std::string file = resolve_file(node);
  const std::string wrong = wrong_with(file);
  if (!wrong.empty()) node.fail(fmt::format("is '{}': {}; {}", node.text(), wrong, remedy));
  return file;
}

std::vector<std::string> matching_files(const Node& node) {
  const fs::path path = resolve_file(node);
  const std::string pattern = path.filename().string();
  if (pattern.find_first_of("*?") == std::string::npos) return {path.string()};
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.parent_path(), error)) {
    if (::fnmatch(pattern.c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0) found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  if (found.empty()) node.fail(fmt::format("is '{}', and no file has such a name; correct it", node.text()));
  return found;
}

}  // namespace millscope::config
