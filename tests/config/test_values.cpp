#include "kernel/config/values.hpp"

#include <filesystem>

#include "tests/config/helpers.hpp"

using namespace millscope;
using namespace millscope::config;
using testing::message_of;

namespace {

Node section(const std::string& text) { return parse_document("p: " + text + "\n", "dir/a.yaml").at("p"); }
std::string refusal_of(const Descriptor& d, const std::string& text, Scope scope = Scope::instance) {
  return message_of([&] { resolve(d, section(text), scope); });
}

}  // namespace

TEST_CASE("values of every type with defaults") {
  const ResolvedValues resolved = resolve(testing::kTubePlugin, section("{file: a.stl, shift: [0, 1 mm, 0], repeat: 20}"), Scope::instance);
  const ResolvedValues copy = resolved;
  const Parameters p(copy.view());
  CHECK(p.text("file") == std::filesystem::absolute("dir/a.stl").string());
  CHECK(p.integer("repeat") == 20);
  CHECK(p.vector("shift")[1] == 0.001);
  CHECK_FALSE(p.given("turn"));
  CHECK(p.text("title") == "tube");
  CHECK(resolved.where("repeat").text() == "dir/a.yaml:1");

  const ResolvedValues law = resolve_for_pair(testing::kSpringsPlugin, section("{stiffness: 1 kN/m, allow_tension: true}"),
                                              section("{restitution: 50 %, of_another_plugin: 1}"));
  const Parameters l(law.view());
  CHECK(l.number("stiffness") == 1000);
  CHECK(l.text("cap") == "spring");
  CHECK(l.flag("allow_tension"));
  CHECK(l.number("restitution") == 0.5);
  CHECK(l.number("friction") == 0.3);
  CHECK(law.view().count == 5);
}

TEST_CASE("bad values name the parameter, its range and its sentence") {
  using testing::kSpringsPlugin;
  CHECK(refusal_of(kSpringsPlugin, "{cap: sum}") == "dir/a.yaml:1: missing key 'stiffness' in 'p'; expected: Spring constant., in N/m");
  CHECK(refusal_of(kSpringsPlugin, "{stifness: 3}") == "dir/a.yaml:1: unknown key 'stifness' in 'p'; did you mean 'stiffness'?");
  CHECK(refusal_of(kSpringsPlugin, "{stiffness: 0.1}") ==
        "dir/a.yaml:1: 'p.stiffness' is 0.1 N/m; it must be from 1 N/m to 1000000000 N/m; Spring constant.");
  CHECK(refusal_of(kSpringsPlugin, "{stiffness: 3 m}").find("is '3 m' (length); expected: stiffness or surface tension in N/m") !=
        std::string::npos);
  CHECK(refusal_of(kSpringsPlugin, "{stiffness: 3, cap: add}") == "dir/a.yaml:1: 'p.cap' is 'add'; it must be one of spring, sum");
  CHECK(refusal_of(kSpringsPlugin, "{stiffness: 3, allow_tension: on}") == "dir/a.yaml:1: 'p.allow_tension' is 'on'; write true or false");
  CHECK(refusal_of(kSpringsPlugin, "{friction: 0.1}", Scope::pair) ==
        "dir/a.yaml:1: missing key 'restitution' in 'p'; expected: Ratio of normal speeds after and before.");
  CHECK(refusal_of(testing::kTubePlugin, "{repeat: 2}") == "dir/a.yaml:1: missing key 'file' in 'p'; expected: Mesh file.");
  CHECK(refusal_of(testing::kTubePlugin, "{file: a, repeat: 0}") ==
        "dir/a.yaml:1: 'p.repeat' is 0; it must be from 1 to 100; Copies round the axis.");
}

TEST_CASE("descriptors are found by kind and name") {
  CHECK(find_descriptor(testing::kPlugins, Kind::geometry, "tube") == &testing::kTubePlugin);
  CHECK(find_descriptor(testing::kPlugins, Kind::body_force, "tube") == nullptr);
}
