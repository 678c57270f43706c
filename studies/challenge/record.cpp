#include "studies/challenge/record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/base/parallel.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/calibrate/bead_paths.hpp"
#include "studies/camera/ctrack_writer.hpp"
#include "studies/camera/simulated_beads.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::challenge {

namespace fs = std::filesystem;
using base::UserError;

namespace {

constexpr std::size_t kLeastPoints = 30;  // of a bead that the camera saw too little of

}  // namespace

recording::Condition believed(const diagnose::Question& q, std::size_t condition, const host::Registry& registry) {
  std::vector<std::string> settings = q.study.conditions[condition].settings;
  for (const diagnose::Nuisance& n : q.nuisances) {
    if (!n.usual) settings.push_back(fmt::format("{}={:.6g}", n.path, n.mean));
  }
  const analysis::MillOfCase mill = analysis::read_mill_of_case(q.study.base, registry, settings);
  const AnalyzerContext& c = mill.context;
  recording::Condition out;
  if (c.omega != 0) out.angular_velocity = c.omega, out.speed = std::fabs(c.omega);
  if (c.filling > 0) out.filling = c.filling, out.porosity = c.porosity;
  out.bead_diameter = 2 * c.bead_radius;
  out.bead_density = c.bead_density;
  if (c.mill_radius > 0) out.mill_diameter = 2 * c.mill_radius;
  if (mill.period == 0 && c.mill_length > 0) out.mill_length = c.mill_length;
  out.slice = analysis::slice_of(mill);
  return out;
}

PowerOfRun power_of(const fs::path& run, const host::Registry& registry) {
  const nlohmann::ordered_json j = output::read_json(run / "summary.json");
  const auto power = j.is_object() ? j.value("power_W", nlohmann::ordered_json()) : nlohmann::ordered_json();
  if (!power.is_object() || !power.contains("com") || !power["com"].is_number())
    throw UserError(fmt::format("{}: its summary.json tells no power; the run has not come to its end", run.string()));
  const bool tracers = config::read_case((run / output::kResolvedCase).string()).has_tracers();
  const double ratio = tracers ? calibrate::BeadPaths(run, 1, {}, registry).power_ratio() : 1.0;
  const double sem = power.contains("com_sem") && power["com_sem"].is_number() ? power["com_sem"].get<double>() : 0.0;
  return {ratio * power["com"].get<double>(), ratio * sem};
}

void write_recording(const RecordingOf& what, const camera::Camera& camera, const host::Registry& registry) {
  const camera::SimulatedBeads beads(what.run, registry);
  const std::size_t count = beads.tracks().size();
  std::vector<std::string> texts(count);
  base::for_each_item(count, base::worker_count(0, count), [&](std::size_t i, std::size_t) {
    const recording::Run run = camera::observe(beads.path(i, beads.analyze_from()), camera, beads.context(i, what.seed));
    if (run.size() >= kLeastPoints) texts[i] = camera::ctrack_text(run);
  });
  std::vector<std::string> names;
  for (const std::string& text : texts) {
    if (text.empty()) continue;
    names.push_back(fmt::format("{}_{}.a", what.name, names.size() + 1));
    output::write_file(what.folder / names.back(), text);
  }
  if (names.empty())
    throw UserError(fmt::format("{}: the camera saw none of the beads for long enough; loosen it, or give more seconds", what.name));
  const fs::path file = what.folder / (what.name + ".yaml");
  output::write_file(file, camera::recording_text(names, what.condition, "Tracers in one state of a mill, and what is known of it."));
  recording::read_recording(file);  // throws for a mill that no recording may be of: better now than when all sets are sealed
}

}  // namespace millscope::challenge
