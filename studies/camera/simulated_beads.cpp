#include "studies/camera/simulated_beads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/summary.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/camera/camera.hpp"

namespace millscope::camera {
namespace {

using base::UserError;

std::filesystem::path case_of(const std::filesystem::path& run) {
  const std::filesystem::path file = run / output::kResolvedCase;
  if (std::filesystem::exists(file)) return file;
  throw UserError(fmt::format("{}: is no directory of a run (it has no case.resolved.yaml); make one: millscope run CASE.yaml -o {}",
                              run.string(), run.string()));
}

/// Why an imported run followed none; "" of a run that was not imported.
std::string why_not_imported(const std::filesystem::path& run) {
  const nlohmann::ordered_json summary = output::read_json(run / "summary.json");
  if (!summary.is_object() || !summary.contains("engine") || !summary["engine"].contains("tracks_need_interval_s")) return "";
  const auto& engine = summary["engine"];
  const double needed = engine["tracks_need_interval_s"].get<double>(), interval = engine["interval_s"].get<double>();
  const std::string frames = engine.contains("tracks_absent") ? engine["tracks_absent"].get<std::string>()
                             : interval > 0                   ? fmt::format("its frames are {:.3g} ms apart", 1e3 * interval)
                                                              : "it has one frame";
  return fmt::format(
      "{}, and the camera needs frames at most {:.3g} ms apart, with the numbers and velocities of the beads: let your program write these",
      frames, 1e3 * needed);
}

std::filesystem::path tracks_of(const std::filesystem::path& run) {
  const std::filesystem::path file = run / "tracks.h5";
  if (std::filesystem::exists(file)) return file;
  if (const std::string why = why_not_imported(run); !why.empty())
    throw UserError(fmt::format("{}: {}", case_of(run).parent_path().string(), why));
  throw UserError(fmt::format("{}: the run followed no bead (it has no tracks.h5); run the case again with --set output.tracks.beads=10",
                              case_of(run).parent_path().string()));
}

recording::Condition condition_of(const config::Case& c, const analysis::MillOfCase& mill, const std::filesystem::path& file) {
  recording::Condition condition;
  const AnalyzerContext& context = mill.context;
  if (context.omega != 0) {
    condition.angular_velocity = context.omega;
    condition.speed = std::fabs(context.omega);
  }
  condition.filling = c.fill.filling;
  condition.porosity = c.fill.porosity;
  condition.bead_diameter = 2 * context.bead_radius;
  condition.bead_density = context.bead_density;
  if (context.mill_radius > 0) condition.mill_diameter = 2 * context.mill_radius;
  if (mill.period == 0 && context.mill_high > context.mill_low) condition.mill_length = context.mill_high - context.mill_low;
  condition.slice = analysis::slice_of(mill);
  condition.geometry = file;
  return condition;
}

std::optional<recording::MeasuredPower> power_of(const std::filesystem::path& summary) {
  const nlohmann::ordered_json j = output::read_json(summary);
  if (!j.is_object() || !j.contains("power_W")) return std::nullopt;
  const nlohmann::ordered_json &value = j["power_W"]["com"], &error = j["power_W"]["com_sem"];
  if (!value.is_number() || !error.is_number()) return std::nullopt;
  return recording::MeasuredPower{value.get<double>(), error.get<double>()};
}

}  // namespace

SimulatedBeads::SimulatedBeads(std::filesystem::path run, const host::Registry& registry) : run_(std::move(run)), reader_(tracks_of(run_)) {
  const std::filesystem::path file = case_of(run_);
  const config::Case c = config::read_case(file.string());
  const analysis::MillOfCase mill = analysis::read_mill_of_case(file, registry);
  condition_ = condition_of(c, mill, file);
  condition_.power = power_of(run_ / "summary.json");
  context_ = {0, 0, mill.context.mill_radius, mill.context.mill_low, mill.context.mill_high, mill.context.omega, mill.period};
  analyze_from_ = c.time.analyze_from;
  period_ = mill.period;
}

output::TrackSamples SimulatedBeads::path(std::size_t i, double from) const {
  output::TrackSamples track = reader_.read(i);
  if (period_ > 0) output::unwrap(track.position[2], period_);
  const auto first = std::lower_bound(track.time.begin(), track.time.end(), from) - track.time.begin();
  track.time.erase(track.time.begin(), track.time.begin() + first);
  for (auto& x : track.position) x.erase(x.begin(), x.begin() + first);
  return track;
}

TrackContext SimulatedBeads::context(std::size_t i, std::uint64_t seed) const {
  TrackContext context = context_;
  context.seed = bead_seed(seed, tracks()[i].bead);
  context.bead_radius = 0.5 * tracks()[i].diameter;
  return context;
}

}  // namespace millscope::camera
