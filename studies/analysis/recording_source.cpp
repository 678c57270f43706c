#include "studies/analysis/recording_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/analysis/follow.hpp"
#include "studies/analysis/recorded_mill.hpp"

namespace millscope::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void cut(recording::Run& run, const SourceRequest& request) {
  if (!request.from && !request.to) return;
  const auto begin = run.time.begin();
  const auto first = request.from ? std::lower_bound(begin, run.time.end(), *request.from) - begin : 0;
  const auto last = request.to ? std::upper_bound(begin, run.time.end(), *request.to) - begin : std::ssize(run.time);
  const auto keep = [&](auto& values) {
    if (!values.empty()) values = {values.begin() + first, values.begin() + std::max(last, first)};
  };
  for (auto& axis : run.position) keep(axis);
  keep(run.spread);
  keep(run.events);
  keep(run.time);
}

/// What of a file is used, and by which rules the rest was set aside.
Json run_json(const recording::Run& run) {
  const recording::RunReport& r = run.report;
  return {{"name", run.name},
          {"file", run.source},
          {"format", run.format},
          {"rows", r.rows},
          {"used", r.used},
          {"rows_set_aside",
           {{"unreadable", r.unreadable},
            {"not_finite", r.not_finite},
            {"lost", r.lost},
            {"false_times", r.false_times},
            {"duplicates", r.duplicates},
            {"outside", r.outside},
            {"outliers", r.outliers}}},
          {"rows_out_of_order", r.backwards},
          {"gaps", r.gaps},
          {"gap_time_s", r.gap_time}};
}

/// One note for a run of which rows were set aside or out of order; none else.
std::vector<std::string> row_notes(const recording::Recording& recording) {
  std::vector<std::string> notes;
  std::string format;
  for (const recording::Run& run : recording.runs) {
    if (run.format != format) notes.push_back(fmt::format("{}{} read as {}", run.name, format.empty() ? "" : " and on", run.format));
    format = run.format;
  }
  for (const recording::Run& run : recording.runs) {
    const recording::RunReport& r = run.report;
    std::string counts;
    const auto add = [&](std::uint64_t count, const char* words) {
      if (count > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, words);
    };
    add(r.unreadable, "unreadable");
    add(r.not_finite, "not finite");
    add(r.lost, "of a lost bead");
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
  recording::Recording recording = recording::read_recording(request.path);
  OpenedSource opened;
  std::optional<MillOfCase> mill;
  if (const fs::path& geometry = recording.condition.geometry; !geometry.empty()) {
    mill = read_mill_of_case(geometry, registry);
    opened.meta.case_file = fs::absolute(geometry).lexically_normal().string();
  }
  const RecordedMill known = know_mill(recording, mill);
  opened.meta.notes = known.notes;
  for (std::string& note : row_notes(recording)) opened.meta.notes.push_back(std::move(note));
  for (const recording::Run& run : recording.runs) opened.meta.runs.push_back(run_json(run));
  trajectory::TrajectoryOptions options = request.trajectory;
  options.axis = known.axis;
  if (!(options.gap_limit > 0)) options.gap_limit = recording.gap_limit;
  for (recording::Run& run : recording.runs) cut(run, request);
  Followed followed =
      follow(tracer_runs(recording, options),
             {.of = request.path.string(), .mill = known.context, .motion = even_motion(known.context.omega), .threads = request.threads});
  for (std::string& note : followed.notes) opened.meta.notes.push_back(std::move(note));
  if (followed.points_left_out > 0) {
    opened.meta.notes.push_back(fmt::format("{} of {} points stand in stretches of fewer than {} and are left out",
                                            followed.points_left_out, followed.points, options.least_points));
  }
  for (const std::size_t i : followed.runs) {
    const std::string& file = recording.runs[i].source;
    opened.meta.inputs.push_back({file, file_hash(file)});
  }
  opened.source = std::move(followed.source);
  opened.meta.source = "recording";
  opened.meta.name = fs::path(request.path).stem().string();
  if (recording.runs.front().source != request.path.string())
    opened.meta.inputs.push_back({request.path.string(), file_hash(request.path)});
  return opened;
}

}  // namespace millscope::analysis
