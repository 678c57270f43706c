// A private folder that vanishes with its test, and what a call refuses.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/scratch.hpp"

namespace host_test {

namespace fs = std::filesystem;

using testing::refusal;

class Temporary {
 public:
  const fs::path& path() const { return scratch_.path; }
  std::string text() const { return scratch_.path.string(); }

 private:
  testing::Scratch scratch_;
};

/// A file that neither group nor others can write, in folders of the same kind.
inline fs::path place(const fs::path& source, const fs::path& target) {
  fs::create_directories(target.parent_path());
  fs::permissions(target.parent_path(), fs::perms::group_write | fs::perms::others_write, fs::perm_options::remove);
  fs::copy_file(source, target);
  fs::permissions(target, fs::perms::group_write | fs::perms::others_write, fs::perm_options::remove);
  return target;
}

}  // namespace host_test
