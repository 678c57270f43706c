#include "studies/analysis/tracks_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "kernel/output/track_reader.hpp"
#include "studies/analysis/follow.hpp"

namespace millscope::analysis {
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
      picked.insert(found - tracks.begin());
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

recording::Run run_of(const output::TrackReader& reader, std::size_t track, const SourceRequest& request, double period) {
  output::TrackSamples samples = reader.read(track);
  recording::Run run;
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
trajectory::TrajectoryOptions options_for(const recording::Run& run, const SourceRequest& request) {
  trajectory::TrajectoryOptions options = request.trajectory;
  const double interval = (run.time.back() - run.time.front()) / static_cast<double>(run.size() - 1);
  if (!request.trajectory_given) {
    options.kind = trajectory::SplineKind::cubic;
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
  const std::vector<std::size_t> tracks = pick(reader, request.tracers);
  std::vector<recording::Run> runs;
  for (const std::size_t track : tracks) runs.push_back(run_of(reader, track, request, mill.period));
  std::vector<BeadRun> beads;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const output::TrackInfo& info = reader.tracks()[tracks[i]];
    beads.push_back({&runs[i], options_for(runs[i], request), info.diameter, info.density, info.bead});
  }
  Followed followed = follow(beads, {.of = file.string(),
                                     .one = "bead followed",
                                     .many = "beads followed",
                                     .mill = mill.context,
                                     .motion = shell_motion(mill.motion),
                                     .period = mill.period,
                                     .exact = !request.trajectory_given,
                                     .named = !request.tracers.empty(),
                                     .threads = request.threads});
  opened.source = std::move(followed.source);
  opened.meta.notes = std::move(followed.notes);
  opened.meta.source = "tracks";
  opened.meta.inputs.push_back({file.string(), file_hash(file)});
  return opened;
}

}  // namespace millscope::analysis
