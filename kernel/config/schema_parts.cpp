// One schema for whole cases and for files that are only parts of one: types and known keys hold for both, required keys for the former.
#include "kernel/config/schema_parts.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace millscope::config {
namespace {

using nlohmann::json;

/// The parts of a schema that are schemas themselves, each once.
template <class Visit>
void for_each_below(json& schema, const Visit& visit) {
  for (const char* key : {"additionalProperties", "items"}) {
    if (schema.contains(key) && schema[key].is_object()) visit(schema[key]);
  }
  if (schema.contains("properties")) {
    for (auto& property : schema["properties"]) visit(property);
  }
  for (const char* key : {"anyOf", "oneOf"}) {
    if (!schema.contains(key)) continue;
    for (auto& alternative : schema[key]) visit(alternative);
  }
}

/// `key: ~` takes away what an included file says.
void allow_null(json& schema) {
  if (schema.contains("anyOf")) {
    schema["anyOf"].push_back({{"type", "null"}});
  } else if (schema.contains("type")) {
    if (!schema["type"].is_array()) schema["type"] = json::array({schema["type"]});
    schema["type"].push_back("null");
  }
}

void relax(json& schema) {
  schema.erase("required");
  // Without a `kind` several alternatives may hold at once.
  if (schema.contains("oneOf")) {
    schema["anyOf"] = std::move(schema["oneOf"]);
    schema.erase("oneOf");
  }
  for_each_below(schema, [](json& below) { relax(below); });
  if (schema.contains("properties")) {
    for (auto& property : schema["properties"]) allow_null(property);
  }
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) allow_null(schema["additionalProperties"]);
}

/// What all alternatives require.
json common_requirements(const json& alternatives) {
  json common = json::array();
  for (const json& name : alternatives.front().value("required", json::array())) {
    const bool everywhere = std::all_of(alternatives.begin(), alternatives.end(), [&name](const json& one) {
      const json required = one.value("required", json::array());
      return std::find(required.begin(), required.end(), name) != required.end();
    });
    if (everywhere) common.push_back(name);
  }
  return common;
}

/// Required keys alone, and a value for every key; an empty object where nothing is asked.
json demands_of(const json& schema) {
  json demands = json::object();
  if (schema.contains("required")) demands["required"] = schema["required"];
  if (schema.contains("oneOf")) {
    const json common = common_requirements(schema["oneOf"]);
    if (!common.empty()) demands["required"] = common;
  }
  if (schema.contains("properties")) {
    for (const auto& [name, property] : schema["properties"].items()) {
      const json below = demands_of(property);
      if (!below.empty()) demands["properties"][name] = below;
    }
    demands["patternProperties"][""] = {{"type", {"object", "array", "string", "number", "boolean"}}};
  }
  for (const char* key : {"additionalProperties", "items"}) {
    if (!schema.contains(key) || !schema[key].is_object()) continue;
    const json below = demands_of(schema[key]);
    if (!below.empty()) demands[key] = below;
  }
  return demands;
}

}  // namespace

json with_parts(json whole) {
  const json demands = demands_of(whole);
  relax(whole);
  whole["if"] = {{"required", {"schema_version"}}, {"not", {{"required", {"include"}}}}};
  whole["then"] = demands;
  return whole;
}

}  // namespace millscope::config
