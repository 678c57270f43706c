#include "studies/engine/liggghts/results.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "kernel/base/error.hpp"
#include "kernel/base/hash.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/new_folder.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/soundness.hpp"
#include "kernel/run/window.hpp"
#include "studies/engine/liggghts/dumps.hpp"
#include "studies/engine/liggghts/obstacles.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

namespace fs = std::filesystem;
using base::UserError;

/// A row of series.txt: means over about 10 ms.
struct Span {
  double begin = 0, time = 0, end = 0;   ///< s, of the case; `time`: the middle
  double translation = 0, rotation = 0;  ///< J
  std::array<double, 3> centre{};        ///< m
  double torque = 0;                     ///< on the turning walls about their axes, N m
  double power = 0;                      ///< that turns them, W
};

double charge_mass(const std::vector<DataBead>& beads) {
  double mass = 0;
  for (const DataBead& bead : beads) mass += bead.density * config::sphere_volume(bead.diameter);
  return mass;
}

constexpr std::size_t kBeforeTorques = 6;  // step, two energies, three coordinates

Span span_of(const std::vector<double>& row, const run::Assembly& a, const std::vector<MeshFile>& meshes) {
  Span s;
  const auto every = static_cast<double>(series_every(a)), values = static_cast<double>(kSeriesValues);
  s.end = (row[0] - static_cast<double>(zero_step(a))) * a.time_step;
  s.begin = s.end - values * every * a.time_step;
  s.time = s.end - 0.5 * (values - 1) * every * a.time_step;
  s.translation = row[1], s.rotation = row[2], s.centre = {row[3], row[4], row[5]};
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const dem::Motion& motion = a.system->bodies[meshes[m].body].motion;
    if (motion.speed == 0) continue;
    double torque = 0;  // of the charge on the wall
    for (std::size_t axis = 0; axis < 3; ++axis) torque += motion.axis[axis] * row[kBeforeTorques + 3 * m + axis];
    s.torque += torque;
    s.power -= torque * dem::angular_speed(motion, s.time);
  }
  return s;
}

/// Adds the rows of one file up to a step.
void add_series(const fs::path& file, const run::Assembly& a, const std::vector<MeshFile>& meshes, std::int64_t end,
                std::vector<Span>& all) {
  TextFile in(file);
  const double row = static_cast<double>(kSeriesValues * series_every(a)) * a.time_step;
  while (in.next()) {
    if (in.text().empty() || in.text()[0] == '#') continue;
    const std::vector<double> numbers = in.numbers(kBeforeTorques + 3 * meshes.size());
    const Span s = span_of(numbers, a, meshes);
    if (s.begin < -1e-9 || numbers[0] > static_cast<double>(end)) continue;
    if (s.begin - (all.empty() ? 0.0 : all.back().end) > (all.empty() ? row : 0.5 * a.time_step) + 1e-9)
      in.fail(
          fmt::format("nothing stands from {:.4g} s to {:.4g} s; let LIGGGHTS run in one go", all.empty() ? 0.0 : all.back().end, s.begin));
    all.push_back(s);
  }
}

/// Those of the case's own time, without a gap, up to its end. A file ends, for this purpose, where a run went on from.
std::vector<Span> series_of(const fs::path& post, const run::Assembly& a, const std::vector<MeshFile>& meshes) {
  std::vector<Span> all;
  for (const Session& session : sessions_of(post, "series")) add_series(session.file, a, meshes, session.until, all);
  const double row = static_cast<double>(kSeriesValues * series_every(a)) * a.time_step, last = all.empty() ? 0 : all.back().end;
  if (last + row < a.c.time.end)
    throw UserError(
        fmt::format("{}: ends at {:.4g} s of {:.4g} s; let LIGGGHTS run to its end (README.md), or export the case again with --set "
                    "time.end_s",
                    (post / name_of_session("series", {})).string(), last, a.c.time.end));
  return all;
}

/// Whether the power by centre of mass is known: along a periodic axis LIGGGHTS follows beads from image to image.
bool knows_centre(const run::Assembly& a) { return !a.c.domain.periodic[0] && !a.c.domain.periodic[1]; }

void write_series(const std::vector<Span>& series, const run::Assembly& a, double mass, const fs::path& file) {
  std::vector<std::string> columns{"time_s", "translational_energy_J", "rotational_energy_J", "torque_N_m", "power_torque_W"};
  if (knows_centre(a)) columns.emplace_back("power_com_W");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!a.c.domain.periodic[axis]) columns.push_back(fmt::format("com_{}_m", "xyz"[axis]));
  }
  output::SeriesWriter writer = output::SeriesWriter::create(file, columns);
  for (const Span& s : series) {
    std::vector<double> row{s.time, s.translation, s.rotation, s.torque, s.power};
    if (knows_centre(a)) row.push_back(run::power_of_centre(a, mass, s.time, s.centre));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!a.c.domain.periodic[axis]) row.push_back(s.centre[axis]);
    }
    writer.append(row);
  }
  writer.close();
}

nlohmann::ordered_json summary_of(const std::vector<Span>& series, const run::Assembly& a, double mass) {
  constexpr std::size_t kFewestRows = 9;  // that a mean with an error needs
  run::Course course;
  course.until = series.back().end;
  for (const Span& s : series) {
    if (s.begin < a.c.time.analyze_from - 1e-9) continue;
    if (course.torque.empty()) course.from = s.begin;
    course.torque.push_back(s.power);
    if (knows_centre(a)) course.centre.push_back(run::power_of_centre(a, mass, s.time, s.centre));
    course.kinetic.push_back(s.translation + s.rotation);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!a.c.domain.periodic[axis]) course.place[axis].push_back(s.centre[axis]);
    }
  }
  nlohmann::ordered_json j;
  j["schema_version"] = 1;
  j["name"] = a.c.name;
  j["particles"] = a.bead_count;
  j["charge_mass_kg"] = mass;
  j["steps"] = a.end_step - a.first_step;
  j["dt_s"] = a.time_step;
  j["dt_rayleigh_fraction"] = a.time_step / a.rayleigh_time;
  j["simulated_s"] = series.back().end;
  j["settle_s"] = static_cast<double>(-a.first_step) * a.time_step;
  j["mill_speed_rad_per_s"] = a.mill_speed;
  j["stiffness_factor"] = a.c.stiffness_factor;
  if (course.torque.size() >= kFewestRows) j.update(run::means_of(course));
  j["doubts"] = run::doubts_of(run::soundness_of_means(a, j));
  return j;
}

/// The first line of its log: "LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0, …)".
std::string version_in(const fs::path& log) {
  std::ifstream in(log);
  std::string line;
  while (std::getline(in, line)) {
    if (line.starts_with("LIGGGHTS")) return line;
  }
  return "unknown";
}

}  // namespace

Imported read_results(const fs::path& folder, const fs::path& out, const host::Registry& registry, const HowRun& how) {
  const fs::path case_file = folder / output::kResolvedCase;
  if (!fs::exists(case_file))
    throw UserError(fmt::format("{}: there is none; give a folder that 'millscope export' has made", case_file.string()));
  const run::Assembly a = run::assemble(config::read_case(case_file.string()), registry);
  const std::vector<Span> series = series_of(folder / "post", a, meshes_of(a));
  const double mass = charge_mass(beads_in(folder / "beads.data"));
  nlohmann::ordered_json j = summary_of(series, a, mass);
  j["engine"] = {{"name", "liggghts"}, {"differs", differences_of(a, registry)}};
  for (const char* half_read : {"frames.h5", "tracks.h5", "series.csv", "vtk"})
    fs::remove_all(out / half_read);  // by an attempt that failed
  const Imported imported{a.bead_count, write_frames(folder / "post", a, out / "frames.h5"), series.back().end};
  if (a.c.output.tracks) write_tracks(folder, a, out / "tracks.h5");
  if (a.c.output.vtk) write_pictures(folder / "post", a, out / "vtk");
  write_series(series, a, mass, out / "series.csv");
  output::write_file(out / output::kResolvedCase, config::resolved_yaml(a.c, registry.descriptors()));
  j["engine"]["version"] = version_in(folder / "log.liggghts");
  j["engine"]["script"] = base::Hash().add(base::text_of(folder / "in.liggghts")).text();
  if (how.ranks > 0) j["engine"]["ranks"] = how.ranks;
  for (const std::int64_t step : steps_of_files(folder / "post", "series"))
    j["engine"]["resumed_at_s"].push_back(static_cast<double>(step - zero_step(a)) * a.time_step);
  if (how.wall > 0 && !j["engine"].contains("resumed_at_s")) j["wall_s"] = how.wall;
  j["provenance"] = output::provenance(how.command_line, {});
  output::write_json(out / "summary.json", j);
  return imported;
}

Imported import_case(const fs::path& folder, const fs::path& out, const host::Registry& registry,
                     const std::vector<std::string>& command_line) {
  output::NewFolder aside(out);
  const Imported imported = read_results(folder, aside.path(), registry, {command_line});
  aside.publish();
  return imported;
}

}  // namespace millscope::engine::liggghts
