// JSON Schema of case files, for completion and checks in editors.
#include <fmt/format.h>

#include "kernel/config/schema_parts.hpp"
#include "kernel/config/writer.hpp"

namespace millscope::config {
namespace {

using nlohmann::json;

json quantity(const std::string& doc) { return {{"type", {"number", "string"}}, {"description", doc}}; }
json text(const std::string& doc) { return {{"type", "string"}, {"description", doc}}; }
json integer(const std::string& doc) { return {{"type", "integer"}, {"minimum", 0}, {"description", doc}}; }
json flag(const std::string& doc) { return {{"type", "boolean"}, {"description", doc}}; }
json vector() { return {{"type", "array"}, {"minItems", 3}, {"maxItems", 4}, {"items", {{"type", {"number", "string"}}}}}; }
json choice(std::initializer_list<const char*> words) { return {{"enum", std::vector<std::string>(words.begin(), words.end())}}; }

json object(json properties, const std::vector<std::string>& required = {}) {
  json result = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) result["required"] = required;
  return result;
}
json map_of(json value) { return {{"type", "object"}, {"additionalProperties", std::move(value)}}; }
json either(json a, json b) { return {{"anyOf", {std::move(a), std::move(b)}}}; }

std::string described(const Parameter& p) {
  std::string doc = p.doc;
  const std::string_view unit = p.unit;
  if (!unit.empty() && unit != "1") doc += fmt::format(" [{}]", unit);
  if (p.citation[0] != '\0') doc += fmt::format(" ({})", p.citation);
  return doc;
}

json choices_of(const Parameter& p) {
  std::vector<std::string> words;
  const std::string_view all = p.choices;
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find('|', begin), all.size());
    words.emplace_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return {{"enum", words}, {"description", described(p)}};
}

json parameter(const Parameter& p) {
  switch (p.type) {
    case ValueType::integer:
      return {{"type", "integer"}, {"description", described(p)}};
    case ValueType::boolean:
      return flag(described(p));
    case ValueType::choice:
      return choices_of(p);
    case ValueType::text:
    case ValueType::file:
      return text(described(p));
    case ValueType::vector: {
      json result = vector();
      result["description"] = described(p);
      return result;
    }
    case ValueType::number:
      break;
  }
  return quantity(described(p));
}

json parameters(const Descriptor& d, Scope scope) {
  json properties = json::object();
  for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
    if (d.parameters[i].scope == scope) properties[d.parameters[i].name] = parameter(d.parameters[i]);
  }
  return properties;
}

/// One of the plugins of a kind; `extra` are keys that the reader itself takes.
json plugin(std::span<const Descriptor* const> descriptors, Kind kind, const json& extra = json::object()) {
  json kinds = json::array();
  for (const Descriptor* d : descriptors) {
    if (d->kind != static_cast<std::uint32_t>(kind)) continue;
    json properties = parameters(*d, Scope::instance);
    properties.update(extra);
    properties["kind"] = {{"const", d->name}, {"description", d->doc}};
    kinds.push_back(object(std::move(properties), {"kind"}));
  }
  if (kinds.empty()) return {{"type", "object"}, {"required", {"kind"}}};
  return {{"oneOf", kinds}};
}

json pair_schema(std::span<const Descriptor* const> descriptors) {
  json properties = json::object();
  for (const Descriptor* d : descriptors) properties.update(parameters(*d, Scope::pair));
  properties["like"] = text("another pair, whose values hold where this one gives none");
  properties["times"] = map_of(quantity("factor on a value of that pair"));
  return map_of(object(std::move(properties)));
}

json materials_schema() {
  return map_of(object({{"density", quantity("kg/m^3")},
                        {"young_modulus", quantity("E, Pa; this or shear_modulus")},
                        {"shear_modulus", quantity("G, Pa")},
                        {"poisson_ratio", quantity("above -1 and below 0.5")},
                        {"citation", text("where the values come from")}},
                       {"density", "poisson_ratio"}));
}

json beads_schema() {
  const json distribution = object({{"kind", choice({"normal", "lognormal", "uniform"})},
                                    {"mean", quantity("m")},
                                    {"deviation", quantity("standard deviation, m")},
                                    {"low", quantity("smallest diameter, m")},
                                    {"high", quantity("largest diameter, m")},
                                    {"bins", integer("number of sizes, default 11")}},
                                   {"kind"});
  const json size = object({{"diameter", quantity("m")}, {"fraction", quantity("part of the class")}}, {"diameter", "fraction"});
  return map_of(object({{"material", text("name of a material")},
                        {"diameter", quantity("m")},
                        {"sizes", {{"type", "array"}, {"items", size}}},
                        {"distribution", distribution},
                        {"fractions_by", choice({"mass", "number"})},
                        {"density", quantity("kg/m^3; default: the material's")},
                        {"share", quantity("part of the charge")},
                        {"tracer", flag("beads that are followed are of this class")}},
                       {"material"}));
}

json fill_schema() {
  return object({{"count", integer("number of beads")},
                 {"mass", quantity("kg")},
                 {"filling", quantity("J, part of the bare shell's volume")},
                 {"file", text("beads and their places: CSV with heads x, y, z, diameter or radius, material, vx … wz")},
                 {"porosity", quantity("void part of the bed, default 0.37")},
                 {"vessel", object({{"diameter", quantity("m")}, {"length", quantity("m")}}, {"diameter", "length"})},
                 {"region", object({{"low", vector()}, {"high", vector()}}, {"low", "high"})},
                 {"settle_s", quantity("s at rest before t = 0, default 0.3")},
                 {"shares_by", choice({"mass", "number"})}});
}

json motion_schema() {
  const json ripple = object({{"amplitude", quantity("part of the speed")},
                              {"frequency", quantity("Hz")},
                              {"per_turn", quantity("1, in place of frequency")},
                              {"phase", quantity("rad")}});
  const json rotation = object({{"speed", quantity("mill (default) or rad/s about the axis")},
                                {"axis", vector()},
                                {"point", vector()},
                                {"start_s", quantity("s")},
                                {"ramp_s", quantity("s")},
                                {"ripple", ripple}});
  const json oscillation = object({{"amplitude", vector()}, {"frequency", quantity("Hz")}, {"phase", quantity("rad")}});
  const json translation = object({{"velocity", vector()}, {"oscillation", oscillation}, {"start_s", quantity("s")}});
  return either(choice({"fixed", "mill"}), object({{"rotation", rotation}, {"translation", translation}}));
}

json domain_schema() {
  const json period = {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}};
  const json sides = either(vector(), object({{"x", quantity("m")}, {"y", quantity("m")}, {"z", quantity("m")}}));
  return object({{"periodic", object({{"x", period}, {"y", period}, {"z", period}})}, {"low", sides}, {"high", sides}});
}

json output_schema() {
  const json off = choice({"off"});
  const json every = quantity("s");
  const json beads = either(integer("that many"), {{"type", "array"}, {"items", integer("bead id")}});
  return object({{"series", either(off, object({{"every_s", every}}))},
                 {"frames", either(off, object({{"every_s", every}, {"from_s", every}}))},
                 {"tracks", either(off, object({{"beads", beads}, {"every_s", every}}))},
                 {"vtk", either(off, object({{"every_s", every}}))},
                 {"checkpoint", either(off, object({{"every_wall_s", quantity("s of wall time")}}))}});
}

json geometry_schema(std::span<const Descriptor* const> descriptors) {
  const json own = {{"material", text("of every part not named in 'materials'")},
                    {"materials", map_of(text("material of this part"))},
                    {"motion", motion_schema()}};
  return map_of(plugin(descriptors, Kind::geometry, own));
}

json time_schema() {
  return object({{"end_s", quantity("s")},
                 {"analyze_from_s", quantity("s, default half of end_s")},
                 {"step_s", quantity("s; excludes step_fraction")},
                 {"step_fraction", quantity("of the Rayleigh time, default 20 %")}},
                {"end_s"});
}

json start_schema() {
  return object({{"run", text("folder of a finished run of the same mill")},
                 {"develop_s", quantity("s that the mill turns before the analysis")},
                 {"walls_ahead_s", quantity("s; a run finds it out itself")}},
                {"run", "develop_s"});
}

}  // namespace

json case_schema(std::span<const Descriptor* const> descriptors) {
  const json contact = object({{"law", plugin(descriptors, Kind::contact_law)},
                               {"interactions", map_of(plugin(descriptors, Kind::interaction))},
                               {"pair_parameters", map_of(plugin(descriptors, Kind::pair_parameter))},
                               {"wear", map_of(plugin(descriptors, Kind::wear_law))}},
                              {"law"});
  const json mill = object({{"speed", quantity("rad/s, rpm or %critical, not negative")},
                            {"diameter", quantity("m, for %critical")},
                            {"direction", choice({"counter_clockwise", "clockwise"})}},
                           {"speed"});
  const json run = object({{"threads", integer("0: as many as the machine has")},
                           {"partitions", integer("slabs, default: by the number of beads")},
                           {"skin", quantity("of the largest bead's diameter, default 0.2")},
                           {"allow_unstable", flag("run with a refused time step")},
                           {"engine", text("another program that moves the beads: liggghts")},
                           {"ranks", integer("processes of that program, default 1")}});
  json schema = object({{"schema_version", {{"const", kSchemaVersion}}},
                        {"include", {{"type", "array"}, {"items", {{"type", "string"}}}}},
                        {"name", text("title of the case")},
                        {"seed", integer("of everything random, default 1")},
                        {"stiffness_factor", quantity("on every Young's modulus, default 1")},
                        {"materials", materials_schema()},
                        {"groups", map_of({{"type", "array"}, {"items", {{"type", "string"}}}})},
                        {"beads", beads_schema()},
                        {"fill", fill_schema()},
                        {"contact", contact},
                        {"pairs", pair_schema(descriptors)},
                        {"body_forces", map_of(plugin(descriptors, Kind::body_force))},
                        {"mill", mill},
                        {"geometry", geometry_schema(descriptors)},
                        {"domain", domain_schema()},
                        {"time", time_schema()},
                        {"start", start_schema()},
                        {"output", output_schema()},
                        {"run", run}},
                       {"schema_version", "materials", "beads", "fill", "contact", "pairs", "body_forces", "time"});
  schema = with_parts(std::move(schema));
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "millscope case";
  return schema;
}

}  // namespace millscope::config
