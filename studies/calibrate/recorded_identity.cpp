#include "studies/calibrate/recorded_identity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/hash.hpp"
#include "kernel/base/program.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/case.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/campaign/identity.hpp"

namespace millscope::calibrate {

const std::string& observing_program() {
  static const std::string program = [] {
    std::vector<std::string> folders = base::simulating_folders();
    folders.insert(folders.end(), base::observing_folders().begin(), base::observing_folders().end());
    std::string text;
    for (const auto& [part, value] : base::program_parts(folders)) text += part + "\n" + value + "\n";
    return text;
  }();
  return program;
}

std::string content_of_base(const Processing& how, std::size_t condition) {
  return campaign::content_of(config::read_case(how.study.base.string(), how.study.conditions[condition].settings), how.registry);
}

std::string identity_of(const recording::Recording& recording, const Processing& how, std::size_t condition) {
  const Study& study = how.study;
  std::vector<std::string> parts{observing_program(), std::to_string(study.observing.draws), std::to_string(study.observing.beads),
                                 study.observing.camera};
  for (const UsedAnalyzer& a : kUsedAnalyzers) parts.push_back(fmt::format("{}: {}", a.plugin, a.parameters));
  if (study.observing.camera_is_file()) parts.push_back(base::text_of(study.observing.camera));
  if (study.observing.z_low) parts.push_back(fmt::format("{:.17g} {:.17g}", *study.observing.z_low, *study.observing.z_high));
  parts.push_back(content_of_base(how, condition) + analysis::file_hash(recording.file));
  if (const auto& geometry = recording.condition.geometry; !geometry.empty())
    parts.push_back(campaign::content_of(config::read_case(geometry.string()), how.registry));
  for (const recording::Run& run : recording.runs) parts.push_back(run.name + analysis::file_hash(run.source));
  for (const ObservableKind kind : study.objective.without) parts.push_back(fmt::format("without {}", name_of(kind)));
  for (const Term& term : study.objective.terms) parts.push_back(term.name());
  if (!how.own_analyzers.empty()) parts.push_back(how.own_analyzers);
  // A plugin that is not asked changes nothing; a study with analyzers of its own may ask any.
  const bool may_ask_any = !study.objective.terms.empty() || !how.own_analyzers.empty();
  for (const host::PluginRecord& r : how.registry.records()) {
    const bool asked =
        may_ask_any || std::any_of(kUsedAnalyzers.begin(), kUsedAnalyzers.end(), [&](const UsedAnalyzer& a) { return a.plugin == r.name; });
    if (r.kind == "observation" || (r.kind == "analyzer" && asked)) parts.push_back(r.name + r.code_hash);
  }
  return hash_of(parts);
}

std::string hash_of(const std::vector<std::string>& texts) {
  base::Hash hash;
  for (const std::string& text : texts) hash.add(text).add("\xff");
  return hash.text();
}

std::string dump(const config::Node& node) {
  if (node.is_null()) return "~";
  if (node.is_scalar()) return node.text();
  std::string out = "{";
  if (node.is_sequence()) {
    for (const config::Node& item : node.items()) out += dump(item) + ",";
    return out + "}";
  }
  for (const std::string& key : node.keys()) out += key + ":" + dump(node.at(key)) + ",";
  return out + "}";
}

}  // namespace millscope::calibrate
