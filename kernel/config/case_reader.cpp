// The case as a whole: order of sections and what they need from each other.
#include <fmt/format.h>
#include <filesystem>

#include "kernel/base/nearest.hpp"
#include "kernel/config/bead_file.hpp"
#include "kernel/config/imported.hpp"
#include "kernel/config/reader.hpp"
#include "kernel/config/values.hpp"

namespace millscope::config {
namespace {

void check_version(const Node& root) {
  const Node version = root.at("schema_version", fmt::format("the version of the file's shape: {}", kSchemaVersion));
  const long long number = read_integer(version, any_number());
  if (number != kSchemaVersion) {
    version.fail(fmt::format("is {}; this millscope reads {}; {}", number, kSchemaVersion,
                             number > kSchemaVersion ? "use a newer millscope" : "rewrite the file after docs/format.md"));
  }
}

void read_head(const Node& root, Case& c) {
  const auto name = root.find("name");
  c.name = name ? name->text() : std::filesystem::path(c.file).stem().string();
  if (const auto seed = root.find("seed")) c.seed = static_cast<std::uint64_t>(read_integer(*seed, not_negative()));
  const Range factor{0, 1, true, false, "1 is the real stiffness, less is softer"};
  c.stiffness_factor = number_or(root, "stiffness_factor", "1", factor, c.stiffness_factor);
}

/// Laws and their coefficients.
void read_physics(const Node& root, Case& c) {
  c.contact = read_contact(root.at("contact", "the contact law: {law: {kind: hertz_mindlin}}"));
  c.pairs =
      read_pairs(root.at("pairs", "values per pair of materials: {glass~glass: {restitution: 0.8, …}}"), root.find("groups"), c.materials);
}

Case from_tree(const Node& root, const std::string& file) {
  root.expect({"schema_version", "name", "seed", "stiffness_factor", "materials", "groups", "beads", "fill", "contact", "pairs",
               "body_forces", "mill", "geometry", "domain", "time", "start", "output", "run"});
  Case c;
  c.file = file;
  c.root = root;
  check_version(root);
  read_head(root, c);
  if (const auto run = root.find("run")) c.run = read_run(*run);
  c.materials =
      read_materials(root.at("materials", "materials by name: {glass: {density, shear_modulus, poisson_ratio}}"), !is_imported(c));
  const Node fill = root.at("fill", "how much charge: {filling: 31.3 %}, {mass: 1 kg} or {count: 4000}");
  c.fill = read_fill(fill);
  const Node beads = root.at("beads", "bead classes by name: {glass5: {material: glass, diameter: 5 mm}}");
  c.beads = read_beads(beads, c.materials, read_shares_by_mass(fill));
  if (!c.fill.file.empty()) place_beads(c);
  if (!is_imported(c)) read_physics(root, c);
  c.body_forces = read_instances(root.at("body_forces", "{gravity: {kind: gravity}}, or {} for none"), "body force");
  if (const auto mill = root.find("mill")) c.mill = read_mill(*mill, c.largest_diameter());
  if (const auto geometry = root.find("geometry")) c.geometry = read_geometry(*geometry, c);
  c.domain.box.low.fill(-kUnbounded);
  c.domain.box.high.fill(kUnbounded);
  if (const auto domain = root.find("domain")) c.domain = read_domain(*domain);
  c.time = read_time(root.at("time", "{end_s: 4}"));
  if (const auto start = root.find("start")) c.start = read_start(*start, c.time);
  c.output = read_output(root.find("output"), c.time);
  return c;
}

const Descriptor& descriptor_of(std::span<const Descriptor* const> descriptors, Kind kind, const PluginInstance& instance) {
  if (const Descriptor* found = find_descriptor(descriptors, kind, instance.kind)) return *found;
  std::vector<std::string> names;
  for (const Descriptor* d : descriptors) {
    if (d->kind == static_cast<std::uint32_t>(kind)) names.emplace_back(d->name);
  }
  instance.node.at("kind").fail(fmt::format("is '{}', which no loaded plugin of this kind provides; {}", instance.kind,
                                            names.empty() ? "load one with --plugin-dir" : base::suggestion(instance.kind, names)));
}

void check_plugins(const Case& c, std::span<const Descriptor* const> descriptors) {
  std::vector<const Descriptor*> on_pairs;
  const auto check = [&](Kind kind, const PluginInstance& instance) {
    const Descriptor& descriptor = descriptor_of(descriptors, kind, instance);
    resolve(descriptor, instance.node, Scope::instance);
    return &descriptor;
  };
  on_pairs.push_back(check(Kind::contact_law, c.contact.law));
  for (const PluginInstance& i : c.contact.interactions) on_pairs.push_back(check(Kind::interaction, i));
  for (const PluginInstance& i : c.contact.pair_parameters) on_pairs.push_back(check(Kind::pair_parameter, i));
  for (const PluginInstance& i : c.contact.wear) on_pairs.push_back(check(Kind::wear_law, i));
  for (const PluginInstance& i : c.body_forces) check(Kind::body_force, i);
  for (const GeometryCase& g : c.geometry) check(Kind::geometry, g.plugin);
  for (const std::string& key : c.pairs.keys()) {
    for (const Descriptor* d : on_pairs) resolve_present(*d, c.pairs.section().at(key), Scope::pair);
  }
}

}  // namespace

std::vector<PluginInstance> read_instances(const Node& section, const char* what) {
  std::vector<PluginInstance> instances;
  for (const std::string& name : section.keys()) {
    const Node node = section.at(name);
    check_name(name, node.where(), what);
    const std::string kind = node.at("kind", fmt::format("the name of a plugin that makes a {}", what)).text();
    instances.push_back({name, kind, node, node.where()});
  }
  return instances;
}

ContactCase read_contact(const Node& section) {
  section.expect({"law", "interactions", "pair_parameters", "wear"});
  ContactCase contact;
  const Node law = section.at("law", "{kind: hertz_mindlin}");
  contact.law = {"law", law.at("kind", "the name of a contact law, e.g. hertz_mindlin").text(), law, law.where()};
  if (const auto node = section.find("interactions")) contact.interactions = read_instances(*node, "interaction");
  if (const auto node = section.find("pair_parameters")) contact.pair_parameters = read_instances(*node, "pair parameter");
  if (const auto node = section.find("wear")) contact.wear = read_instances(*node, "wear law");
  return contact;
}

Case read_case(const std::string& file, const std::vector<std::string>& overrides) {
  return from_tree(load_document(file, overrides), file);
}

Case parse_case(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  return from_tree(parse_document(text, file, overrides), file);
}

void finish(const Case& c, std::span<const Descriptor* const> descriptors) {
  refuse_imported(c);
  if (!descriptors.empty()) check_plugins(c, descriptors);
  c.root.finish();
}

}  // namespace millscope::config
