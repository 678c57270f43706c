// The order of things: description, rows, time order, units, points that cannot be, gaps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/base/statistics.hpp"
#include "kernel/output/track_reader.hpp"
#include "studies/recording/clean.hpp"
#include "studies/recording/layout.hpp"
#include "studies/recording/plausible.hpp"
#include "studies/recording/recording.hpp"
#include "studies/recording/text_file.hpp"

namespace millscope::recording {
namespace {

namespace fs = std::filesystem;
using base::UserError;

constexpr const char* kTracks = "tracks.h5: t s, position m";

/// What reading leaves beside the runs.
struct Units {
  std::string time, length;
};

std::string plain_name(fs::path file) {
  if (file.extension() == ".gz") file = file.stem();
  return file.stem().string();
}

[[noreturn]] void fail_unusable(const fs::path& file, const RunReport& report, const FirstFault& fault, const std::string& layout) {
  if (report.rows == 0)
    throw UserError(fmt::format("{}: holds no usable point: it has no row of numbers (read as {})", file.string(), layout));
  const char* remedy = fault.why == kDecimalCommas ? "replace them by points" : "say what its columns are in a recording.yaml";
  const std::string first = fault.line > 0 ? fmt::format("'{}' {}; ", fault.text, fault.why) : "";
  throw UserError(base::Location{file.string(), static_cast<int>(fault.line)},
                  fmt::format("{}{} of {} rows are unreadable, {} not finite and {} have false times, so the file is of no use as it is "
                              "read ({}); {}",
                              first, report.unreadable, report.rows, report.not_finite, report.false_times, layout, remedy));
}

/// Beyond three thousand years doubles cannot tell one point from the next. The median, for a false time or two are set aside.
void check_times(const std::vector<double>& times, const base::Location& where, const std::string& unit) {
  constexpr double kLatest = 1e11;  // s
  std::vector<double> some;
  for (std::size_t i = 0; i < times.size(); i += times.size() / 10000 + 1) some.push_back(std::fabs(times[i]));
  const double usual = base::quantile(some, 0.5);
  if (usual <= kLatest) return;
  throw UserError(where,
                  fmt::format("has times of {:.3g} s (read in {}), more than three thousand years; say the right unit under 'columns' in "
                              "a recording.yaml, e.g. {{t: ns, …}}",
                              usual, unit));
}

std::vector<Run> read_table(const RecordingFile& file, const Description& description, Units& units) {
  const TextFile text(file.path);
  const KnownLayout known = layout_of(text.text(), file.path, description);
  FirstFault fault;
  Table table = read_rows(text.text(), known.layout, fault);
  RunReport report = table.rows.report;
  const auto mostly_bad = [&] { return report.unreadable + report.not_finite + report.false_times > report.rows / 2; };
  if (table.rows.size() == 0 || mostly_bad()) fail_unusable(file.path, report, fault, known.words);
  check_times(table.rows.time, description.columns ? description.columns_place : base::Location{file.path.string(), 0}, known.time_unit);
  units = {known.time_unit, known.length_unit};
  std::vector<Run> runs;
  std::uint64_t unseen = 0;
  for (Run& one : runs_of_labels(std::move(table), description.labels, description.labels_place)) {
    drop_lost(one);
    const std::string label = one.name;
    if (one.size() == 0 && !label.empty()) {  // of a bead that was never seen
      unseen += one.report.rows;
      continue;
    }
    refuse_several(one, file.path);
    for (Run& part : order_rows(std::move(one))) {
      if (!label.empty()) part.name = plain_name(file.path) + "_" + label;
      runs.push_back(std::move(part));
    }
  }
  if (runs.empty()) throw UserError(fmt::format("{}: holds no usable point: no bead was seen", file.path.string()));
  carry_lost(runs.front(), unseen);
  for (const Run& run : runs) report.false_times += run.report.false_times;
  if (mostly_bad()) fail_unusable(file.path, report, fault, known.words);
  for (Run& run : runs) run.format = known.words;
  return runs;
}

std::vector<Run> read_tracks(const RecordingFile& file, Recording& recording) {
  const output::TrackReader reader(file.path);
  std::vector<Run> runs;
  for (std::size_t k = 0; k < reader.tracks().size(); ++k) {
    const output::TrackInfo& info = reader.tracks()[k];
    output::TrackSamples samples = reader.read(k);
    Run run;
    run.name = info.name;
    run.time = std::move(samples.time);
    run.position = std::move(samples.position);
    run.format = kTracks;
    run.report.rows = run.report.used = run.size();
    TracerBead& tracer = recording.condition.tracer;
    if (info.diameter > 0 && !tracer.diameter) tracer.diameter = info.diameter;
    if (info.density > 0 && !tracer.density) tracer.density = info.density;
    if (run.size() > 0) runs.push_back(std::move(run));
  }
  if (runs.empty()) throw UserError(fmt::format("{}: holds no usable point: its tracks are empty", file.path.string()));
  for (const Run& run : runs) check_times(run.time, {file.path.string(), 0}, "s");
  return runs;
}

void turn_axes(Run& run, const std::array<AxisSource, 3>& axes) {
  std::array<std::vector<double>, 3> turned;
  for (std::size_t k = 0; k < 3; ++k) {
    turned[k] = std::move(run.position[axes[k].axis]);
    if (axes[k].sign > 0) continue;
    for (double& value : turned[k]) value = -value;
  }
  run.position = std::move(turned);
}

/// Names are groups of a tracks.h5, so none stands twice.
void name_run(Run& run, std::size_t part, const RecordingFile& file, const std::vector<Run>& others) {
  run.source = file.path.string();
  if (run.name.empty()) run.name = plain_name(file.path) + (part == 0 ? "" : fmt::format("_{}", part + 1));
  const std::string plain = run.name;
  const auto taken = [&] { return std::any_of(others.begin(), others.end(), [&](const Run& other) { return other.name == run.name; }); };
  for (int count = 2; taken(); ++count) run.name = fmt::format("{}_{}", plain, count);
}

void read_file(const RecordingFile& file, const Description& description, Recording& recording, Units& units) {
  const bool tracks = description.format == Format::tracks || (description.format == Format::automatic && output::is_track_file(file.path));
  std::vector<Run> runs = tracks ? read_tracks(file, recording) : read_table(file, description, units);
  for (std::size_t part = 0; part < runs.size(); ++part) {
    turn_axes(runs[part], description.axes);
    name_run(runs[part], part, file, recording.runs);
    recording.runs.push_back(std::move(runs[part]));
  }
}

/// How far from the middle of all points, or from the mill where it is known, a point may lie along an axis: lowest and highest value.
std::array<double, 2> reach_of(std::size_t axis, const Extent& extent, const Recording& recording) {
  constexpr double kSlack = 0.01;  // m, beside 5 % of the mill
  const Condition& condition = recording.condition;
  const std::optional<MillFrame>& frame = recording.frame;
  const auto& size = axis < 2 ? condition.mill_diameter : condition.mill_length;
  double reach = 2 * extent.largest();
  if (size) reach = std::min(reach, 1.05 * *size + kSlack);
  std::array<double, 2> range{extent.middle[axis] - reach, extent.middle[axis] + reach};
  const auto narrow = [&](double low, double high) { range = {std::max(range[0], low), std::min(range[1], high)}; };
  if (frame && axis < 2 && size) narrow(frame->axis[axis] - 0.525 * *size - kSlack, frame->axis[axis] + 0.525 * *size + kSlack);
  if (frame && axis == 2 && frame->high > frame->low) {
    const double slack = 0.05 * (frame->high - frame->low) + kSlack;
    narrow(frame->low - slack, frame->high + slack);
  }
  return range;
}

/// A spline needs six points, and less says nothing of a motion.
void refuse_few(const Recording& recording) {
  constexpr std::size_t kFewest = 6;
  std::size_t usable = 0, rows = 0;
  for (const Run& run : recording.runs) {
    usable += run.size();
    rows += run.report.rows;
  }
  if (usable >= kFewest) return;
  throw UserError(fmt::format("{}: holds {} usable points of {} rows, and fewer than {} say nothing of a motion; give a longer recording",
                              recording.file.string(), usable, rows, kFewest));
}

/// Of a file with several runs those that are nowhere in the mill, as a reflection is: another run of the file carries their rows.
void drop_reflections(std::vector<Run>& runs) {
  for (std::size_t i = runs.size(); i-- > 0;) {
    const auto seen = [&](const Run& other) { return other.size() > 0 && other.source == runs[i].source; };
    const auto other = runs[i].size() > 0 ? runs.end() : std::find_if(runs.begin(), runs.end(), seen);
    if (other == runs.end()) continue;
    carry_lost(*other, runs[i].report.rows);
    runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void clean(Recording& recording) {
  const Extent extent = measure_extent(recording.runs);
  if (!(recording.travel.speed > 0)) recording.travel = measure_travel(recording.runs, recording.gap_limit);
  std::array<std::array<double, 2>, 3> range{};
  for (std::size_t axis = 0; axis < 3; ++axis) range[axis] = reach_of(axis, extent, recording);
  for (Run& run : recording.runs) {
    if (run.format != kTracks) {  // those of a tracks.h5 are simulated, or were judged when they were read first
      drop_outside(run, range);
      drop_outliers(run, recording.travel);
    }
    count_gaps(run, recording.gap_limit);
  }
  drop_reflections(recording.runs);
  const auto empty = std::find_if(recording.runs.begin(), recording.runs.end(), [](const Run& run) { return run.size() == 0; });
  if (empty == recording.runs.end()) return;
  throw UserError(
      fmt::format("{}: holds no usable point: all {} of {} lie outside the mill that 'condition' and 'frame' state, or far from the "
                  "other runs; correct these, or leave the file out",
                  empty->source, empty->report.outside, empty->report.rows));
}

Description description_of(const fs::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".yaml" || ending == ".yml") return read_description(file);
  Description description;
  description.files.push_back({file, {}});
  return description;
}

}  // namespace

Recording clean_recording(Recording given) {
  std::vector<Run> runs = std::move(given.runs);
  given.runs.clear();
  for (Run& run : runs) {
    const std::string name = run.name, format = run.format, source = run.source;
    run.report = {};
    run.report.rows = run.report.used = run.size();
    std::vector<Run> parts = order_rows(std::move(run));
    for (std::size_t part = 0; part < parts.size(); ++part) {
      parts[part].name = part == 0 ? name : fmt::format("{}_{}", name, part + 1);
      parts[part].format = format;
      name_run(parts[part], part, {source, {}}, given.runs);
      given.runs.push_back(std::move(parts[part]));
    }
  }
  if (given.gap_limit == 0) given.gap_limit = default_gap_limit(given.runs);
  clean(given);
  refuse_few(given);
  return given;
}

Recording read_recording(const fs::path& file) {
  const Description description = description_of(file);
  Recording recording;
  recording.file = file;
  recording.condition = description.condition;
  recording.frame = description.frame;
  Units units{"s", "m"};
  for (const RecordingFile& one : description.files) read_file(one, description, recording, units);
  base::Location where{file.string(), 0};
  if (description.columns) where = description.columns_place;
  check_units(recording.runs, recording.condition, where, units.time, units.length);
  recording.gap_limit = description.gap_limit.value_or(default_gap_limit(recording.runs));
  clean(recording);
  refuse_few(recording);
  return recording;
}

}  // namespace millscope::recording
