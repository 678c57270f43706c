#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "kernel/host/registry.hpp"
#include "temporary.hpp"
#include "tests/skip.hpp"

using namespace millscope;
using namespace millscope::host;
using namespace host_test;
using Catch::Matchers::Contains;

namespace {

const std::string kGood = std::string(BROKEN_PLUGINS) + "/GOOD.so";

std::string refusal_of(const std::string& directory) {
  return refusal([&] { Registry({{directory}, false, {}}); });
}

/// Sets an environment variable for the time of a test.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Environment() { ::unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

/// A good library in a directory of its own.
struct OnePlugin {
  Temporary folder;
  fs::path library = place(kGood, folder.path() / "plugins" / "libplugin.so");
  std::string directory = library.parent_path().string();
};

/// What `extra` lets `who` write is refused: the directory, the library, and the folder above unless it is sticky.
void check_refused(const OnePlugin& plugin, fs::perms extra, const std::string& who) {
  const auto& [folder, library, directory] = plugin;
  for (const std::string& path : {directory, library.string()}) {
    fs::permissions(path, extra, fs::perm_options::add);
    CHECK_THAT(refusal_of(directory), Contains("chmod go-w '" + path + "'") && Contains(who));
    fs::permissions(path, extra, fs::perm_options::remove);
  }
  fs::permissions(folder.path(), extra, fs::perm_options::add);
  CHECK_THAT(refusal_of(directory), Contains(who + " can write to '" + folder.text() + "' above it"));
  fs::permissions(folder.path(), fs::perms::sticky_bit, fs::perm_options::add);
  CHECK(refusal_of(directory).empty());
  fs::permissions(folder.path(), extra | fs::perms::sticky_bit, fs::perm_options::remove);
}

}  // namespace

TEST_CASE("a directory or library that others can write is refused with the remedy") {
  const OnePlugin plugin;
  REQUIRE(refusal_of(plugin.directory).empty());
  check_refused(plugin, fs::perms::others_write, "anyone");
}

TEST_CASE("so is one that a group or another user can write") {
  if (::geteuid() != 0) return testing::skip("only root can give files to a group of others and to another user");
  const OnePlugin plugin;
  const auto& [folder, library, directory] = plugin;
  // Root's own group has no other member: what it can write, root alone can write.
  fs::permissions(folder.path(), fs::perms::group_write, fs::perm_options::add);
  CHECK(refusal_of(directory).empty());
  fs::permissions(folder.path(), fs::perms::group_write, fs::perm_options::remove);
  constexpr gid_t kOthers = 1;
  for (const std::string& path : {folder.text(), directory, library.string()}) REQUIRE(::chown(path.c_str(), 0, kOthers) == 0);
  check_refused(plugin, fs::perms::group_write, "its group");
  constexpr uid_t kStranger = 12345;
  REQUIRE(::chown(folder.text().c_str(), kStranger, 0) == 0);
  CHECK_THAT(refusal_of(directory), Contains("'" + folder.text() + "' above it belongs to user id 12345"));
}

TEST_CASE("a link does not hide where a library lies") {
  const Temporary folder;
  const fs::path library = place(kGood, folder.path() / "open" / "libreal.so");
  fs::create_directory(folder.path() / "plugins");
  fs::permissions(folder.path() / "plugins", fs::perms::owner_all);
  fs::create_symlink(library, folder.path() / "plugins" / "libplugin.so");
  REQUIRE(refusal_of((folder.path() / "plugins").string()).empty());
  fs::permissions(library, fs::perms::others_write, fs::perm_options::add);
  CHECK_THAT(refusal_of((folder.path() / "plugins").string()), Contains("libreal.so"));
  fs::permissions(library, fs::perms::others_write, fs::perm_options::remove);
  fs::permissions(library.parent_path(), fs::perms::others_write, fs::perm_options::add);
  CHECK_THAT(refusal_of((folder.path() / "plugins").string()), Contains("anyone can write to '" + library.parent_path().string() + "'"));
}

TEST_CASE("a named directory must exist and hold a plugin") {
  const Temporary folder;
  CHECK_THAT(refusal_of((folder.path() / "missing").string()), Contains("does not exist") && Contains("--plugin-dir"));
  CHECK_THAT(refusal_of(folder.text()), Contains("holds no plugin library"));
  CHECK_THAT(refusal_of(""), Contains("does not exist"));
  CHECK_THAT(refusal_of(place(kGood, folder.path() / "libplugin.so").string()), Contains("no directory"));
}

TEST_CASE("the working directory is not searched unless it is named") {
  const Temporary folder;
  place(kGood, folder.path() / "libplugin.so");
  place(kGood, folder.path() / "lib" / "millscope" / "plugins" / "libother.so");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  std::size_t unnamed = 1, named = 0;
  try {
    unnamed = Registry({{}, false, {}}).loaded().size();
    named = Registry({{"."}, false, {}}).loaded().size();
    for (const std::string& directory : own_directories()) CHECK(directory.find(folder.text()) == std::string::npos);
  } catch (...) {
    fs::current_path(before);
    throw;
  }
  fs::current_path(before);
  CHECK(unnamed == 0);
  CHECK(named == 2);
}

TEST_CASE("the best build that the machine runs is taken, or the one asked for") {
  const Temporary folder;
  for (const char* level : {"v2", "v3", "v4"}) place(kGood, folder.path() / level / "libplugin.so");
  const auto taken = [&](std::optional<InstructionSet> asked) {
    return Registry({{folder.text()}, false, asked}).records().at(0).instruction_set;
  };
  CHECK(taken({}) == "x86-64-" + text(machine_instruction_set()));
  CHECK(taken(InstructionSet::v2) == "x86-64-v2");
  {
    const Environment forced("MILLSCOPE_INSTRUCTION_SET", "v2");
    CHECK(taken({}) == "x86-64-v2");
  }
  {
    const Environment forced("MILLSCOPE_INSTRUCTION_SET", "v7");
    CHECK_THAT(refusal([&] { taken({}); }), Contains("MILLSCOPE_INSTRUCTION_SET") && Contains("'v7'") && Contains("v2, v3, v4"));
  }
  CHECK(folders_for(InstructionSet::v3) == std::vector<std::string>{"v3", "v2", ""});
}

TEST_CASE("a library built only for better machines is refused") {
  const Temporary folder;
  place(kGood, folder.path() / "v3" / "libplugin.so");
  const std::string message = refusal([&] { Registry({{folder.text()}, false, InstructionSet::v2}); });
  CHECK_THAT(message, Contains("libplugin.so") && Contains("no build for x86-64-v2"));
}
