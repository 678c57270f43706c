// A private folder that vanishes with its test, and what a call refuses.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "kernel/config/error.hpp"

namespace host_test {

namespace fs = std::filesystem;

class Temporary {
 public:
  Temporary() {
    std::string name = (fs::temp_directory_path() / "millscope_host_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Temporary() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const fs::path& path() const { return path_; }
  std::string text() const { return path_.string(); }

 private:
  fs::path path_;
};

/// The message of the UserError that `call` throws; "" when it throws none.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const millscope::config::UserError& e) {
    return e.what();
  }
  return "";
}

/// A file that neither group nor others can write, in folders of the same kind.
inline fs::path place(const fs::path& source, const fs::path& target) {
  fs::create_directories(target.parent_path());
  fs::permissions(target.parent_path(), fs::perms::group_write | fs::perms::others_write, fs::perm_options::remove);
  fs::copy_file(source, target);
  fs::permissions(target, fs::perms::group_write | fs::perms::others_write, fs::perm_options::remove);
  return target;
}

}  // namespace host_test
