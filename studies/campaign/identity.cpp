#include "studies/campaign/identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "kernel/base/text.hpp"
#include "kernel/config/imported.hpp"
#include "kernel/config/values.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/run/assembly.hpp"
#include "studies/engine/engine.hpp"

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr int kCacheVersion = 2;                  // of what a key is made of
constexpr std::size_t kProgramDigits = 16;        // of a key: which program
constexpr std::uint64_t kBaseMemory = 40U << 20;  // bytes: the program, its libraries and buffers, as `millscope check` has it
constexpr std::uint64_t kMemoryPerBead = 1000;    // bytes
constexpr std::uint64_t kMemoryPerMeshByte = 10;  // triangles, their trees and their topology

std::string read_file(const std::string& path) {
  std::optional<std::string> text = base::text_if_readable(path);
  if (!text) throw UserError(fmt::format("{}: the case names this file and it cannot be read; put it there or correct the case", path));
  return std::move(*text);
}

/// A glTF file may keep its numbers in files beside it: their contents belong to it.
NamedFile name_file(const std::string& path) {
  NamedFile file{path, content_hash(read_file(path)), true};
  if (base::lower(fs::path(path).extension().string()) != ".gltf") return file;
  file.alone = false;
  const nlohmann::json json = nlohmann::json::parse(read_file(path), nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return file;
  for (const nlohmann::json& buffer : json["buffers"]) {
    const std::string uri = buffer.is_object() ? buffer.value("uri", "") : "";
    const fs::path beside = fs::path(path).parent_path() / uri;
    if (uri.empty() || uri.starts_with("data:") || !fs::is_regular_file(beside)) continue;
    file.hash = content_hash(file.hash + content_hash(read_file(beside.string())));
  }
  return file;
}

/// Visits every use of a plugin in a case: the kind, the plugin's name, and each section with its parameters.
template <class Visit>
void each_plugin(const config::Case& c, const Visit& visit) {
  const auto on_pairs = [&](Kind kind, const config::PluginInstance& use) {
    visit(kind, use.kind, use.node, Scope::instance);
    for (const std::string& key : c.pairs.keys()) visit(kind, use.kind, c.pairs.section().at(key), Scope::pair);
  };
  on_pairs(Kind::contact_law, c.contact.law);
  for (const config::PluginInstance& use : c.contact.interactions) on_pairs(Kind::interaction, use);
  for (const config::PluginInstance& use : c.contact.pair_parameters) on_pairs(Kind::pair_parameter, use);
  for (const config::PluginInstance& use : c.contact.wear) on_pairs(Kind::wear_law, use);
  for (const config::PluginInstance& use : c.body_forces) visit(Kind::body_force, use.kind, use.node, Scope::instance);
  for (const config::GeometryCase& g : c.geometry) visit(Kind::geometry, g.plugin.kind, g.plugin.node, Scope::instance);
}

std::vector<NamedFile> files_of(const config::Case& c, const host::Registry& registry) {
  std::set<std::string> paths;
  each_plugin(c, [&](Kind kind, const std::string& name, const config::Node& node, Scope scope) {
    const Descriptor& descriptor = *registry.find(kind, name).descriptor;
    const config::ResolvedValues values = config::resolve_present(descriptor, node, scope);
    const Values view = values.view();
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
      if (descriptor.parameters[i].scope != scope) continue;
      const Value& value = view.items[next++];
      if (descriptor.parameters[i].type == ValueType::file && value.given != 0) paths.insert(value.text);
    }
  });
  if (!c.fill.file.empty()) paths.insert(c.fill.file);
  std::vector<NamedFile> files;
  for (const std::string& path : paths) files.push_back(name_file(path));
  return files;
}

/// The code of each plugin that the case loads.
base::ProgramParts plugins_of(const config::Case& c, const host::Registry& registry) {
  base::ProgramParts parts;
  each_plugin(c, [&](Kind kind, const std::string& name, const config::Node&, Scope) {
    parts[host::text(kind) + " " + name] = registry.find(kind, name).library->code_hash();
  });
  if (!c.run.engine.empty()) parts["engine " + c.run.engine] = engine::version_of(c);
  return parts;
}

std::string text_of(const base::ProgramParts& parts) {
  std::string text;
  for (const auto& [part, value] : parts) text += part + "\n" + value + "\n";
  return text;
}

/// The case without what has no influence on what the run writes, and with contents in the place of paths.
std::string essence(config::Case c, const host::Registry& registry, const std::vector<NamedFile>& files) {
  c.name.clear();
  c.run.threads = 0;
  c.output.checkpoint = config::OutputCase::Checkpoint{};
  if (c.start) c.start->run = "content " + content_hash(read_file(output::checkpoint_path(c.start->run).string()));
  std::string text = config::resolved_yaml(c, registry.descriptors());
  for (const NamedFile& file : files) text = replaced(std::move(text), config::quoted(file.path), "content " + file.hash);
  return text;
}

/// 0 when it cannot be told; the run itself then says why.
double beads_of(const Simulation& simulation, const config::Case& c, const host::Registry& registry) {
  try {
    const bool told = !c.fill.filling || c.fill.vessel;
    if (told) return static_cast<double>(config::bead_count(c));
    return static_cast<double>(
        run::assemble(config::read_case(simulation.case_file.string(), simulation.settings), registry, {1, ""}).bead_count);
  } catch (const UserError&) {
    return 0;
  }
}

std::uint64_t predicted_memory(double beads, const std::vector<NamedFile>& files) {
  std::uint64_t bytes = kBaseMemory + static_cast<std::uint64_t>(beads) * kMemoryPerBead;
  for (const NamedFile& file : files) {
    std::error_code ignored;
    const std::uintmax_t size = fs::file_size(file.path, ignored);
    if (!ignored) bytes += size * kMemoryPerMeshByte;
  }
  return bytes;
}

void check_start(const Simulation& simulation, const config::Case& c) {
  if (c.start) c.start->node.fail("is given, but the campaign chooses the run from which this simulation begins; leave 'start' out");
  if (simulation.develop_s > 0 && simulation.develop_s <= c.time.analyze_from) return;
  throw UserError(c.time.where, fmt::format("the analysis begins at time.analyze_from_s = {:.6g} s, and the mill is to turn for {:.6g} s "
                                            "before; give a time above 0 and no longer than that",
                                            c.time.analyze_from, simulation.develop_s));
}

host::RegistryOptions registry_options(const Options& options) {
  host::RegistryOptions r;
  for (const fs::path& directory : options.plugin_directories) r.directories.push_back(directory.string());
  return r;
}

}  // namespace

std::string content_of(const config::Case& c, const host::Registry& registry) {
  if (config::is_imported(c)) return base::text_of(c.file);  // the mill of a recording; nothing is left to its defaults
  return essence(c, registry, files_of(c, registry)) + text_of(plugins_of(c, registry));
}

std::string content_hash(const std::string& bytes) {
  // The namespace is part of the cache's format.
  constexpr boost::uuids::uuid kNamespace{{0x6d, 0x69, 0x6c, 0x6c, 0x73, 0x63, 0x6f, 0x70, 0x65, 0, 0, 0, 0, 0, 0, 1}};
  const boost::uuids::uuid hash = boost::uuids::name_generator_sha1(kNamespace)(bytes.data(), bytes.size());
  std::string text;
  for (const std::uint8_t byte : hash) text += fmt::format("{:02x}", byte);
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

std::string case_of(const std::string& key) { return key.substr(0, key.find('-')); }

Identifier::Identifier(const Options& options) : registry_(registry_options(options)) {}

const Identifier::Donor& Identifier::donor_of(const Simulation& simulation) const {
  static const Donor kNone;
  if (!simulation.donor) return kNone;
  if (const auto known = donors_.find(simulation.donor); known != donors_.end()) return known->second;
  Donor donor;
  try {
    const Identity identity = identify(*simulation.donor);
    donor = {simulation.donor, identity.key, identity.program};
  } catch (const UserError&) {
    donor = donor_of(*simulation.donor);
  }
  return donors_.emplace(simulation.donor, std::move(donor)).first->second;
}

Identity Identifier::identify(const Simulation& simulation) const {
  const config::Case c = config::read_case(simulation.case_file.string(), simulation.settings);
  config::finish(c, registry_.descriptors());
  const Donor& donor = donor_of(simulation);
  if (donor.simulation) check_start(simulation, c);
  Identity id;
  id.donor = donor.key;
  id.files = files_of(c, registry_);
  id.program = plugins_of(c, registry_);
  id.program.merge(base::program_parts(base::simulating_folders()));
  base::ProgramParts of_donor = donor.program;
  id.program.merge(of_donor);
  std::string content = fmt::format("cache {}\n{}", kCacheVersion, essence(c, registry_, id.files));
  if (donor.simulation) {
    id.develop_s = simulation.develop_s;
    content += fmt::format("begins at the end of {}, {} s before the analysis\n", case_of(donor.key), simulation.develop_s);
  }
  id.key = content_hash(content) + "-" + content_hash(text_of(id.program)).substr(0, kProgramDigits);
  id.case_yaml = config::resolved_yaml(c, registry_.descriptors());
  const double beads = beads_of(simulation, c, registry_);
  id.work = std::max(1.0, beads) * (c.time.end + (donor.simulation ? simulation.develop_s - c.time.analyze_from : c.fill.settle));
  id.end_s = c.time.end;
  id.memory = predicted_memory(beads, id.files);
  id.cores = c.run.engine.empty() ? 1 : c.run.ranks;
  return id;
}

std::string key(const Simulation& simulation, const Options& options) { return Identifier(options).identify(simulation).key; }

}  // namespace millscope::campaign
