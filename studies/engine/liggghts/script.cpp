#include "studies/engine/liggghts/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kernel/base/program.hpp"
#include "kernel/run/recorder.hpp"

namespace millscope::engine::liggghts {
namespace {

/// Lines of a script: a command, blanks up to a column, its words.
class Lines {
 public:
  void add(std::string_view command, const std::string& words) { text_ += fmt::format("{:<15} {}\n", command, words); }
  void say(const std::string& comment) { text_ += "\n# " + comment + "\n"; }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format(" {}", value);
  return text;
}

std::string triple(const base::Vector3& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); }

/// LIGGGHTS reads intervals as 32 bits: none is longer than the whole run and a step.
std::int64_t steps_of(const run::Assembly& a, double seconds) {
  return std::min(run::steps_of(seconds, a.time_step), a.end_step - a.first_step + 1);
}

void add_physics(const run::Assembly& a, const Physics& physics, Lines& lines) {
  lines.say("materials, each an atom type: " + fmt::format("{}", fmt::join(a.materials, ", ")));
  lines.add("fix", "young all property/global youngsModulus peratomtype" + joined(physics.young));
  lines.add("fix", "poisson all property/global poissonsRatio peratomtype" + joined(physics.poisson));
  lines.say(fmt::format("of each pair of types; {:g} where two never meet", kNeverUsed));
  for (const PairProperty& p : physics.pairs)
    lines.add("fix", fmt::format("{0} all property/global {0} peratomtypepair {1}{2}", p.name, a.materials.size(), joined(p.values)));
  lines.add("pair_style", "gran model " + physics.model + physics.settings);
  lines.add("pair_coeff", "* *");
  const double g = std::hypot(a.gravity[0], a.gravity[1], a.gravity[2]);
  if (g > 0) lines.add("fix", fmt::format("gravity all gravity {} vector {} {} {}", g, a.gravity[0], a.gravity[1], a.gravity[2]));
}

void add_walls(const run::Assembly& a, const Physics& physics, const std::vector<MeshFile>& meshes, Lines& lines) {
  if (meshes.empty()) return;
  lines.say("walls; the torque is about the axis of each");
  std::string names;
  for (const MeshFile& mesh : meshes) {
    const dem::Motion& motion = a.system->bodies[mesh.body].motion;
    lines.add("fix",
              fmt::format("{} all mesh/surface/stress file {} type {} curvature {:.6g} curvature_tolerant yes stress on reference_point {}",
                          mesh.id, mesh.file, mesh.type, smooth_degrees(a, mesh), triple(motion.point)));
    names += " " + mesh.id;
  }
  lines.add("fix",
            fmt::format("walls all wall/gran model {} mesh n_meshes {} meshes{}{}", physics.model, meshes.size(), names, physics.settings));
}

/// Ω(t) as a formula of the step (dem::angular_speed), or "" where it is the same from t = 0 on.
std::string speed_formula(const run::Assembly& a, const dem::Motion& m) {
  if (m.start == 0 && m.ramp == 0 && m.ripple_amplitude == 0) return "";
  const std::string steady = fmt::format("((step-{})*{}-{})", zero_step(a), a.time_step, m.start + m.ramp);  // s, since the ramp's end
  std::string formula = fmt::format("{}*({}>=0)", m.speed, steady);
  if (m.ripple_amplitude > 0)
    formula += fmt::format("*(1+{}*sin({}*{}+{}))", m.ripple_amplitude, 2 * std::numbers::pi * m.ripple_frequency, steady, m.ripple_phase);
  if (m.ramp > 0) formula += fmt::format("+{0}*({1}<0)*({1}>{2})*(1+{1}/{3})", m.speed, steady, -m.ramp, m.ramp);
  return formula;
}

void add_motion(const run::Assembly& a, const std::vector<MeshFile>& meshes, Lines& lines) {
  if (a.wall_body_of_mill()) lines.say("the walls turn");
  for (const MeshFile& mesh : meshes) {
    const dem::Motion& m = a.system->bodies[mesh.body].motion;
    if (m.speed == 0) continue;
    const std::string formula = speed_formula(a, m);
    const std::string place = fmt::format("origin {} axis", triple(m.point));
    if (formula.empty()) {
      const double sense = m.speed < 0 ? -1 : 1;
      const base::Vector3 axis{sense * m.axis[0], sense * m.axis[1], sense * m.axis[2]};
      lines.add("fix", fmt::format("turn_{0} all move/mesh mesh {0} rotate {1} {2} period {3}", mesh.id, place, triple(axis),
                                   2 * std::numbers::pi / std::fabs(m.speed)));
    } else {
      lines.add("variable", fmt::format("omega_{} equal {}", mesh.id, formula));
      lines.add("fix",
                fmt::format("turn_{0} all move/mesh mesh {0} rotate/variable {1} {2} omega v_omega_{0}", mesh.id, place, triple(m.axis)));
    }
  }
}

void add_output(const run::Assembly& a, const std::vector<MeshFile>& meshes, std::optional<std::int64_t> restart, Lines& lines) {
  lines.say("what is kept: energies, J; centre of mass, m; torque on each wall, N m; restart files");
  lines.add("compute", "translation all ke");
  lines.add("compute", "rotation all erotate/sphere");
  for (const char* axis : {"x", "y", "z"}) lines.add("variable", fmt::format("centre_{0} equal xcm(all,{0})", axis));
  std::string torques;
  for (const MeshFile& mesh : meshes) torques += fmt::format(" f_{0}[4] f_{0}[5] f_{0}[6]", mesh.id);
  const std::int64_t often = series_every(a);
  lines.add("fix", fmt::format("series all ave/time {} {} {} c_translation c_rotation v_centre_x v_centre_y v_centre_z{} file post/{}",
                               often, kSeriesValues, kSeriesValues * often, torques, name_of_session("series", restart)));
  lines.add("thermo_style", "custom step time atoms ke");
  lines.add("thermo", fmt::format("{}", std::max<std::int64_t>(1, (a.end_step - a.first_step) / 200)));
  lines.add("thermo_modify", "lost error norm no flush yes");
  const std::int64_t row = kSeriesValues * often, far = std::max<std::int64_t>(1000, (a.end_step - a.first_step) / 20);
  lines.add("restart", fmt::format("{} post/restart.*", (far + row - 1) / row * row));  // so that no row is cut in two
}

/// Up to a step of the case, unless the run goes on from beyond it.
void add_run(const run::Assembly& a, std::int64_t step, std::optional<std::int64_t> restart, Lines& lines) {
  const std::int64_t end = zero_step(a) + step;
  if (end > restart.value_or(zero_step(a) + a.first_step)) lines.add("run", fmt::format("{} upto", end));
}

/// All beads, every so many steps: files post/NAME_STEP.txt.
void add_dump(const char* name, std::int64_t every, Lines& lines) {
  lines.add("dump",
            fmt::format("{0}s all custom {1} post/{0}_*.txt id type x y z vx vy vz omegax omegay omegaz radius density", name, every));
  lines.add("dump_modify", fmt::format("{}s sort id format \"%d %d %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\"", name));
}

/// The case's own time, with frames from where the case wants them.
void add_runs(const run::Assembly& a, std::optional<std::int64_t> restart, Lines& lines) {
  if (a.c.output.tracks) {
    const std::vector<std::uint32_t> ids = run::tracked_beads(a);
    constexpr std::size_t kOfOneLine = 100;  // LIGGGHTS reads no line of more than 2 kB
    for (std::size_t i = 0; i < ids.size(); i += kOfOneLine) {
      std::string words;
      for (std::size_t k = i; k < std::min(ids.size(), i + kOfOneLine); ++k) words += fmt::format(" {}", ids[k] + 1);
      lines.add("group", "tracked id" + words);
    }
    lines.add("dump", fmt::format("tracks tracked custom {} post/{} id x y z", track_every(a), name_of_session("tracks", restart)));
    lines.add("dump_modify", "tracks sort id format \"%d %.9g %.9g %.9g\"");
  }
  if (a.c.output.vtk) add_dump("picture", picture_every(a), lines);
  if (a.c.output.frames) {
    add_run(a, frames_from(a), restart, lines);
    add_dump("frame", frame_every(a), lines);
  }
  add_run(a, a.end_step, restart, lines);
}

}  // namespace

Bounds bounds_of(const run::Assembly& a, std::size_t axis) {
  const dem::Settings& s = a.system->settings();
  if (s.periodic.length[axis] > 0) return {s.periodic_low[axis], s.periodic_low[axis] + s.periodic.length[axis]};
  return {s.low[axis], s.high[axis]};
}

std::int64_t series_every(const run::Assembly& a) { return std::max<std::int64_t>(1, steps_of(a, 0.01) / kSeriesValues); }

std::int64_t frame_every(const run::Assembly& a) { return steps_of(a, a.c.output.frames->every); }

std::int64_t picture_every(const run::Assembly& a) { return steps_of(a, a.c.output.vtk->every); }

std::int64_t track_every(const run::Assembly& a) { return steps_of(a, a.c.output.tracks->every); }

std::int64_t frames_from(const run::Assembly& a) {
  return std::min(a.end_step, static_cast<std::int64_t>(std::llround(std::min(a.c.output.frames->from, a.c.time.end) / a.time_step)));
}

std::int64_t zero_step(const run::Assembly& a) {
  const std::int64_t two = std::lcm(a.c.output.frames ? frame_every(a) : 1, a.c.output.tracks ? track_every(a) : 1);
  const std::int64_t often = std::lcm(two, a.c.output.vtk ? picture_every(a) : 1);
  return (-a.first_step + often - 1) / often * often;
}

std::string data_of(const run::Assembly& a) {
  const dem::Particles& p = a.system->particles;
  const auto n = static_cast<std::size_t>(p.count());
  std::string text = fmt::format("{}: beads before they settle\n\n{} atoms\n{} atom types\n\n", a.c.name, n, a.materials.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Bounds b = bounds_of(a, axis);
    text += fmt::format("{1} {2} {0}lo {0}hi\n", "xyz"[axis], b.low, b.high);
  }
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p.id[i] < p.id[j]; });
  std::string velocities = "\nVelocities\n\n";
  text += "\nAtoms\n\n";
  for (const std::size_t i : order) {
    const dem::PositionLine& x = p.position[i];
    const dem::MotionLine& m = p.motion[i];
    const double volume = config::sphere_volume(2 * x.radius);
    base::Vector3 centre;
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] = dem::wrapped(a.system->settings(), static_cast<int>(axis), x.centre[axis]);
    text += fmt::format("{} {} {} {} {}\n", p.id[i] + 1, p.material[i] + 1, 2 * x.radius, 1 / (m.inverse_mass * volume), triple(centre));
    velocities += fmt::format("{} {} {}\n", p.id[i] + 1, triple({m.v[0], m.v[1], m.v[2]}), triple({m.w[0], m.w[1], m.w[2]}));
  }
  return text + velocities;
}

std::string name_of_session(const std::string& what, std::optional<std::int64_t> restart) {
  return restart ? fmt::format("{}.{}.txt", what, *restart) : what + ".txt";
}

std::vector<std::int64_t> steps_of_files(const std::filesystem::path& folder, const std::string& what) {
  std::vector<std::int64_t> steps;
  if (!std::filesystem::is_directory(folder)) return steps;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(what + ".")) continue;
    std::int64_t step = 0;
    const char *first = name.data() + what.size() + 1, *last = name.data() + name.size();
    const auto [behind, failed] = std::from_chars(first, last, step);
    if (failed == std::errc{} && (behind == last || std::string_view(behind, last) == ".txt")) steps.push_back(step);
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

std::vector<Session> sessions_of(const std::filesystem::path& post, const std::string& what) {
  constexpr std::int64_t kFirst = -1, kLast = std::numeric_limits<std::int64_t>::max();
  std::vector<Session> sessions{{post / name_of_session(what, {}), kFirst, kLast}};
  for (const std::int64_t step : steps_of_files(post, what)) {
    sessions.back().until = step;
    sessions.push_back({post / name_of_session(what, step), step, kLast});
  }
  return sessions;
}

std::string script_of(const run::Assembly& a, const Physics& physics, const std::vector<MeshFile>& meshes,
                      std::optional<std::int64_t> restart) {
  Lines lines;
  lines.say(fmt::format("{}: made by millscope {} for LIGGGHTS 3.8", a.c.name, base::version()));
  lines.add("units", "si");
  lines.add("atom_style", "granular");
  for (const char* axis : {"x", "y", "z"}) lines.add("variable", fmt::format("p{} index *", axis));  // -var pz 4: ranks along each
  lines.add("processors", "${px} ${py} ${pz}");
  lines.add("atom_modify", "map array sort 1000 0");
  lines.add("communicate", "single vel yes");
  lines.add("soft_particles", "yes");  // Young's moduli below 5 MPa and above 1 GPa are refused without
  lines.add("hard_particles", "yes");
  std::string boundary;
  for (std::size_t axis = 0; axis < 3; ++axis) boundary += a.system->settings().periodic.length[axis] > 0 ? " p" : " f";
  lines.add("boundary", boundary.substr(1));
  lines.add("newton", "off");
  if (restart) {
    lines.add("read_restart", fmt::format("post/restart.{}", *restart));
  } else {
    lines.add("read_data", "beads.data");
    lines.add("reset_timestep", fmt::format("{}", zero_step(a) + a.first_step));
  }
  lines.add("neighbor", fmt::format("{:.6g} bin", 0.3 * a.c.smallest_diameter()));
  lines.add("neigh_modify", "delay 0");
  add_physics(a, physics, lines);
  add_walls(a, physics, meshes, lines);
  lines.add("timestep", fmt::format("{}", a.time_step));
  lines.add("fix", "move all nve/sphere");
  add_output(a, meshes, restart, lines);
  lines.say(fmt::format("the charge falls with the walls at rest, up to t = 0, which is step {}", zero_step(a)));
  add_run(a, 0, restart, lines);
  add_motion(a, meshes, lines);
  add_runs(a, restart, lines);
  return lines.take().substr(1);
}

}  // namespace millscope::engine::liggghts
