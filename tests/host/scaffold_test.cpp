#include "kernel/host/scaffold.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

#include "kernel/host/registry.hpp"
#include "temporary.hpp"

using namespace millscope;
using namespace millscope::host;
using namespace host_test;
using Catch::Matchers::Contains;

namespace {

std::string quoted(const std::string& word) { return "'" + word + "'"; }

/// Runs a shell command with its output in a log; the log is shown when it fails.
void run(const std::string& command, const fs::path& log) {
  const int status = std::system((command + " >" + quoted(log.string()) + " 2>&1").c_str());
  std::ifstream in(log);
  INFO(command << "\n" << std::string(std::istreambuf_iterator<char>(in), {}));
  REQUIRE(status == 0);
}

/// The installed SDK, once for all tests of this program.
const fs::path& installed_sdk() {
  static const Temporary prefix;
  static bool done = false;
  if (!done) {
    run(quoted(MILLSCOPE_CMAKE) + " --install " + quoted(MILLSCOPE_BINARY_DIR) + " --component sdk --prefix " + quoted(prefix.text()),
        prefix.path() / "install.log");
    done = true;
  }
  return prefix.path();
}

/// Scaffolds, configures against the installed SDK, builds, tests, and loads the result.
void build_and_load(Kind kind) {
  const Temporary folder;
  const std::string project = scaffold(kind, "my_plugin", folder.text());
  const std::string build = project + "/build", log = project + "/log";
  run(quoted(MILLSCOPE_CMAKE) + " -S " + quoted(project) + " -B " + quoted(build) + " -DCMAKE_CXX_COMPILER=" + quoted(MILLSCOPE_CXX) +
          " -DCMAKE_CXX_FLAGS='-Wall -Wextra -Wpedantic -Wconversion -Werror' -DCMAKE_PREFIX_PATH=" + quoted(installed_sdk().string()),
      log);
  run(quoted(MILLSCOPE_CMAKE) + " --build " + quoted(build), log);
  run(quoted(MILLSCOPE_CTEST) + " --test-dir " + quoted(build) + " --output-on-failure --no-tests=error", log);
  const Registry registry({{build + "/lib/millscope/plugins"}, false, {}});
  CHECK(registry.find(kind, "my_plugin").name() == "my_plugin");
}

}  // namespace

TEST_CASE("a scaffolded contact law builds, passes its test and loads") { build_and_load(Kind::contact_law); }
TEST_CASE("a scaffolded interaction builds, passes its test and loads") { build_and_load(Kind::interaction); }
TEST_CASE("a scaffolded wear law builds, passes its test and loads") { build_and_load(Kind::wear_law); }
TEST_CASE("a scaffolded pair parameter builds, passes its test and loads") { build_and_load(Kind::pair_parameter); }
TEST_CASE("a scaffolded geometry builds, passes its test and loads") { build_and_load(Kind::geometry); }
TEST_CASE("a scaffolded body force builds, passes its test and loads") { build_and_load(Kind::body_force); }
TEST_CASE("a scaffolded observation builds, passes its test and loads") { build_and_load(Kind::observation); }
TEST_CASE("a scaffolded analyzer builds, passes its test and loads") { build_and_load(Kind::analyzer); }

TEST_CASE("scaffold refuses bad names and existing targets, and writes nothing") {
  const Temporary folder;
  for (const char* name : {"", "My", "1st", "a-b", "../up", "a b", "/abs"}) {
    CHECK_THAT(refusal([&] { scaffold(Kind::contact_law, name, folder.text()); }), Contains("plugin name"));
  }
  CHECK(fs::is_empty(folder.path()));
  scaffold(Kind::analyzer, "mine", folder.text());
  CHECK_THAT(refusal([&] { scaffold(Kind::analyzer, "mine", folder.text()); }), Contains("exists already"));
}
