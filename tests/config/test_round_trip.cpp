#include "kernel/config/writer.hpp"
#include "tests/config/helpers.hpp"

using namespace millscope::config;
using testing::kPlugins;
using testing::read_all;

namespace {

/// The resolved file is a fixed point: reading it gives the same case.
void check_fixed_point(const Case& c) {
  const std::string once = resolved_yaml(c, kPlugins);
  const Case again = parse_case(once, "resolved.yaml");
  finish(again, kPlugins);
  CHECK(resolved_yaml(again, kPlugins) == once);
  CHECK(bead_count(again) == bead_count(c));
  CHECK(again.beads[0].sizes.size() == c.beads[0].sizes.size());
  for (std::size_t i = 0; i < c.beads[0].sizes.size(); ++i) {
    CHECK(again.beads[0].sizes[i].number_fraction == c.beads[0].sizes[i].number_fraction);
  }
  if (c.mill) CHECK(again.mill->speed == c.mill->speed);
}

}  // namespace

TEST_CASE("a resolved case reads back to the same case") {
  check_fixed_point(read_all(testing::kCase));
  check_fixed_point(
      read_all(testing::kCase, {"mill.direction=clockwise", "output.tracks={beads: [1, 2]}", "time.step_s=1 us", "name='a \"b\": #c'"}));
  check_fixed_point(read_all(testing::kCase, {"geometry.liner.motion={rotation: {ripple: {amplitude: 1 %, frequency: 3}}, "
                                              "translation: {oscillation: {amplitude: [1, 0, 0], frequency: 2}}}",
                                              "fill.region={low: [0, 0, 0], high: [1, 1, 1]}", "domain.low={x: -1}"}));
  check_fixed_point(read_all(testing::kCase, {"geometry.liner.motion={rotation: {ripple: {amplitude: 1 %, per_turn: 3}}}"}));
  check_fixed_point(read_all(
      testing::case_with("beads",
                         "beads: {a: {material: glass, share: 30 %, distribution: {kind: lognormal, mean: 5 mm, deviation: 0.7 mm}}, "
                         "b: {material: nylon, share: 70 %, diameter: 3 mm}}")));
}

TEST_CASE("a resolved case states every default in SI") {
  const std::string text = resolved_yaml(read_all(testing::kCase), kPlugins);
  CHECK(text.find("  glass:\n    density: 2500\n    young_modulus: 63960000000\n    poisson_ratio: 0.23\n") != std::string::npos);
  CHECK(text.find("    kind: springs\n    stiffness: 1000\n    cap: \"spring\"\n    allow_tension: false\n") != std::string::npos);
  CHECK(text.find("  glass~glass:\n    restitution: 0.8\n    friction: 0.34\n") != std::string::npos);
  CHECK(text.find("  glass~liner:\n    restitution: 0.55\n    friction: 0.3\n") != std::string::npos);
  CHECK(text.find("stiffness_factor: 1\n") != std::string::npos);
  CHECK(text.find("    acceleration: 9.81\n") != std::string::npos);
  CHECK(text.find("    shift: [0, 0, 0]\n") != std::string::npos);
  CHECK(text.find("  vtk: off\n") != std::string::npos);
}

TEST_CASE("a text stands in a resolved case as `quoted` gives it, so that it can be found there") {
  for (const std::string& name : {std::string("a b"), std::string("a \"b\": \\#c"), std::string("Mühle")}) {
    Case c = read_all(testing::kCase);
    c.name = name;
    CHECK(resolved_yaml(c, kPlugins).find("name: " + quoted(name) + "\n") != std::string::npos);
  }
  CHECK(quoted("a \"b\"\n") == "\"a \\\"b\\\"\\n\"");
  CHECK(quoted("\xff") == "\"\xef\xbf\xbd\"");  // no UTF-8: the character that stands for others
}

TEST_CASE("without descriptors a plugin's keys are copied") {
  const std::string text = resolved_yaml(parse_case(testing::kCase, "case.yaml"));
  CHECK(text.find("    stiffness: \"1 kN/m\"\n") != std::string::npos);
  CHECK_NOTHROW(read_all(text));
}

TEST_CASE("the schema holds the plugins' parameters") {
  const nlohmann::json schema = case_schema(kPlugins);
  CHECK(schema["properties"]["contact"]["properties"]["law"]["anyOf"][0]["properties"]["kind"]["const"] == "springs");
  CHECK(schema["properties"]["contact"]["properties"]["law"]["anyOf"][0]["properties"]["cap"]["enum"][1] == "sum");
  CHECK(schema["properties"]["pairs"]["additionalProperties"]["properties"].contains("restitution"));
  CHECK(schema["properties"]["geometry"]["additionalProperties"]["anyOf"][0]["properties"].contains("motion"));
  CHECK(schema["then"]["properties"]["geometry"]["additionalProperties"]["required"][0] == "kind");
  CHECK(schema["additionalProperties"] == false);
  CHECK(schema["then"]["properties"]["contact"]["properties"]["interactions"]["additionalProperties"]["required"][0] == "kind");
  CHECK_FALSE(schema["properties"]["geometry"]["additionalProperties"]["anyOf"][0].contains("required"));
  CHECK(schema["properties"]["domain"]["properties"]["low"]["anyOf"].size() == 3);  // a vector, sides, nothing
  CHECK(schema["properties"]["output"]["properties"]["vtk"]["anyOf"][0]["enum"][0] == "off");
}
