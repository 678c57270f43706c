// `domain`, `time`, `output`, `run`.
#include <fmt/format.h>

#include "kernel/config/reader.hpp"

namespace millscope::config {
namespace {

constexpr const char* kAxes[] = {"x", "y", "z"};

/// `[x, y, z]` or a map of some axes.
void read_sides(const std::optional<Node>& node, Vector3& sides) {
  if (!node) return;
  if (node->is_sequence()) {
    sides = read_vector(*node, "m");
    return;
  }
  node->expect({"x", "y", "z"});
  for (std::size_t i = 0; i < 3; ++i) sides[i] = number_or(*node, kAxes[i], "m", any_number(), sides[i]);
}

void read_period(const Node& node, std::size_t axis, DomainCase& domain) {
  const std::vector<Node> ends = node.items();
  if (ends.size() != 2) node.fail("wants the two ends of the period, e.g. [0, 20 mm]");
  domain.periodic[axis] = true;
  domain.box.low[axis] = read_number(ends[0], "m");
  domain.box.high[axis] = read_number(ends[1], "m");
}

/// The section of one output; nothing when it is absent or `off`.
std::optional<Node> section_of(const std::optional<Node>& output, const char* key) {
  if (!output) return std::nullopt;
  auto node = output->find(key);
  if (!node) return std::nullopt;
  if (!node->is_scalar()) return node;
  read_choice(*node, "off");
  return std::nullopt;
}

bool is_off(const std::optional<Node>& output, const char* key) { return output && output->has(key) && !section_of(output, key); }

OutputCase::Tracks read_tracks(const Node& node) {
  node.expect({"beads", "every_s"});
  OutputCase::Tracks tracks;
  tracks.every = number_or(node, "every_s", "s", positive(), tracks.every);
  const auto beads = node.find("beads");
  if (!beads) return tracks;
  if (!beads->is_sequence()) {
    tracks.count = static_cast<std::uint64_t>(read_integer(*beads, between(1, 4e9)));
    return tracks;
  }
  for (const Node& id : beads->items()) tracks.ids.push_back(static_cast<std::uint64_t>(read_integer(id, between(0, 4e9))));
  if (tracks.ids.empty()) beads->fail("is an empty list; name bead ids or give a number of beads");
  tracks.count = tracks.ids.size();
  return tracks;
}

OutputCase::Frames read_frames(const Node& node, const TimeCase& time) {
  node.expect({"every_s", "from_s"});
  OutputCase::Frames frames;
  frames.every = number_or(node, "every_s", "s", positive(), frames.every);
  const Range range{0, time.end, false, true, "it must lie before time.end_s"};
  frames.from = number_or(node, "from_s", "s", range, time.analyze_from);
  return frames;
}

double read_every(const Node& node, const char* key, double fallback) {
  node.expect({key});
  return number_or(node, key, "s", positive(), fallback);
}

}  // namespace

DomainCase read_domain(const Node& section) {
  section.expect({"periodic", "low", "high"});
  DomainCase domain;
  domain.box.low.fill(-kUnbounded);
  domain.box.high.fill(kUnbounded);
  read_sides(section.find("low"), domain.box.low);
  read_sides(section.find("high"), domain.box.high);
  if (const auto periodic = section.find("periodic")) {
    periodic->expect({"x", "y", "z"});
    for (std::size_t i = 0; i < 3; ++i) {
      if (const auto axis = periodic->find(kAxes[i])) read_period(*axis, i, domain);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(domain.box.low[i] < domain.box.high[i])) {
      section.fail(fmt::format("ends along {} where it begins or before ({} to {} m); the low end comes first", kAxes[i],
                               number_text(domain.box.low[i]), number_text(domain.box.high[i])));
    }
  }
  return domain;
}

TimeCase read_time(const Node& section) {
  section.expect({"end_s", "analyze_from_s", "step_s", "step_fraction"});
  TimeCase time;
  time.where = section.where();
  time.end = read_number(section.at("end_s", "the end of the run, e.g. 4 s"), "s", positive());
  const std::string reason = fmt::format("the analysis needs a span before time.end_s = {} s", number_text(time.end));
  const Range before_end{0, time.end, false, true, reason.c_str()};
  time.analyze_from = number_or(section, "analyze_from_s", "s", before_end, 0.5 * time.end);
  if (section.has("step_s") && section.has("step_fraction")) section.fail("gives both 'step_s' and 'step_fraction'; keep one");
  const Range within{0, time.end, true, false, "a step is no longer than the run"};
  if (const auto step = section.find("step_s")) time.step = read_number(*step, "s", within);
  const Range fraction{0, 1, true, false, "a step beyond the Rayleigh time is unstable; 20 % is usual"};
  time.step_fraction = number_or(section, "step_fraction", "1", fraction, time.step_fraction);
  return time;
}

StartCase read_start(const Node& section, const TimeCase& time) {
  section.expect({"run", "develop_s", "walls_ahead_s"});
  StartCase start;
  start.node = section.at("run", "the folder of a finished run of the same mill");
  start.run = resolve_file(start.node);
  const std::string reason = fmt::format("the mill turns for so long before the analysis, which begins at time.analyze_from_s = {} s",
                                         number_text(time.analyze_from));
  const Range before{0, time.analyze_from, true, false, reason.c_str()};
  start.develop = read_number(section.at("develop_s", "how long the mill turns before the analysis, e.g. 0.5 s"), "s", before);
  if (const auto ahead = section.find("walls_ahead_s")) start.walls_ahead = read_number(*ahead, "s");
  return start;
}

OutputCase read_output(const std::optional<Node>& section, const TimeCase& time) {
  OutputCase output;
  if (!section) return output;
  section->expect({"series", "frames", "tracks", "vtk", "checkpoint"});
  if (is_off(section, "series")) output.series.reset();
  if (is_off(section, "checkpoint")) output.checkpoint.reset();
  if (const auto node = section_of(section, "series")) output.series->every = read_every(*node, "every_s", output.series->every);
  if (const auto node = section_of(section, "frames")) output.frames = read_frames(*node, time);
  if (const auto node = section_of(section, "tracks")) output.tracks = read_tracks(*node);
  if (const auto node = section_of(section, "vtk")) output.vtk = OutputCase::Vtk{read_every(*node, "every_s", OutputCase::Vtk{}.every)};
  if (const auto node = section_of(section, "checkpoint")) {
    output.checkpoint->every_wall = read_every(*node, "every_wall_s", output.checkpoint->every_wall);
  }
  return output;
}

RunCase read_run(const Node& section) {
  section.expect({"threads", "partitions", "skin", "allow_unstable", "engine", "ranks"});
  RunCase run;
  if (const auto node = section.find("threads")) {
    run.threads = static_cast<int>(read_integer(*node, between(0, 4096, "0 takes as many as the machine has")));
  }
  if (const auto node = section.find("partitions")) run.partitions = static_cast<int>(read_integer(*node, between(1, 4096)));
  run.skin = number_or(section, "skin", "1", {0, 2, true, false, "it is a part of the largest bead's diameter"}, run.skin);
  if (const auto node = section.find("allow_unstable")) run.allow_unstable = read_flag(*node);
  if (const auto node = section.find("engine")) run.engine = node->text();
  if (const auto node = section.find("ranks")) {
    run.ranks = static_cast<int>(read_integer(*node, between(1, 100000, "processes of another engine")));
    if (run.engine.empty()) node->fail("is for another engine; add 'engine: liggghts', or give threads");
  }
  return run;
}

}  // namespace millscope::config
