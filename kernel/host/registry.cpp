#include "kernel/host/registry.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"
#include "kernel/host/directory_check.hpp"

namespace millscope::host {

namespace fs = std::filesystem;

namespace {

const std::map<Kind, std::string>& kind_words() {
  static const std::map<Kind, std::string> words = {
      {Kind::contact_law, "contact_law"}, {Kind::interaction, "interaction"}, {Kind::pair_parameter, "pair_parameter"},
      {Kind::body_force, "body_force"},   {Kind::geometry, "geometry"},       {Kind::observation, "observation"},
      {Kind::analyzer, "analyzer"},       {Kind::wear_law, "wear_law"}};
  return words;
}

std::vector<fs::path> libraries_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code trouble;
  if (!fs::is_directory(folder, trouble)) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".so" && !fs::is_directory(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Library file name → the folder to take it from, the best level first. `skipped` gets those built only for better machines.
std::map<std::string, std::string> choose_builds(const fs::path& directory, InstructionSet level, std::string& skipped) {
  std::map<std::string, std::string> chosen;
  for (const std::string& folder : folders_for(level)) {
    for (const fs::path& file : libraries_in(directory / folder)) chosen.emplace(file.filename().string(), folder);
  }
  for (const std::string& folder : folders_for(InstructionSet::v4)) {
    for (const fs::path& file : libraries_in(directory / folder)) {
      if (!chosen.contains(file.filename().string())) skipped = file.string();
    }
  }
  return chosen;
}

/// "did you mean 'x'?" among the plugins of that kind, or where else the name is.
std::string hint(const std::vector<Loaded>& loaded, Kind kind, std::string_view name) {
  std::vector<std::string> names;
  for (const Loaded& plugin : loaded) {
    if (plugin.kind() == kind) names.emplace_back(plugin.name());
    if (plugin.name() == name && plugin.kind() != kind) return fmt::format("'{}' is of kind {}", name, text(plugin.kind()));
  }
  return names.empty() ? fmt::format("no {} is loaded", text(kind)) : base::suggestion(name, names);
}

}  // namespace

std::string text(Kind kind) {
  const auto found = kind_words().find(kind);
  return found == kind_words().end() ? "kind " + std::to_string(static_cast<std::uint32_t>(kind)) : found->second;
}

std::optional<Kind> parse_kind(std::string_view word) {
  for (const auto& [kind, known] : kind_words()) {
    if (known == word) return kind;
  }
  return {};
}

const std::vector<Kind>& all_kinds() {
  static const std::vector<Kind> kinds = [] {
    std::vector<Kind> all;
    for (const auto& entry : kind_words()) all.push_back(entry.first);
    return all;
  }();
  return kinds;
}

std::vector<std::string> own_directories() {
  std::error_code trouble;
  const fs::path executable = fs::read_symlink("/proc/self/exe", trouble);
  std::vector<std::string> found;
  if (trouble) return found;
  const fs::path prefix = executable.parent_path().parent_path();
  for (const char* libraries : {"lib", MILLSCOPE_LIBDIR}) {
    const fs::path directory = fs::weakly_canonical(prefix / libraries / "millscope" / "plugins", trouble);
    if (!trouble && fs::is_directory(directory, trouble) && std::find(found.begin(), found.end(), directory.string()) == found.end()) {
      found.push_back(directory.string());
    }
  }
  return found;
}

Registry::Registry(const RegistryOptions& options) : level_(choose_instruction_set(options.instruction_set)) {
  if (options.own) {
    for (const std::string& directory : own_directories()) add_directory(directory, false);
  }
  for (const std::string& directory : options.directories) add_directory(directory, true);
  std::sort(loaded_.begin(), loaded_.end(), [](const Loaded& a, const Loaded& b) {
    return std::make_tuple(a.descriptor->kind, a.name()) < std::make_tuple(b.descriptor->kind, b.name());
  });
}

void Registry::add_directory(const std::string& directory, bool named_by_user) {
  std::error_code trouble;
  const fs::path path = fs::canonical(directory, trouble);
  if (directory.empty() || trouble || !fs::is_directory(path, trouble)) {
    throw UserError(fmt::format("plugin directory '{}' does not exist or is no directory; see --plugin-dir", directory));
  }
  if (std::find(searched_.begin(), searched_.end(), path.string()) != searched_.end()) return;
  searched_.push_back(path.string());
  require_private(path.string());
  std::string skipped;
  const std::map<std::string, std::string> builds = choose_builds(path, level_, skipped);
  if (!skipped.empty()) {
    throw UserError(fmt::format("plugin library '{}' has no build for x86-64-{} or less: build it with millscope_add_plugin(… WIDE)",
                                skipped, text(level_)));
  }
  if (builds.empty() && named_by_user) {
    throw UserError(
        fmt::format("plugin directory '{}' holds no plugin library (*.so, also in v2, v3, v4); see --plugin-dir", path.string()));
  }
  for (const auto& [file, folder] : builds) {
    if (!folder.empty()) require_private((path / folder).string());
    add_library(Library::open((path / folder / file).string(), folder));
  }
}

void Registry::add_library(const std::shared_ptr<const Library>& library) {
  for (const Descriptor* descriptor : library->descriptors()) {
    const Loaded* other = try_find(static_cast<Kind>(descriptor->kind), descriptor->name);
    if (other != nullptr) {
      throw UserError(fmt::format("two libraries have a {} '{}': '{}' and '{}'; remove or rename one", text(other->kind()),
                                  descriptor->name, other->library->path(), library->path()));
    }
  }
  for (const Descriptor* descriptor : library->descriptors()) loaded_.push_back({descriptor, library});
}

const Loaded* Registry::try_find(Kind kind, std::string_view name) const {
  for (const Loaded& plugin : loaded_) {
    if (plugin.kind() == kind && plugin.name() == name) return &plugin;
  }
  return nullptr;
}

const Loaded& Registry::find(Kind kind, std::string_view name, const Location& where) const {
  if (const Loaded* found = try_find(kind, name)) return *found;
  const std::string message =
      fmt::format("no {} is called '{}'; {} (searched: {}; add a directory with --plugin-dir)", text(kind), name, hint(loaded_, kind, name),
                  searched_.empty() ? "nothing" : fmt::format("{}", fmt::join(searched_, ", ")));
  if (where.file.empty()) throw UserError(message);
  throw UserError(where, message);
}

std::vector<const Loaded*> Registry::find_any(std::string_view name) const {
  std::vector<const Loaded*> found;
  std::vector<std::string> names;
  for (const Loaded& plugin : loaded_) {
    names.emplace_back(plugin.name());
    if (plugin.name() == name) found.push_back(&plugin);
  }
  if (!found.empty()) return found;
  throw UserError(fmt::format("no plugin is called '{}'; {} (searched: {}; add a directory with --plugin-dir)", name,
                              names.empty() ? "none is loaded" : base::suggestion(name, names),
                              searched_.empty() ? "nothing" : fmt::format("{}", fmt::join(searched_, ", "))));
}

std::vector<const Descriptor*> Registry::descriptors() const { return descriptors_of(loaded_); }

std::vector<PluginRecord> Registry::records() const {
  std::vector<PluginRecord> records;
  for (const Loaded& p : loaded_) {
    const std::string& level = p.library->level();
    records.push_back({text(p.kind()), std::string(p.name()), p.descriptor->version, p.descriptor->compiler, p.library->path(),
                       level.empty() ? "any" : "x86-64-" + level, p.library->hash(), p.library->code_hash()});
  }
  return records;
}

std::vector<const Descriptor*> descriptors_of(const std::vector<Loaded>& plugins) {
  std::vector<const Descriptor*> descriptors;
  for (const Loaded& plugin : plugins) descriptors.push_back(plugin.descriptor);
  return descriptors;
}

}  // namespace millscope::host
