#include "studies/calibrate/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/frame_reader.hpp"
#include "studies/analysis/engine.hpp"
#include "studies/analysis/frames_source.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/calibrate/recorded_identity.hpp"
#include "studies/calibrate/silhouette.hpp"
#include "studies/calibrate/velocity_profile.hpp"
#include "studies/recording/description.hpp"

namespace millscope::calibrate {
namespace {

namespace fs = std::filesystem;
using config::Node;

constexpr double kAsStated = 1e4;  // blocks behind errors that are stated, not estimated

template <class Kind>
std::unique_ptr<Figure> read_as(const Node& section) {
  return std::make_unique<Kind>(Kind::read(section));
}

struct FigureKind {
  const char* section;
  std::unique_ptr<Figure> (*read)(const Node&);
};
constexpr std::array kKinds{FigureKind{"profile", read_as<VelocityProfile>}, FigureKind{"silhouette", read_as<Silhouette>},
                            FigureKind{"surface_angle", read_as<SurfaceAngle>}};

std::string identity(const Figure& figure, const Processing& how, std::size_t condition) {
  const Condition& c = how.study.conditions[condition];
  std::vector<std::string> parts{observing_program(), std::to_string(how.study.observing.draws), content_of_base(how, condition),
                                 analysis::file_hash(c.recording)};
  for (const fs::path& file : figure.files) parts.push_back(analysis::file_hash(file));
  for (const host::PluginRecord& r : how.registry.records()) {
    if (r.kind == "analyzer") parts.push_back(r.name + r.code_hash);
  }
  return hash_of(parts);
}

}  // namespace

std::unique_ptr<const Figure> read_figure(const fs::path& recording) {
  const std::string ending = recording.extension().string();
  if (ending != ".yaml" && ending != ".yml") return nullptr;
  const Node root = config::load_document(recording.string());
  for (const FigureKind& kind : kKinds) {
    if (!root.has(kind.section)) continue;
    root.expect({kind.section, "condition"});
    std::unique_ptr<Figure> figure = kind.read(root.at(kind.section));
    if (const auto node = root.find("condition")) figure->condition = recording::read_condition(*node);
    root.finish();
    return figure;
  }
  return nullptr;
}

RecordedCondition look_at_figure(const Figure& figure, std::size_t condition, const Processing& how) {
  const Condition& c = how.study.conditions[condition];
  const analysis::MillOfCase mill = analysis::read_mill_of_case(how.study.base, how.registry, c.settings);
  if (!(mill.context.mill_radius > 0) || mill.context.omega == 0)
    throw base::UserError(
        c.where, fmt::format("condition '{}': {} is compared in a mill that turns, with a shell of known radius; {} has none: give its "
                             "'mill' a diameter and a speed",
                             c.name, figure.what(), how.study.base.string()));
  RecordedCondition r;
  r.omega = mill.context.omega;
  r.identity = identity(figure, how, condition);
  figure.measure({how.study, c, mill}, r);
  r.analyzers = fmt::format("analyzers:\n  {}: {}\n{}", kDistributions.plugin, kDistributions.parameters, r.analyzers);
  Observation& o = r.observation;
  for (const Summary& summary : r.summaries) o.observables.push_back(summary.observable);
  o.blocks = kAsStated;
  o.power = {std::numeric_limits<double>::quiet_NaN(), 0, std::string(figure.what()) + " tells no power"};
  if (figure.condition.power || !how.study.objective.terms.empty())
    o.notes.push_back(fmt::format("{} alone is compared: a measured power and terms of the objective are left out", figure.what()));
  return r;
}

analysis::ResultSet figure_of_run(const fs::path& run, const RecordedCondition& recorded, const Processing& how) {
  const fs::path case_file = run / output::kResolvedCase;
  const analysis::MillOfCase mill = analysis::read_mill_of_case(case_file, how.registry);
  analysis::FramesSource source(output::FrameReader(run / "frames.h5"), mill.context,
                                config::read_case(case_file.string()).time.analyze_from, std::nullopt);
  analysis::EngineOptions engine;
  engine.draws = how.study.observing.draws;
  engine.threads = 1;  // several runs are looked at at once
  engine.uncertain = [&](const std::string& analyzer, const std::string& result) {
    const auto is_read = [&](const Summary& s) { return s.analyzer == analyzer && (s.result == result || s.weight == result); };
    return becomes_summary(analyzer, result, {}) || std::any_of(recorded.summaries.begin(), recorded.summaries.end(), is_read);
  };
  const std::vector<analysis::AskedAnalyzer> analyzers = analyzers_of(recorded.analyzers, how.registry);
  analysis::ResultSet results = analysis::run_analyzers(source, analysis::create_analyzers(analyzers, source.context()).instances, engine);
  results.meta.context = source.context();
  results.meta.description = run.string();
  return results;
}

}  // namespace millscope::calibrate
