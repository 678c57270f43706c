#include "studies/analysis/tracks_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "kernel/output/track_reader.hpp"
#include "studies/analysis/trajectory_source.hpp"

namespace millscope::studies {
namespace {

namespace fs = std::filesystem;
using base::UserError;

/// Indices of the tracks that are asked for.
std::vector<std::size_t> pick(const output::TrackReader& reader, const std::vector<std::string>& tracers) {
  const std::vector<output::TrackInfo>& tracks = reader.tracks();
  std::set<std::size_t> picked;
  const bool all = tracers.empty() || std::find(tracers.begin(), tracers.end(), "all") != tracers.end();
  for (std::size_t i = 0; all && i < tracks.size(); ++i) picked.insert(i);
  for (const std::string& tracer : tracers) {
    if (tracer == "all") continue;
    std::uint32_t id = 0;
    const auto [end, error] = std::from_chars(tracer.data(), tracer.data() + tracer.size(), id);
    const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const output::TrackInfo& t) { return t.bead == id; });
    if (error == std::errc() && end == tracer.data() + tracer.size() && found != tracks.end()) {
      picked.insert(static_cast<std::size_t>(found - tracks.begin()));
      continue;
    }
    std::string known;
    for (std::size_t i = 0; i < std::min<std::size_t>(tracks.size(), 12); ++i)
      known += (i > 0 ? ", " : "") + fmt::format("{}", tracks[i].bead);
    throw UserError(fmt::format("--tracer {}: {} follows no such bead; it has {}{}, or give 'all'", tracer, reader.path().string(), known,
                                tracks.size() > 12 ? ", …" : ""));
  }
  return {picked.begin(), picked.end()};
}

void wrap(std::vector<double>& z, double low, double period) {
  for (double& value : z) value -= period * std::floor((value - low) / period);
}

Run run_of(const output::TrackReader& reader, std::size_t track, const SourceRequest& request, double period) {
  output::TrackSamples samples = reader.read(track);
  Run run;
  run.name = reader.tracks()[track].name;
  run.source = reader.path().string();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if ((request.from && samples.time[i] < *request.from - 1e-9) || (request.to && samples.time[i] > *request.to + 1e-9)) continue;
    run.time.push_back(samples.time[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) run.position[axis].push_back(samples.position[axis][i]);
  }
  if (run.size() < 8) {
    throw UserError(fmt::format("{}: track '{}' has {} samples in the span asked for, at least 8 are needed; run longer, or widen the span",
                                run.source, run.name, run.size()));
  }
  if (period > 0) output::unwrap(run.position[2], period);
  run.report.rows = run.report.used = run.size();
  return run;
}

/// Exact positions need no smoothing; the even step is no finer than theirs.
TrajectoryOptions options_for(const Run& run, const SourceRequest& request) {
  TrajectoryOptions options = request.trajectory;
  const double interval = (run.time.back() - run.time.front()) / static_cast<double>(run.size() - 1);
  if (!request.trajectory_given) {
    options.kind = SplineKind::cubic;
    options.noise.fill(1e-9);  // what a double leaves of a position
    options.noise_correlation = 0;
    options.step = std::max(options.step, interval);
  }
  options.gap_limit = std::max(options.gap_limit, 5 * interval);
  return options;
}

}  // namespace

ShellMotion shell_motion(const dem::Motion& motion) {
  if (motion.speed == 0) return {};
  const double sense = motion.axis[2] < 0 ? -1.0 : 1.0;
  return {[motion, sense](double t) { return sense * dem::angular_speed(motion, t); },
          [motion, sense](double t) { return sense * dem::pose_at(motion, t).angle; }};
}

OpenedSource open_tracks(const SourceRequest& request, MillOfCase mill) {
  const fs::path file = request.path / "tracks.h5";
  const output::TrackReader reader(file);
  if (mill.period > 0 && request.trajectory.high > request.trajectory.low) {
    throw UserError(
        fmt::format("{}: the mill is periodic along z and has no end faces; leave trajectory.low and trajectory.high out", file.string()));
  }
  OpenedSource opened;
  std::vector<Trajectory> trajectories;
  double seconds = 0;
  for (const std::size_t track : pick(reader, request.tracers)) {
    const output::TrackInfo& info = reader.tracks()[track];
    const Run run = run_of(reader, track, request, mill.period);
    Trajectory t = fit_trajectory(run, options_for(run, request));
    t.id = info.bead;
    t.diameter = info.diameter;
    t.density = info.density;
    if (mill.period > 0) {
      for (Piece& piece : t.pieces) wrap(piece.position[2], mill.context.mill_low, mill.period);
      wrap(t.location_position[2], mill.context.mill_low, mill.period);
    }
    seconds += t.covered;
    trajectories.push_back(std::move(t));
  }
  const std::string description = fmt::format("{}: {} bead{} followed, {:.6g} s in all", file.string(), trajectories.size(),
                                              trajectories.size() == 1 ? "" : "s", seconds);
  opened.source = std::make_unique<TrajectorySource>(std::move(trajectories), mill.context, shell_motion(mill.motion),
                                                     !request.trajectory_given, description);
  opened.meta.source = "tracks";
  opened.meta.inputs.push_back({file.string(), file_hash(file)});
  return opened;
}

}  // namespace millscope::studies
