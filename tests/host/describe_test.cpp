#include "kernel/host/describe.hpp"

#include <catch2/catch.hpp>

#include "temporary.hpp"

using namespace millscope;
using namespace millscope::host;
using namespace host_test;
using Catch::Matchers::Contains;

TEST_CASE("describe says everything that a plugin says of itself") {
  const Temporary folder;
  place(std::string(BROKEN_PLUGINS) + "/GOOD.so", folder.path() / "libplugin.so");
  const Registry registry({{folder.text()}, false, {}});
  const Descriptor& push = *registry.find(Kind::body_force, "push").descriptor;
  const std::string page = describe(push);
  CHECK_THAT(page, Contains("push  (body_force, version 1.2.3)") && Contains("Pushes along x.") && Contains("F = strength"));
  CHECK_THAT(page, Contains("strength [N]  number, default 1, 0 to 10") && Contains("Size of the force. (A. Author 2000)"));
  CHECK_THAT(page, Contains("other  number, default required, any") && Contains("mode  choice, default pull, push|pull"));
  CHECK_THAT(page, Contains("Hypothesis push") && Contains("vanishes at 0, prior 0 to 5"));

  const nlohmann::json j = describe_json(push);
  CHECK(j["kind"] == "body_force");
  CHECK(j["parameters"].size() == 3);
  CHECK(j["parameters"][0]["maximum"] == 10.0);
  CHECK(j["parameters"][1]["required"] == true);
  CHECK(j["parameters"][1]["maximum"].is_null());
  CHECK(j["parameters"][2]["default"] == "pull");
  CHECK(j["hypotheses"][0]["parameter"] == "strength");

  CHECK_THAT(list_plugins(registry), Contains("push") && Contains("body_force") && Contains("searched: " + folder.text()));
  CHECK(provenance_json(registry)[0]["file_hash"].get<std::string>().size() == 16);
}

TEST_CASE("kinds have one word each") {
  for (const Kind kind : all_kinds()) CHECK(parse_kind(text(kind)) == kind);
  CHECK(all_kinds().size() == 8);
  CHECK_FALSE(parse_kind("contact law"));
}
