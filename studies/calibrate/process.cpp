// Tracks → spline → analyzers → results.
#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "kernel/base/parallel.hpp"
#include "studies/analysis/engine.hpp"
#include "studies/analysis/trajectory_source.hpp"
#include "studies/calibrate/recorded.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;
using studies::AnalyzerInstance;

/// The analyzers of this room, and those of the study's own section `analyzers`.
std::vector<AnalyzerInstance> instances(const Processing& how, const AnalyzerContext& context) {
  const config::Node own = config::parse_document(how.analyzers.empty() ? kAnalyzers : how.analyzers, "calibrate");
  std::vector<AnalyzerInstance> all = studies::choose_analyzers(own, true, {}, how.registry, context).instances;
  if (!how.analyzers.empty()) return all;
  // Reading marks the keys that were read: several simulations may be looked at at once.
  static std::mutex reading;
  const std::lock_guard<std::mutex> hold(reading);
  const auto section = how.study.root.valid() ? how.study.root.find("analyzers") : std::nullopt;
  if (!section) return all;
  for (AnalyzerInstance& more : studies::choose_analyzers(how.study.root, true, {}, how.registry, context).instances) {
    for (const AnalyzerInstance& known : all) {
      if (known.name == more.name)
        section->fail(fmt::format("'{}' is the name of an analyzer that calibrate uses itself; give yours another, with 'kind: {}'",
                                  more.name, more.name));
    }
    all.push_back(std::move(more));
  }
  return all;
}

struct Fitted {
  std::vector<studies::Trajectory> trajectories;
  std::size_t left_out = 0;
};

Fitted fit(const studies::Recording& recording, const studies::TrajectoryOptions& options, int threads) {
  std::vector<std::optional<studies::Trajectory>> fitted(recording.runs.size());
  base::for_each_item(recording.runs.size(), base::worker_count(threads, recording.runs.size()), [&](std::size_t i, std::size_t) {
    const studies::Run& run = recording.runs[i];
    if (run.size() < static_cast<std::size_t>(options.least_points)) return;
    try {
      fitted[i] = studies::fit_trajectory(run, options);
    } catch (const UserError&) {
      return;  // nothing is left between its gaps; counted below
    }
    const studies::Condition& c = recording.condition;
    fitted[i]->diameter = c.tracer.diameter.value_or(c.bead_diameter.value_or(0));
    fitted[i]->density = c.tracer.density.value_or(c.bead_density.value_or(0));
  });
  Fitted all;
  for (auto& trajectory : fitted) {
    if (!trajectory) {
      ++all.left_out;
      continue;
    }
    trajectory->id = static_cast<std::int64_t>(all.trajectories.size());
    all.trajectories.push_back(std::move(*trajectory));
  }
  return all;
}

}  // namespace

studies::ResultSet process(const studies::Recording& recording, const studies::TrajectoryOptions& options, const Processing& how) {
  std::optional<studies::MillOfCase> mill;
  if (!recording.condition.geometry.empty()) mill = studies::read_mill_of_case(recording.condition.geometry, how.registry);
  return process_in(studies::know_mill(recording, mill), recording, options, how);
}

studies::ResultSet process_in(const studies::RecordedMill& known, const studies::Recording& recording,
                              const studies::TrajectoryOptions& wished, const Processing& how) {
  studies::TrajectoryOptions options = wished;
  options.axis = known.axis;
  Fitted fitted = fit(recording, options, how.threads);
  if (fitted.trajectories.empty()) throw UserError(fmt::format("{}: no track is long enough to be followed", recording.file.string()));
  double seconds = 0;
  for (const studies::Trajectory& t : fitted.trajectories) seconds += t.covered;
  studies::ShellMotion motion;
  if (known.context.omega != 0) motion.omega = [omega = known.context.omega](double) { return omega; };
  const std::string description =
      fmt::format("{}: {} tracks, {:.6g} s covered", recording.file.string(), fitted.trajectories.size(), seconds);
  studies::TrajectorySource source(std::move(fitted.trajectories), known.context, std::move(motion), false, description);
  studies::EngineOptions engine;
  engine.draws = static_cast<std::size_t>(how.study.observing.draws);
  engine.threads = how.threads;
  studies::ResultSet results = studies::run_analyzers(source, instances(how, source.context()), engine);
  results.meta.context = source.context();
  results.meta.description = description;
  results.meta.notes.insert(results.meta.notes.begin(), known.notes.begin(), known.notes.end());
  if (fitted.left_out > 0)
    results.meta.notes.push_back(
        fmt::format("{} of {} tracks are too short or broken and are left out", fitted.left_out, recording.runs.size()));
  return results;
}

}  // namespace millscope::calibrate
