#include "kernel/host/geometry_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/values.hpp"

namespace millscope::host {

namespace {

using base::UserError;

std::vector<std::string> choices_of(const Loaded& plugin, std::string_view parameter) {
  std::vector<std::string> all;
  for (std::uint64_t i = 0; i < plugin.descriptor->parameter_count; ++i) {
    if (plugin.descriptor->parameters[i].name != parameter) continue;
    std::stringstream choices(plugin.descriptor->parameters[i].choices);
    for (std::string choice; std::getline(choices, choice, '|');) all.push_back(choice);
  }
  return all;
}

std::string extension_of(const std::string& file) {
  const std::string text = base::lower(std::filesystem::path(file).extension().string());
  return text.empty() ? text : text.substr(1);
}

}  // namespace

const Loaded& reader_of(const std::string& file, const Registry& registry) {
  const std::string extension = extension_of(file);
  std::string known;
  for (const Loaded& plugin : registry.loaded()) {
    if (static_cast<Kind>(plugin.descriptor->kind) != Kind::geometry) continue;
    for (const std::string& read : choices_of(plugin, "file")) {
      if (read == extension) return plugin;
      known += (known.empty() ? "" : ", ") + read;
    }
  }
  throw UserError(
      fmt::format("{}: no plugin reads '.{}' files; read are: {}; STEP and IGES need OpenCASCADE (docs/importing_a_liner.md); export the "
                  "body in one of these",
                  file, extension, known));
}

std::vector<std::string> units_of(const Loaded& reader) { return choices_of(reader, "unit"); }

GeometryObject open_geometry(const GeometryFile& what, const Registry& registry) {
  const Loaded& reader = reader_of(what.file, registry);
  const std::vector<std::string> units = units_of(reader);
  if (units.empty() && !what.unit.empty())
    throw UserError(fmt::format("{} {}: {} says its unit itself; leave {} out", what.unit_option, what.unit, what.file, what.unit_option));
  if (!units.empty() && std::find(units.begin(), units.end(), what.unit) == units.end())
    throw UserError(fmt::format("{} '{}' is not known; {}", what.unit_option, what.unit, base::suggestion(what.unit, units)));
  nlohmann::json values = {{"file", std::filesystem::absolute(what.file).string()}};  // as a case's, it would count from its own folder
  if (!units.empty()) values["unit"] = what.unit;
  if (what.turned) values.update({{"axis", "auto"}, {"centre", true}});
  // JSON's quoting is also YAML's.
  const config::Node node = config::parse_document(values.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), what.file);
  return GeometryObject::create(reader, config::resolve(*reader.descriptor, node, Scope::instance).view(), {"", 0});
}

}  // namespace millscope::host
