#include "studies/analysis/instances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "kernel/base/nearest.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;

struct FieldName {
  std::uint64_t bit;
  const char* name;
};

constexpr std::array<FieldName, 9> kFieldNames{{{kHasVelocity, "velocities"},
                                                {kHasSpin, "spins"},
                                                {kHasOmega, "the turning speed"},
                                                {kHasPhase, "the angle of the shell"},
                                                {kHasWallWork, "the work of the walls"},
                                                {kHasDissipation, "the dissipation"},
                                                {kHasAllBeads, "all beads"},
                                                {kHasLocations, "measured locations"},
                                                {kHasImpacts, "counts of impacts"}}};

/// A name and where it stands in the settings; no node: with its defaults.
struct Request {
  std::string name, kind;
  std::optional<config::Node> node;
  bool by_name = false;  ///< the user asked for it
};

std::string kind_of(const std::string& name, const config::Node& node) {
  if (!node.is_map()) node.fail("must hold the parameters of an analyzer: {} for its defaults");
  const auto kind = node.find("kind");
  return kind ? kind->text() : name;
}

std::vector<std::string> plugin_names(const host::Registry& registry) {
  std::vector<std::string> names;
  for (const host::Loaded& plugin : registry.loaded()) {
    if (plugin.kind() == Kind::analyzer) names.emplace_back(plugin.name());
  }
  return names;
}

std::vector<Request> requests(const config::Node& settings, bool chosen, const host::Registry& registry) {
  std::vector<Request> all;
  std::set<std::string> seen;
  if (const auto map = settings.find("analyzers")) {
    for (const std::string& name : map->keys()) {
      const config::Node node = map->at(name);
      all.push_back({name, kind_of(name, node), node, true});
      seen.insert(name);
    }
  }
  if (chosen) return all;
  for (const std::string& name : plugin_names(registry)) {
    if (seen.insert(name).second) all.push_back({name, name, std::nullopt, false});
  }
  return all;
}

/// Keeps what is named, by instance or plugin.
std::vector<Request> pick(std::vector<Request> all, const std::vector<std::string>& only) {
  if (only.empty()) return all;
  std::vector<Request> kept;
  std::vector<std::string> known;
  for (const Request& r : all) known.push_back(r.name);
  for (const std::string& name : only) {
    const std::size_t before = kept.size();
    for (const Request& r : all) {
      if (r.name != name && r.kind != name) continue;
      const bool twice = std::any_of(kept.begin(), kept.end(), [&](const Request& k) { return k.name == r.name; });
      if (twice) throw UserError(fmt::format("--analyzers names '{}' twice; name each once", r.name));
      kept.push_back(r);
      kept.back().by_name = true;
    }
    if (kept.size() == before)
      throw UserError(fmt::format("--analyzers: '{}' is no analyzer here; {}", name, base::suggestion(name, known)));
  }
  return kept;
}

AskedAnalyzer read(const Request& request, const host::Registry& registry) {
  AskedAnalyzer asked;
  asked.name = request.name;
  asked.by_name = request.by_name;
  if (request.node) asked.where = request.node->where();
  try {
    const host::Loaded& plugin = registry.find(Kind::analyzer, request.kind, asked.where);
    const config::Node empty = config::parse_document("{}", "the defaults of analyzer '" + request.name + "'");
    asked.plugin = &plugin;
    asked.values = config::resolve(*plugin.descriptor, request.node ? *request.node : empty, Scope::instance);
  } catch (const UserError& e) {
    if (request.by_name) throw;
    asked.refused = e.what();
  }
  return asked;
}

AnalyzerInstance create(const AskedAnalyzer& asked, const AnalyzerContext& context) {
  const std::uint64_t lacking = asked.plugin->table<AnalyzerTable>().needs & ~context.has;
  if (lacking != 0) {
    const std::string remedy = fmt::format("analyzer '{}' needs {}, which {} lacks; leave it out{}", asked.name, field_names(lacking),
                                           context.is_recording != 0 ? "a recording" : "this output",
                                           (lacking & kHasImpacts) != 0 && (context.has & kHasWallWork) != 0
                                               ? ", or run the case again with this version"  // other engines tell neither
                                               : "");
    if (asked.where.file.empty()) throw UserError(remedy);
    throw UserError(asked.where, remedy);
  }
  return {asked.name, host::AnalyzerObject::create(*asked.plugin, asked.values.view(), asked.where, context), asked.values};
}

}  // namespace

std::string field_names(std::uint64_t fields) {
  std::string text;
  for (const FieldName& field : kFieldNames) {
    if ((fields & field.bit) != 0) text += (text.empty() ? "" : ", ") + std::string(field.name);
  }
  return text;
}

std::vector<AskedAnalyzer> read_analyzers(const config::Node& settings, bool chosen_in_settings, const std::vector<std::string>& only,
                                          const host::Registry& registry) {
  std::vector<Request> wanted = pick(requests(settings, chosen_in_settings, registry), only);
  std::sort(wanted.begin(), wanted.end(), [](const Request& a, const Request& b) { return a.name < b.name; });
  std::vector<AskedAnalyzer> asked;
  for (const Request& request : wanted) asked.push_back(read(request, registry));
  return asked;
}

AnalyzerChoice create_analyzers(const std::vector<AskedAnalyzer>& asked, const AnalyzerContext& context) {
  AnalyzerChoice choice;
  for (const AskedAnalyzer& one : asked) {
    try {
      if (!one.refused.empty()) throw UserError(one.refused);
      choice.instances.push_back(create(one, context));
    } catch (const UserError& e) {
      if (one.by_name) throw;
      choice.left_out.push_back(fmt::format("{}: {}", one.name, e.what()));
    }
  }
  if (!choice.instances.empty()) return choice;
  std::string reasons;
  for (const std::string& reason : choice.left_out) reasons += " (" + reason + ")";
  throw UserError(fmt::format("no analyzer is left to run{}; 'millscope plugins' lists the analyzers, --plugin-dir adds some", reasons));
}

AnalyzerChoice choose_analyzers(const config::Node& settings, bool chosen_in_settings, const std::vector<std::string>& only,
                                const host::Registry& registry, const AnalyzerContext& context) {
  return create_analyzers(read_analyzers(settings, chosen_in_settings, only, registry), context);
}

}  // namespace millscope::analysis
