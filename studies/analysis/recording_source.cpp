#include "studies/analysis/recording_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/analysis/recorded_mill.hpp"
#include "studies/analysis/trajectory_source.hpp"

namespace millscope::studies {
namespace {

namespace fs = std::filesystem;
using base::UserError;

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

using Json = nlohmann::ordered_json;

/// What of a file is used, and by which rules the rest was set aside.
Json run_json(const Run& run) {
  const RunReport& r = run.report;
  return {{"name", run.name},
          {"file", run.source},
          {"format", run.format},
          {"rows", r.rows},
          {"used", r.used},
          {"rows_set_aside",
           {{"unreadable", r.unreadable},
            {"not_finite", r.not_finite},
            {"false_times", r.false_times},
            {"duplicates", r.duplicates},
            {"outside", r.outside},
            {"outliers", r.outliers}}},
          {"rows_out_of_order", r.backwards},
          {"gaps", r.gaps},
          {"gap_time_s", r.gap_time}};
}

/// One note for a run of which rows were set aside or out of order; none else.
std::vector<std::string> row_notes(const Recording& recording) {
  std::vector<std::string> notes;
  std::string format;
  for (const Run& run : recording.runs) {
    if (run.format != format) notes.push_back(fmt::format("{}{} read as {}", run.name, format.empty() ? "" : " and on", run.format));
    format = run.format;
  }
  for (const Run& run : recording.runs) {
    const RunReport& r = run.report;
    std::string counts;
    const auto add = [&](std::uint64_t count, const char* words) {
      if (count > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, words);
    };
    add(r.unreadable, "unreadable");
    add(r.not_finite, "not finite");
    add(r.false_times, "with false times");
    add(r.duplicates, "with the time of another");
    add(r.outside, "outside the mill");
    add(r.outliers, "outliers");
    if (!counts.empty()) counts = fmt::format("{} of {} rows are used; set aside: {}", r.used, r.rows, counts);
    if (r.backwards > 0) counts += fmt::format("{}{} rows out of order were sorted in", counts.empty() ? "" : "; ", r.backwards);
    if (!counts.empty()) notes.push_back(fmt::format("{}: {}", run.name, counts));
  }
  return notes;
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
  const RecordedMill known = know_mill(recording, mill);
  opened.meta.notes = known.notes;
  for (std::string& note : row_notes(recording)) opened.meta.notes.push_back(std::move(note));
  for (const Run& run : recording.runs) opened.meta.runs.push_back(run_json(run));
  TrajectoryOptions options = request.trajectory;
  options.axis = known.axis;
  if (!(options.gap_limit > 0)) options.gap_limit = recording.gap_limit;
  std::vector<Trajectory> trajectories;
  double seconds = 0;
  std::uint64_t points = 0, left_out = 0;
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
    left_out += t.points_left_out;
    opened.meta.inputs.push_back({run.source, file_hash(run.source)});
    trajectories.push_back(std::move(t));
  }
  if (trajectories.empty())
    throw UserError(fmt::format("{}: no run has enough points in the span asked for; widen --from and --to", request.path.string()));
  if (left_out > 0) {
    opened.meta.notes.push_back(
        fmt::format("{} of {} points stand in stretches of fewer than {} and are left out", left_out, points, options.least_points));
  }
  ShellMotion motion;
  if (known.context.omega != 0) motion.omega = [omega = known.context.omega](double) { return omega; };
  const std::string description = fmt::format("{}: {} run{}, {} points, {:.6g} s covered", request.path.string(), trajectories.size(),
                                              trajectories.size() == 1 ? "" : "s", points, seconds);
  opened.source = std::make_unique<TrajectorySource>(std::move(trajectories), known.context, std::move(motion), false, description);
  opened.meta.source = "recording";
  opened.meta.name = fs::path(request.path).stem().string();
  if (recording.runs.front().source != request.path.string())
    opened.meta.inputs.push_back({request.path.string(), file_hash(request.path)});
  return opened;
}

}  // namespace millscope::studies
