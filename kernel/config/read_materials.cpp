// `materials`, `groups`, `pairs`.
#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "kernel/base/nearest.hpp"
#include "kernel/config/reader.hpp"

namespace millscope::config {
namespace {

std::vector<std::string> names_of(const std::vector<MaterialCase>& materials) {
  std::vector<std::string> names;
  for (const MaterialCase& m : materials) names.push_back(m.name);
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// E from either modulus.
double read_young(const Node& node, double poisson) {
  const bool young = node.has("young_modulus"), shear = node.has("shear_modulus");
  if (young && shear) node.fail("gives both 'young_modulus' and 'shear_modulus'; one follows from the other by E = 2 G (1 + nu); keep one");
  if (shear) return 2 * read_number(node.at("shear_modulus"), "Pa", positive()) * (1 + poisson);
  return read_number(node.at("young_modulus", "'young_modulus' or 'shear_modulus', e.g. 26 GPa"), "Pa", positive());
}

MaterialCase read_material(const Node& node, const std::string& name, bool elastic) {
  node.expect({"density", "young_modulus", "shear_modulus", "poisson_ratio", "citation"});
  MaterialCase m;
  m.name = name;
  m.where = node.where();
  m.density = read_number(node.at("density", "the solid's density, e.g. 2500 kg/m^3"), "kg/m^3", positive());
  if (const auto citation = node.find("citation")) m.citation = citation->text();
  if (!elastic) return m;
  const Range stable{-1, 0.5, true, true, "no isotropic solid is stable outside; look the value up again in its source"};
  m.poisson = read_number(node.at("poisson_ratio", "Poisson's ratio, e.g. 0.23"), "1", stable);
  m.young = read_young(node, m.poisson);
  return m;
}

void check_pair_key(const Node& section, const std::string& key, const std::vector<std::string>& known) {
  if (key == "default") return;
  const Location where = section.at(key).where();
  const std::size_t tilde = key.find('~');
  if (tilde == std::string::npos) {
    throw UserError(where,
                    fmt::format("pair '{}' names no pair; write material~material, e.g. {}~{}, or default", key, known[0], known[0]));
  }
  for (const std::string& name : {key.substr(0, tilde), key.substr(tilde + 1)}) {
    if (!contains(known, name)) {
      throw UserError(where,
                      fmt::format("pair '{}' names the unknown material or group '{}'; {}", key, name, base::suggestion(name, known)));
    }
  }
}

}  // namespace

void check_name(const std::string& name, const Location& where, const char* what) {
  const bool letter_first = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  const bool plain = std::all_of(name.begin(), name.end(),
                                 [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; });
  if (letter_first && plain && name != "default") return;
  throw UserError(where, fmt::format("'{}' cannot name a {}; use letters, digits, '_' and '-', beginning with a letter", name, what));
}

std::string read_material_name(const Node& node, const std::vector<MaterialCase>& materials) {
  const std::vector<std::string> names = names_of(materials);
  if (!contains(names, node.text()))
    node.fail(fmt::format("is the unknown material '{}'; {}", node.text(), base::suggestion(node.text(), names)));
  return node.text();
}

double number_or(const Node& section, std::string_view key, std::string_view si_unit, const Range& range, double fallback) {
  const auto node = section.find(key);
  return node ? read_number(*node, si_unit, range) : fallback;
}

std::vector<MaterialCase> read_materials(const Node& section, bool elastic) {
  std::vector<MaterialCase> materials;
  for (const std::string& name : section.keys()) {
    const Node node = section.at(name);
    check_name(name, node.where(), "material");
    materials.push_back(read_material(node, name, elastic));
  }
  if (materials.empty()) section.fail("names no material; add one");
  return materials;
}

std::map<std::string, std::string> read_groups(const std::optional<Node>& section, const std::vector<MaterialCase>& materials) {
  std::map<std::string, std::string> group_of;
  if (!section) return group_of;
  for (const std::string& group : section->keys()) {
    const Node node = section->at(group);
    check_name(group, node.where(), "group");
    if (contains(names_of(materials), group)) node.fail("has the name of a material; choose another");
    for (const Node& item : node.items()) {
      const std::string material = read_material_name(item, materials);
      const bool added = group_of.emplace(material, group).second;
      if (!added) item.fail(fmt::format("is in the group '{}' already; a material has one group", group_of[material]));
    }
  }
  return group_of;
}

PairTable read_pairs(const Node& section, const std::optional<Node>& groups, const std::vector<MaterialCase>& materials) {
  std::map<std::string, std::string> group_of = read_groups(groups, materials);
  std::vector<std::string> known = names_of(materials);
  if (groups) {
    for (const std::string& group : groups->keys()) known.push_back(group);
  }
  for (const std::string& key : section.keys()) {
    check_pair_key(section, key, known);
    section.at(key).keys();  // must be a map
  }
  complete_pairs(section);
  return PairTable(section, std::move(group_of));
}

}  // namespace millscope::config
