#include <catch2/catch.hpp>

#include "kernel/host/objects.hpp"
#include "kernel/host/registry.hpp"
#include "millscope/conformance/values.hpp"
#include "temporary.hpp"

using namespace millscope;
using namespace millscope::host;
using namespace host_test;
using Catch::Matchers::Contains;

namespace {

std::string broken(const std::string& variant) { return std::string(BROKEN_PLUGINS) + "/" + variant + ".so"; }

Registry load(const std::vector<std::string>& directories) { return Registry({directories, false, {}}); }

/// What the registry says to a directory with this one library.
std::string refusal_of(const std::string& variant) {
  const Temporary folder;
  place(broken(variant), folder.path() / "libplugin.so");
  const std::string message = refusal([&] { load({folder.text()}); });
  if (!message.empty()) {
    CHECK_THAT(message, Contains(folder.text() + "/libplugin.so"));
    CHECK(message.find('\n') == std::string::npos);
  }
  return message;
}

}  // namespace

TEST_CASE("a good library is loaded and its plugins are found") {
  const Temporary folder;
  place(broken("GOOD"), folder.path() / "libplugin.so");
  const Registry registry = load({folder.text()});
  REQUIRE(registry.loaded().size() == 2);
  CHECK(registry.find(Kind::body_force, "push").name() == "push");
  CHECK(registry.try_find(Kind::contact_law, "push") == nullptr);
  CHECK(registry.find_any("second").size() == 1);
  const std::vector<PluginRecord> records = registry.records();
  CHECK(records[0].version == "1.2.3");
  CHECK(records[0].path == folder.text() + "/libplugin.so");
  CHECK(records[0].instruction_set == "any");
  CHECK(records[0].file_hash.size() == 16);
  CHECK(records[0].compiler == std::string(kCompiler));
}

TEST_CASE("an unknown plugin names the nearest and where was searched") {
  const Temporary folder;
  place(broken("GOOD"), folder.path() / "libplugin.so");
  const Registry registry = load({folder.text()});
  const Location where{"case.yaml", 12};
  const std::string message = refusal([&] { registry.find(Kind::body_force, "pusch", where); });
  CHECK_THAT(message, Contains("case.yaml:12"));
  CHECK_THAT(message, Contains("pusch") && Contains("'push'") && Contains(folder.text()) && Contains("--plugin-dir"));
  CHECK_THAT(refusal([&] { registry.find(Kind::contact_law, "push"); }), Contains("'push' is of kind body_force"));
  CHECK_THAT(refusal([&] { registry.find_any("pus"); }), Contains("push"));
}

TEST_CASE("broken libraries are refused with what differs and what to do") {
  CHECK_THAT(refusal_of("WRONG_MAGIC"), Contains("wrong magic number"));
  CHECK_THAT(refusal_of("WRONG_LIST_MAGIC"), Contains("no plugin list"));
  CHECK_THAT(refusal_of("WRONG_SIZE"), Contains("bytes") && Contains("rebuild"));
  CHECK_THAT(refusal_of("OLDER_ABI"), Contains("built against SDK ABI 2, this millscope has 3: rebuild"));
  CHECK_THAT(refusal_of("OLDER_LIST"), Contains("built against SDK ABI 2, this millscope has 3: rebuild"));
  CHECK_THAT(refusal_of("NEWER_ABI"), Contains("built against SDK ABI 4, this millscope has 3: update"));
  CHECK_THAT(refusal_of("WRONG_LAYOUT"), Contains("layout of its body_force structs") && Contains("rebuild"));
  CHECK_THAT(refusal_of("OTHER_HYPOTHESIS"), Contains("layout of its body_force structs") && Contains("rebuild"));
  CHECK_THAT(refusal_of("WRONG_TABLE_SIZE"), Contains("table has") && Contains("rebuild"));
  CHECK_THAT(refusal_of("UNKNOWN_KIND"), Contains("kind 99"));
  CHECK_THAT(refusal_of("NO_SYMBOL"), Contains("no symbol millscope_plugins"));
  CHECK_THAT(refusal_of("FUNCTION_SYMBOL"), Contains("is no plugin list"));
  CHECK_THAT(refusal_of("EMPTY_LIST"), Contains("empty"));
  CHECK_THAT(refusal_of("UNDEFINED_SYMBOL"), Contains("function_that_exists_nowhere"));
}

TEST_CASE("bad descriptions of plugins are refused") {
  CHECK_THAT(refusal_of("NULL_NAME"), Contains("null text"));
  CHECK_THAT(refusal_of("BAD_NAME"), Contains("Push Me"));
  CHECK_THAT(refusal_of("NULL_FUNCTION"), Contains("'push'") && Contains("function"));
  CHECK_THAT(refusal_of("DEFAULT_OUTSIDE"), Contains("'strength'") && Contains("20") && Contains("0 to 10"));
  CHECK_THAT(refusal_of("PARAMETER_TWICE"), Contains("'strength' is listed twice"));
  CHECK_THAT(refusal_of("WRONG_CHOICE"), Contains("'turn'") && Contains("push|pull"));
  CHECK_THAT(refusal_of("LISTED_TWICE"), Contains("'push' twice"));
  CHECK_THAT(refusal_of("HALF_GOOD"), Contains("'second'"));  // all or nothing
}

TEST_CASE("files that are no libraries are refused") {
  const Temporary folder;
  fs::permissions(folder.path(), fs::perms::owner_all);
  for (const std::string& body : {std::string("not a library\n"), std::string("\177ELF") + std::string(200, 'x'), std::string()}) {
    std::ofstream(folder.path() / "libplugin.so", std::ios::binary) << body;
    fs::permissions(folder.path() / "libplugin.so", fs::perms::owner_read | fs::perms::owner_write);
    CHECK_THAT(refusal([&] { load({folder.text()}); }), Contains("libplugin.so") && Contains("not loaded"));
  }
}

TEST_CASE("a failing constructor becomes an error at the user's place") {
  for (const auto& [variant, expected] : {std::pair{"THROWS", "give 2 N"}, std::pair{"THROWS_INT", "not a std::exception"}}) {
    const Temporary folder;
    place(broken(variant), folder.path() / "libplugin.so");
    const Registry registry = load({folder.text()});
    const Loaded& plugin = registry.find(Kind::body_force, "push");
    const conformance::ValueSet values(*plugin.descriptor);
    const std::string message = refusal([&] { BodyForceObject::create(plugin, values.view(), {"case.yaml", 3}); });
    CHECK_THAT(message, Contains("case.yaml:3") && Contains("body_force 'push'") && Contains(expected));
  }
}

TEST_CASE("objects keep their library loaded after the registry is gone") {
  const Temporary folder;
  place(broken("GOOD"), folder.path() / "libplugin.so");
  BodyForceObject kept;
  {
    const Registry registry = load({folder.text()});
    const Loaded& plugin = registry.find(Kind::body_force, "push");
    conformance::ValueSet values(*plugin.descriptor);
    values.set("strength", 4.0);
    kept = BodyForceObject::create(plugin, values.view(), {});
  }
  double zero = 0, one = 1, force = 0, rest[5] = {};
  BodyForceBatch b{1,
                   0,
                   1,
                   {&zero, &zero, &zero},
                   {&zero, &zero, &zero},
                   {&zero, &zero, &zero},
                   &one,
                   &one,
                   {&force, rest, rest + 1},
                   {rest + 2, rest + 3, rest + 4},
                   &zero,
                   0};
  kept.table().evaluate(kept.self(), &b);
  CHECK(force == 4.0);
  CHECK(kept.name() == "push");
}

TEST_CASE("two libraries with the same plugin clash") {
  const Temporary first, second;
  place(broken("GOOD"), first.path() / "liba.so");
  place(broken("THROWS"), second.path() / "libb.so");
  CHECK_THAT(refusal([&] { load({first.text(), second.text()}); }), Contains("liba.so") && Contains("libb.so") && Contains("'push'"));
  CHECK(load({first.text(), first.text() + "/."}).loaded().size() == 2);
}
