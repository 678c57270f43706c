#include "studies/analysis/recording_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "studies/analysis/mill.hpp"
#include "studies/analysis/trajectory_source.hpp"

namespace millscope::studies {
namespace {

namespace fs = std::filesystem;
using config::UserError;

/// What recording.yaml says of the mill; 0 where it says nothing.
AnalyzerContext context_of(const Condition& c, const std::optional<MillFrame>& frame, const std::optional<MillOfCase>& mill) {
  AnalyzerContext context{};
  context.is_recording = 1;
  context.gravity = 9.81;
  if (mill) {
    context.mill_radius = mill->context.mill_radius;
    context.mill_low = mill->context.mill_low;
    context.mill_high = mill->context.mill_high;
  }
  if (c.mill_diameter) context.mill_radius = 0.5 * *c.mill_diameter;
  if (c.mill_length) {
    context.mill_low = 0;
    context.mill_high = *c.mill_length;
  }
  if (frame && frame->high > frame->low) {
    context.mill_low = frame->low;
    context.mill_high = frame->high;
  }
  context.omega = c.angular_velocity.value_or(0);
  const double diameter = c.bead_diameter.value_or(c.tracer.diameter.value_or(0));
  context.bead_radius = 0.5 * diameter;
  context.bead_density = c.bead_density.value_or(c.tracer.density.value_or(0));
  context.filling = c.filling.value_or(0);
  context.porosity = c.porosity.value_or(0);
  const double length = context.mill_high - context.mill_low;
  if (c.filling && c.porosity && context.mill_radius > 0 && length > 0 && context.bead_density > 0) {
    // M = (1 − φ) J V ρ (Chagas 2015, Eq. 4.1), V of the bare shell
    const double volume = std::numbers::pi * context.mill_radius * context.mill_radius * length;
    const double solids = (1 - *c.porosity) * *c.filling * volume;
    context.charge_mass = solids * context.bead_density;
    if (diameter > 0) context.charge_count = solids / (std::numbers::pi / 6 * diameter * diameter * diameter);
  }
  return context;
}

Run cut_to(const Run& run, const SourceRequest& request) {
  if (!request.from && !request.to) return run;
  Run part = run;
  const auto first = request.from ? std::lower_bound(run.time.begin(), run.time.end(), *request.from) : run.time.begin();
  const auto last = request.to ? std::upper_bound(run.time.begin(), run.time.end(), *request.to) : run.time.end();
  const auto cut = [&](auto& values) {
    if (values.empty()) return;
    const auto begin = values.begin();
    values = {begin + (first - run.time.begin()), begin + std::max(last - run.time.begin(), first - run.time.begin())};
  };
  for (auto& axis : part.position) cut(axis);
  cut(part.spread);
  cut(part.events);
  cut(part.time);
  return part;
}

}  // namespace

OpenedSource open_recording(const SourceRequest& request, const host::Registry& registry) {
  const Recording recording = read_recording(request.path);
  const Condition& condition = recording.condition;
  OpenedSource opened;
  std::optional<MillOfCase> mill;
  if (!condition.geometry.empty()) {
    mill = read_mill_of_case(condition.geometry, registry);
    opened.meta.case_file = fs::absolute(condition.geometry).lexically_normal().string();
  }
  if (!recording.frame) {
    throw UserError(fmt::format("{}: the mill's axis is not given; write it into recording.yaml as 'frame: {{axis: [x, y, mm]}}'",
                                request.path.string()));
  }
  TrajectoryOptions options = request.trajectory;
  options.axis = recording.frame->axis;
  if (!(options.gap_limit > 0)) options.gap_limit = recording.gap_limit;
  std::vector<Trajectory> trajectories;
  double seconds = 0;
  std::uint64_t points = 0;
  for (const Run& whole : recording.runs) {
    const Run run = cut_to(whole, request);
    if (run.size() < static_cast<std::size_t>(options.least_points)) {
      opened.meta.notes.push_back(fmt::format("{}: {} points in the span asked for are too few; it is left out", whole.source, run.size()));
      continue;
    }
    Trajectory t = fit_trajectory(run, options);
    t.id = static_cast<std::int64_t>(trajectories.size());
    t.diameter = condition.tracer.diameter.value_or(condition.bead_diameter.value_or(0));
    t.density = condition.tracer.density.value_or(condition.bead_density.value_or(0));
    seconds += t.covered;
    points += run.size();
    if (t.points_left_out > 0) {
      opened.meta.notes.push_back(fmt::format("{}: {} points stand in stretches of fewer than {} and are left out", run.source,
                                              t.points_left_out, options.least_points));
    }
    opened.meta.inputs.push_back({run.source, file_hash(run.source)});
    trajectories.push_back(std::move(t));
  }
  if (trajectories.empty())
    throw UserError(fmt::format("{}: no run has enough points in the span asked for; widen --from and --to", request.path.string()));
  const AnalyzerContext context = context_of(condition, recording.frame, mill);
  ShellMotion motion;
  if (context.omega != 0) motion.omega = [omega = context.omega](double) { return omega; };
  const std::string description = fmt::format("{}: {} run{}, {} points, {:.6g} s covered", request.path.string(), trajectories.size(),
                                              trajectories.size() == 1 ? "" : "s", points, seconds);
  opened.source = std::make_unique<TrajectorySource>(std::move(trajectories), context, std::move(motion), false, description);
  opened.meta.source = "recording";
  opened.meta.name = fs::path(request.path).stem().string();
  opened.meta.inputs.push_back({request.path.string(), file_hash(request.path)});
  return opened;
}

}  // namespace millscope::studies
