#include "studies/calibrate/processing.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/analysis/engine.hpp"
#include "studies/analysis/follow.hpp"
#include "studies/calibrate/summaries.hpp"
#include "studies/recording/travel.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::calibrate {
namespace {

constexpr double kEvenStep = 0.004;  // s between the even times: recordings have a location every 5 ms

std::string used_analyzers(const Study& study) {
  const auto& terms = study.objective.terms;
  const bool of_power = std::any_of(terms.begin(), terms.end(), [](const Term& t) { return t.analyzer == kPower.plugin; });
  std::string text = "analyzers:\n";
  for (const UsedAnalyzer& used : kUsedAnalyzers) {
    const UsedAnalyzer& a = of_power && used.plugin == kPower.plugin ? kPowerOfTerms : used;
    text += fmt::format("  {}: {}\n", a.plugin, a.parameters);
  }
  return text;
}

}  // namespace

Smoothing smoothing_of(const recording::Recording& recording) {
  const trajectory::NoiseEstimate noise = trajectory::estimate_noise_model(recording.runs, recording.gap_limit);
  const bool cleaned = recording.travel.speed > 0;
  const recording::Travel travel = cleaned ? recording.travel : recording::measure_travel(recording.runs, recording.gap_limit);
  Smoothing smoothing{noise.standard_deviation, noise.correlation, {}, recording.gap_limit, travel, {}};
  smoothing.roughness = trajectory::estimate_roughness(recording.runs, trajectory_options(Side::recorded, smoothing, {}));
  return smoothing;
}

trajectory::TrajectoryOptions trajectory_options(Side side, const Smoothing& smoothing, const Observing& observing) {
  trajectory::TrajectoryOptions options;
  options.step = kEvenStep;
  options.gap_limit = smoothing.gap_limit;
  options.noise = smoothing.noise;
  options.noise_correlation = smoothing.noise_correlation;
  options.roughness = smoothing.roughness;
  options.travel = smoothing.travel;
  if (side == Side::simulated && observing.camera == "exact") options.noise = {}, options.noise_correlation.reset(), options.roughness = {};
  if (side == Side::recorded && observing.z_low) options.low = *observing.z_low, options.high = *observing.z_high;
  return options;
}

analysis::ResultSet process(const Tracks& tracks, const Smoothing& smoothing, const Processing& how) {
  trajectory::TrajectoryOptions options = trajectory_options(tracks.side, smoothing, how.study.observing);
  options.axis = tracks.mill.axis;
  const analysis::Followed followed =
      analysis::follow(analysis::tracer_runs(tracks.recording, options), {.of = tracks.recording.file.string(),
                                                                          .one = "track",
                                                                          .many = "tracks",
                                                                          .mill = tracks.mill.context,
                                                                          .motion = analysis::even_motion(tracks.mill.context.omega),
                                                                          .threads = how.threads});
  analysis::FrameSource& source = *followed.source;
  analysis::EngineOptions engine;
  engine.draws = how.study.observing.draws;
  if (tracks.side == Side::simulated) engine.known = smoothing.blocks;
  engine.threads = how.threads;
  if (!how.all_uncertain)
    engine.uncertain = [&](const std::string& analyzer, const std::string& result) {
      return becomes_summary(analyzer, result, how.study.objective.terms);
    };
  analysis::ResultSet results =
      analysis::run_analyzers(source, analysis::create_analyzers(how.analyzers, source.context()).instances, engine);
  results.meta.context = source.context();
  results.meta.description = source.description();
  std::vector<std::string>& notes = results.meta.notes;
  notes.insert(notes.begin(), tracks.mill.notes.begin(), tracks.mill.notes.end());
  notes.insert(notes.end(), followed.notes.begin(), followed.notes.end());
  return results;
}

std::vector<analysis::AskedAnalyzer> analyzers_of(const std::string& text, const host::Registry& registry) {
  return analysis::read_analyzers(config::parse_document(text, "calibrate"), true, {}, registry);
}

std::vector<analysis::AskedAnalyzer> analyzers_of(const Study& study, const host::Registry& registry) {
  std::vector<analysis::AskedAnalyzer> all = analyzers_of(used_analyzers(study), registry);
  const auto section = study.root.valid() ? study.root.find("analyzers") : std::nullopt;
  if (!section) return all;
  for (analysis::AskedAnalyzer& more : analysis::read_analyzers(study.root, true, {}, registry)) {
    if (std::any_of(all.begin(), all.end(), [&](const analysis::AskedAnalyzer& known) { return known.name == more.name; }))
      section->fail(fmt::format("'{}' is the name of an analyzer that calibrate uses itself; give yours another, with 'kind: {}'",
                                more.name, more.name));
    all.push_back(std::move(more));
  }
  return all;
}

}  // namespace millscope::calibrate
