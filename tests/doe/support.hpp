// What the tests of plans share: the published tables, files made up here, factors without meaning.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "kernel/base/error.hpp"
#include "studies/doe/analysis.hpp"

namespace doe_test {

using namespace millscope;
using namespace millscope::doe;

inline TableAnalysis published(const std::string& name, ModelChoice model = ModelChoice::automatic, const Choice& choice = {}) {
  return analyze_table(base::Table::read(std::string(MILLSCOPE_SOURCE_DIR) + "/tests/doe/data/" + name), choice, model, kConfidence, {});
}

inline std::vector<Factor> factors(int count) {
  std::vector<Factor> list;
  for (int i = 0; i < count; ++i) list.push_back({std::string(1, static_cast<char>('A' + i)), 10.0 * i, 2.0, ""});
  return list;
}

/// A file of its own that goes when the test does.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("millscope-doe-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".csv")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The message of the UserError that `call` throws, "" when it throws none.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const millscope::base::UserError& e) {
    return e.what();
  }
  return "";
}

}  // namespace doe_test
