#include "studies/analysis/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/config/units.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/summary.hpp"

namespace millscope::analysis {
namespace {

using Json = nlohmann::ordered_json;

config::Node load_settings(const AnalysisRequest& request) {
  const config::Node settings = request.settings.empty() ? config::parse_document("{}", "--set", request.overrides)
                                                         : config::load_document(request.settings.string(), request.overrides);
  settings.expect({"schema_version", "analyzers", "resampling", "trajectory", "from", "to"});
  if (const auto version = settings.find("schema_version")) {
    if (config::read_integer(*version, config::between(1, 1e9)) != 1) version->fail("is not 1; this millscope reads version 1");
  }
  return settings;
}

/// Whether the file itself, and not only --set, says which analyzers there are.
bool chooses_analyzers(const AnalysisRequest& request) {
  return !request.settings.empty() && config::load_document(request.settings.string()).has("analyzers");
}

std::optional<double> seconds(const config::Node& settings, const char* key) {
  const auto node = settings.find(key);
  return node ? std::optional<double>(config::read_number(*node, "s")) : std::nullopt;
}

SourceRequest source_request(const AnalysisRequest& request, const config::Node& settings) {
  SourceRequest source;
  source.path = output::without_end_slash(request.path);
  source.tracers = request.tracers;
  source.threads = request.threads;
  source.from = request.from ? request.from : seconds(settings, "from");
  source.to = request.to ? request.to : seconds(settings, "to");
  source.trajectory.gap_limit = 0;
  if (const auto section = settings.find("trajectory")) {
    source.trajectory = read_trajectory_options(*section);
    source.trajectory_given = true;
  }
  return source;
}

EngineOptions engine_options(const AnalysisRequest& request, const config::Node& settings) {
  EngineOptions options;
  options.threads = request.threads;
  options.progress = request.progress;
  if (const auto section = settings.find("resampling")) {
    section->expect({"draws", "seed", "block"});
    if (const auto node = section->find("draws")) {
      options.draws = config::read_integer(*node, config::between(20, 10000, "fewer give no stable error"));
    }
    if (const auto node = section->find("seed"))
      options.seed = static_cast<std::uint64_t>(config::read_integer(*node, config::not_negative()));
    if (const auto node = section->find("block")) options.block = config::read_number(*node, "s", config::positive());
  }
  return options;
}

Json value_json(const Parameter& parameter, const Value& value) {
  if (value.given == 0) return nullptr;
  switch (parameter.type) {
    case ValueType::number:
      return value.number[0];
    case ValueType::integer:
      return static_cast<std::int64_t>(value.number[0]);
    case ValueType::boolean:
      return value.number[0] != 0;
    case ValueType::vector:
      return Json{value.number[0], value.number[1], value.number[2]};
    default:
      return value.text;
  }
}

Json options_json(const std::vector<AnalyzerInstance>& instances) {
  Json all = Json::object();
  for (const AnalyzerInstance& instance : instances) {
    const Descriptor& d = *instance.object.plugin().descriptor;
    Json options{{"kind", d.name}};
    const Values values = instance.values.view();
    for (std::uint64_t p = 0; p < d.parameter_count; ++p) {
      const auto found = std::find_if(values.items, values.items + values.count,
                                      [&](const Value& v) { return std::string_view(v.name) == d.parameters[p].name; });
      if (found != values.items + values.count) options[d.parameters[p].name] = value_json(d.parameters[p], *found);
    }
    all[instance.name] = options;
  }
  return all;
}

/// The libraries of the analyzers that ran.
std::vector<output::PluginRecord> used_plugins(const host::Registry& registry, const std::vector<AnalyzerInstance>& instances) {
  std::vector<output::PluginRecord> used;
  for (const host::PluginRecord& r : registry.records()) {
    const bool runs = r.kind == host::text(Kind::analyzer) &&
                      std::any_of(instances.begin(), instances.end(), [&](const AnalyzerInstance& i) { return i.object.name() == r.name; });
    if (runs) used.push_back({r.name, r.version, r.path, r.file_hash, r.code_hash});
  }
  return used;
}

}  // namespace

AnalysisRequest request_of_means(const std::filesystem::path& path, std::vector<std::string> only) {
  AnalysisRequest request;
  request.path = path;
  request.only = std::move(only);
  request.overrides = {"resampling.draws=20"};
  return request;
}

ResultSet analyze(const AnalysisRequest& request, const host::Registry& registry) {
  const config::Node settings = load_settings(request);
  const SourceRequest source = source_request(request, settings);
  const EngineOptions options = engine_options(request, settings);
  OpenedSource opened = open_source(source, registry);
  const AnalyzerChoice choice = choose_analyzers(settings, chooses_analyzers(request), request.only, registry, opened.source->context());
  settings.finish();
  ResultSet results = run_analyzers(*opened.source, choice.instances, options);
  ResultMeta& meta = results.meta;
  meta.source = opened.meta.source;
  meta.name = opened.meta.name;
  meta.description = opened.meta.description;
  meta.case_file = opened.meta.case_file;
  meta.inputs = opened.meta.inputs;
  meta.runs = opened.meta.runs;
  if (!request.settings.empty()) meta.inputs.push_back({request.settings.string(), file_hash(request.settings)});
  meta.notes.insert(meta.notes.begin(), opened.meta.notes.begin(), opened.meta.notes.end());
  meta.left_out = choice.left_out;
  meta.provenance = output::provenance(request.command_line, used_plugins(registry, choice.instances));
  meta.provenance["analyzers"] = options_json(choice.instances);
  return results;
}

}  // namespace millscope::analysis
