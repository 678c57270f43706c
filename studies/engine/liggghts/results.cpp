#include "studies/engine/liggghts/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <sstream>

#include "kernel/base/error.hpp"
#include "kernel/config/case.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/frames.hpp"
#include "kernel/output/new_folder.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/run/statistics.hpp"
#include "kernel/run/window.hpp"
#include "studies/engine/liggghts/folder.hpp"
#include "studies/engine/liggghts/obstacles.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

namespace fs = std::filesystem;
using base::UserError;

std::vector<double> numbers_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<double> numbers;
  for (double number; in >> number;) numbers.push_back(number);
  return numbers;
}

std::ifstream opened(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw UserError(fmt::format("{}: cannot be read; run 'liggghts -in in.liggghts' in that folder first", file.string()));
  return in;
}

/// A row of series.txt: means over its steps.
struct Instant {
  double time = 0;                       ///< s, of the case
  double translation = 0, rotation = 0;  ///< J
  std::array<double, 3> centre{};        ///< m
  double torque = 0;                     ///< on the turning walls about their axes, N m
  double power = 0;                      ///< that turns them, W
};

constexpr std::size_t kBeforeTorques = 6;  // step, two energies, three coordinates

Instant instant_of(const std::vector<double>& row, const run::Assembly& a, const std::vector<MeshFile>& meshes) {
  Instant s{(row[0] - static_cast<double>(zero_step(a))) * a.time_step, row[1], row[2], {row[3], row[4], row[5]}};
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

std::vector<Instant> series_of(const fs::path& file, const run::Assembly& a, const std::vector<MeshFile>& meshes) {
  std::ifstream in = opened(file);
  std::vector<Instant> all;
  const std::size_t columns = kBeforeTorques + 3 * meshes.size();
  int line = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    if (text.empty() || text[0] == '#') continue;
    const std::vector<double> row = numbers_of(text);
    if (in.eof() && row.size() < columns) break;  // cut short by a kill
    if (row.size() != columns)
      throw UserError(
          fmt::format("{}:{}: holds {} numbers, {} are expected; it belongs to another case", file.string(), line, row.size(), columns));
    all.push_back(instant_of(row, a, meshes));
  }
  return all;
}

/// The beads of one frame, by number.
struct Frame {
  std::int64_t step = 0;
  std::vector<double> position, velocity, spin, radius, density;
  std::vector<std::uint32_t> id, material;
};

Frame read_frame(const fs::path& file, std::size_t beads) {
  std::ifstream in = opened(file);
  Frame frame;
  std::string text;
  for (int line = 1; line <= 9; ++line) {
    if (!std::getline(in, text)) throw UserError(fmt::format("{}:{}: the frame is cut short; delete the file", file.string(), line));
    if (line == 2) frame.step = std::stoll(text);
  }
  while (std::getline(in, text)) {
    const std::vector<double> row = numbers_of(text);
    if (row.size() != 13)
      throw UserError(fmt::format("{}: a bead has {} numbers, 13 are expected; the frame is cut short", file.string(), row.size()));
    frame.id.push_back(static_cast<std::uint32_t>(row[0]) - 1);
    frame.material.push_back(static_cast<std::uint32_t>(row[1]) - 1);
    frame.position.insert(frame.position.end(), row.begin() + 2, row.begin() + 5);
    frame.velocity.insert(frame.velocity.end(), row.begin() + 5, row.begin() + 8);
    frame.spin.insert(frame.spin.end(), row.begin() + 8, row.begin() + 11);
    frame.radius.push_back(row[11]);
    frame.density.push_back(row[12]);
  }
  if (frame.id.size() != beads)
    throw UserError(fmt::format("{}: holds {} beads of {}: LIGGGHTS lost the others, or the frame is cut short; take a smaller time step",
                                file.string(), frame.id.size(), beads));
  return frame;
}

std::vector<fs::path> frames_in(const fs::path& folder) {
  std::vector<std::pair<std::int64_t, fs::path>> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && name.ends_with(".txt")) found.emplace_back(std::atoll(name.c_str() + 6), entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> files;
  for (const auto& [step, file] : found) files.push_back(file);
  return files;
}

/// frames.h5. Returns how many.
std::size_t write_frames(const std::vector<fs::path>& files, const run::Assembly& a, const fs::path& to) {
  std::optional<output::FrameWriter> writer;
  for (const fs::path& file : files) {
    const Frame frame = read_frame(file, a.bead_count);
    if (!writer) {
      std::vector<double> mass;
      for (std::size_t i = 0; i < frame.id.size(); ++i) mass.push_back(frame.density[i] * config::sphere_volume(2 * frame.radius[i]));
      writer = output::FrameWriter::create(to, {frame.id, frame.radius, mass, frame.material, a.materials, {}, {}});
    }
    output::FrameView view;
    view.time = static_cast<double>(frame.step - zero_step(a)) * a.time_step;
    if (const auto body = a.wall_body_of_mill()) {
      const dem::Motion& motion = a.system->bodies[static_cast<std::size_t>(*body)].motion;
      view.wall_angle = dem::pose_at(motion, view.time).angle;
      view.angular_velocity = dem::angular_speed(motion, view.time);
    }
    view.position = frame.position;
    view.velocity = frame.velocity;
    view.spin = frame.spin;
    writer->append(view);
  }
  if (writer) writer->close();
  return files.size();
}

double charge_mass(const run::Assembly& a) { return static_cast<double>(a.bead_count) * a.c.mean_bead_mass(); }

void write_series(const std::vector<Instant>& series, const run::Assembly& a, double mass, const fs::path& file) {
  const std::vector<std::string> columns{
      "time_s", "translational_energy_J", "rotational_energy_J", "torque_N_m", "power_torque_W", "power_com_W", "com_x_m", "com_y_m",
      "com_z_m"};
  output::SeriesWriter writer = output::SeriesWriter::create(file, columns);
  for (const Instant& s : series) {
    if (s.time < 0) continue;
    const std::array<double, 9> row{s.time,      s.translation, s.rotation,
                                    s.torque,    s.power,       run::power_of_centre(a, mass, s.time, s.centre),
                                    s.centre[0], s.centre[1],   s.centre[2]};
    writer.append(row);
  }
  writer.close();
}

nlohmann::ordered_json summary_of(const std::vector<Instant>& series, const run::Assembly& a, double mass) {
  std::vector<double> torque, centre, kinetic;
  std::array<std::vector<double>, 3> place;
  double from = 0, to = 0;
  for (const Instant& s : series) {
    if (s.time <= a.c.time.analyze_from) continue;
    if (torque.empty()) from = s.time;
    to = s.time;
    torque.push_back(s.power);
    centre.push_back(run::power_of_centre(a, mass, s.time, s.centre));
    kinetic.push_back(s.translation + s.rotation);
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis].push_back(s.centre[axis]);
  }
  const run::Mean pt = run::correlated_mean(torque), pc = run::correlated_mean(centre), ke = run::correlated_mean(kinetic);
  nlohmann::ordered_json j;
  j["schema_version"] = 1;
  j["name"] = a.c.name;
  j["particles"] = a.bead_count;
  j["charge_mass_kg"] = mass;
  j["steps"] = a.end_step - a.first_step;
  j["dt_s"] = a.time_step;
  j["dt_rayleigh_fraction"] = a.time_step / a.rayleigh_time;
  j["simulated_s"] = series.back().time;
  j["settle_s"] = static_cast<double>(-a.first_step) * a.time_step;
  j["mill_speed_rad_per_s"] = a.mill_speed;
  j["stiffness_factor"] = a.c.stiffness_factor;
  j["window_s"] = {from, to};
  j["power_W"] = {{"torque", pt.value}, {"torque_sem", pt.standard_error}, {"com", pc.value}, {"com_sem", pc.standard_error}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const run::Mean m = run::correlated_mean(place[axis]);
    const bool repeats = a.c.domain.periodic[axis];  // there LIGGGHTS follows beads from image to image
    j["com_m"].push_back(repeats ? nlohmann::ordered_json() : nlohmann::ordered_json(m.value));
    j["com_m_sem"].push_back(repeats ? nlohmann::ordered_json() : nlohmann::ordered_json(m.standard_error));
  }
  j["kinetic_energy_J"] = ke.value;
  j["kinetic_energy_J_sem"] = ke.standard_error;
  j["engine"] = {{"name", "liggghts"}, {"differs", differences_of(a)}};
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

void require_enough(const std::vector<Instant>& series, const run::Assembly& a, const fs::path& file) {
  const double last = series.empty() ? 0 : series.back().time, step = series.size() > 1 ? series[1].time - series[0].time : 0;
  if (last + 1.5 * step >= a.c.time.end) return;
  throw UserError(
      fmt::format("{}: ends at {:.4g} s of {:.4g} s; let LIGGGHTS run to its end (README.md), or export the case again with --set "
                  "time.end_s",
                  file.string(), last, a.c.time.end));
}

}  // namespace

Imported import_case(const fs::path& folder, const fs::path& out, const host::Registry& registry,
                     const std::vector<std::string>& command_line) {
  const fs::path case_file = folder / kResolvedCase, series_file = folder / "post" / "series.txt";
  if (!fs::exists(case_file))
    throw UserError(fmt::format("{}: there is none; give a folder that 'millscope export' has made", case_file.string()));
  const run::Assembly a = run::assemble(config::read_case(case_file.string()), registry);
  const std::vector<Instant> series = series_of(series_file, a, meshes_of(a));
  require_enough(series, a, series_file);
  const double mass = charge_mass(a);
  output::NewFolder aside(out);
  Imported imported{a.bead_count, write_frames(frames_in(folder / "post"), a, aside.path() / "frames.h5"), series.back().time};
  write_series(series, a, mass, aside.path() / "series.csv");
  output::write_file(aside.path() / kResolvedCase, config::resolved_yaml(a.c, registry.descriptors()));
  nlohmann::ordered_json j = summary_of(series, a, mass);
  j["engine"]["version"] = version_in(folder / "log.liggghts");
  j["provenance"] = output::provenance(command_line, {});
  output::write_json(aside.path() / "summary.json", j);
  aside.publish();
  return imported;
}

}  // namespace millscope::engine::liggghts
