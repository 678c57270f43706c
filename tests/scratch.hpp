// A folder that vanishes with its test, and what a call refuses.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "kernel/base/error.hpp"

namespace testing {

/// A folder of its own, gone afterwards.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "millscope_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
    path = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path / name; }
  std::filesystem::path path;
};

/// The message of the UserError that `body` throws; "" when it throws none.
inline std::string refusal(const std::function<void()>& body) {
  try {
    body();
  } catch (const millscope::base::UserError& e) {
    return e.what();
  }
  return "";
}

}  // namespace testing
