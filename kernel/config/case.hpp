// One simulation as its YAML file says it: plain structs, SI numbers, places kept for later messages. Every
// key stands beside its member with unit, default and range.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/base/vector3.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/pairs.hpp"
#include "millscope/abi.hpp"

namespace millscope::config {

using base::Vector3;

inline constexpr int kSchemaVersion = 1;

/// `materials.NAME`.
struct MaterialCase {
  std::string name;
  double density = 0;    ///< `density`, kg/m³, > 0
  double young = 0;      ///< `young_modulus`, or 2 G (1 + ν) from `shear_modulus`; Pa, > 0, the real one (before softening)
  double poisson = 0;    ///< `poisson_ratio`, −1 < ν < 0.5
  std::string citation;  ///< `citation`, free text
  Location where;
};

/// One size of a bead class.
struct SizeClass {
  double diameter = 0;         ///< m, > 0
  double number_fraction = 1;  ///< of the beads of the class; the sizes of a class sum to 1
};

/// `beads.NAME`. Fractions (`fractions_by: mass|number`, default mass) and shares (`fill.shares_by`, default mass)
/// are turned into numbers. A `distribution: {kind: normal|lognormal|uniform, mean, deviation, low, high, bins}` becomes `bins` sizes
/// (default 11) of even width from `low` to `high` (default: three deviations each way; for lognormal, of the logarithm).
struct BeadCase {
  std::string name;
  std::string material;
  double density = 0;            ///< kg/m³; the material's unless `density` is given
  std::vector<SizeClass> sizes;  ///< from `diameter`, `sizes` or `distribution`; in the order of the file
  double number_share = 1;       ///< of all beads; the classes sum to 1
  bool tracer = false;           ///< beads that are followed are of this class
  Location where;

  double mean_volume() const;  ///< m³ per bead
};

/// The cylinder on which a filling is counted: the bare shell.
struct Vessel {
  double diameter = 0;  ///< m
  double length = 0;    ///< m
};

/// A box; unbounded sides are ±infinity.
struct Box {
  Vector3 low{}, high{};
};

/// A bead that a file puts in its place (bead_file.hpp).
struct PlacedBead {
  std::size_t line = 0;                  ///< of the file, from 1
  Vector3 centre{}, velocity{}, spin{};  ///< m, m/s, rad/s
  double diameter = 0;                   ///< m
  std::string material;                  ///< "" where the file names none
  std::size_t bead_class = 0;            ///< of Case::beads
};

/// `fill`: exactly one of `count`, `mass`, `filling`, `file`.
struct FillCase {
  std::optional<std::uint64_t> count;
  std::string file;                ///< of beads that are put where it says; "": none
  std::vector<PlacedBead> placed;  ///< what it holds, in its order
  std::optional<double> mass;      ///< kg, > 0
  std::optional<double> filling;   ///< J, 0 < J ≤ 1, on the bare shell's volume
  double porosity = 0.37;          ///< φ of the bed at rest, 0 ≤ φ < 1; used with `filling`
  std::optional<Vessel> vessel;    ///< default: the geometry's interior, its length the period when the axis is periodic
  std::optional<Box> region;       ///< where beads are put, m; default: the geometry's interior
  double settle = 0.3;             ///< `settle_s`, s ≥ 0: time that the charge falls with the walls at rest before t = 0; of a file 0
  Location where;
};

/// A named plugin object; the keys of `node` that are not the reader's are the plugin's own.
struct PluginInstance {
  std::string name;
  std::string kind;  ///< name of the plugin
  Node node;
  Location where;
};

/// `contact`.
struct ContactCase {
  PluginInstance law;
  std::vector<PluginInstance> interactions;  ///< in the order of the file
  std::vector<PluginInstance> pair_parameters;
  std::vector<PluginInstance> wear;  ///< what beads take away from walls; counted from `time.analyze_from_s` on
};

enum class Direction { counter_clockwise, clockwise };

/// `mill`.
struct MillCase {
  double speed = 0;                      ///< Ω about z, rad/s, signed: counter_clockwise > 0
  std::optional<double> diameter;        ///< `diameter` D_m, m: for speeds in %critical and for reports
  std::optional<double> critical_speed;  ///< rad/s, > 0; 42.3/√(D_m − d_b) rpm when the diameter is known
  Direction direction = Direction::counter_clockwise;
};

/// Speed multiplied by 1 + amplitude · sin(2π frequency t + phase).
struct RippleCase {
  double amplitude = 0;            ///< 1, 0…1
  double frequency = 0;            ///< Hz, ≥ 0; 0 only where `per_turn` is of a body that does not turn
  double phase = 0;                ///< rad
  std::optional<double> per_turn;  ///< `per_turn`, > 0: in place of `frequency`, which follows the speed
};

/// `motion.rotation`.
struct RotationCase {
  bool follows_mill = true;  ///< `speed: mill` (default)
  double speed = 0;          ///< rad/s about `axis`, signed; the mill's when it follows it
  Vector3 axis{0, 0, 1};     ///< unit
  Vector3 point{0, 0, 0};    ///< m
  double start = 0;          ///< `start_s`, s ≥ 0: at rest before
  double ramp = 0;           ///< `ramp_s`, s ≥ 0: linear rise from rest after `start`
  std::optional<RippleCase> ripple;
};

/// `motion.translation`: velocity · t + amplitude · sin(2π frequency t + phase).
struct TranslationCase {
  Vector3 velocity{};    ///< m/s
  Vector3 amplitude{};   ///< `oscillation.amplitude`, m
  double frequency = 0;  ///< `oscillation.frequency`, Hz
  double phase = 0;      ///< `oscillation.phase`, rad
  double start = 0;      ///< `start_s`, s ≥ 0
};

/// `motion`: `fixed` (default), `mill` (= `{rotation: {speed: mill}}`) or a map.
struct MotionCase {
  std::optional<RotationCase> rotation;
  std::optional<TranslationCase> translation;
};

/// `geometry.NAME`.
struct GeometryCase {
  PluginInstance plugin;
  std::string material;                                        ///< `material`: of every slot that `materials` does not name; "" when absent
  std::vector<std::pair<std::string, std::string>> materials;  ///< `materials`: slot → material
  MotionCase motion;

  /// The material of a slot. Throws UserError when neither `materials` nor `material` says it.
  const std::string& material_of(std::string_view slot) const;
};

/// `domain`. Axis 0, 1, 2 = x, y, z.
struct DomainCase {
  std::array<bool, 3> periodic{};
  Box box;  ///< period of periodic axes; on others a wall-less limit beyond which a bead is lost; ±infinity: none
};

/// `time`.
struct TimeCase {
  double end = 0;              ///< `end_s`, s, > 0
  double analyze_from = 0;     ///< `analyze_from_s`, s, 0 ≤ … < end; default half of the end
  std::optional<double> step;  ///< `step_s`, s, > 0; excludes step_fraction
  double step_fraction = 0.2;  ///< of the Rayleigh time, 0 < … ≤ 1
  Location where;
};

/// `start`: the beads begin where another run ended, in place of being filled in and settled.
struct StartCase {
  std::string run;     ///< `run`: folder of a finished run of the same geometry and motion, absolute
  double develop = 0;  ///< `develop_s`, s, 0 < … ≤ analyze_from_s: from the start to the analysis
  std::optional<double>
      walls_ahead{};  ///< `walls_ahead_s`, s: by how much the walls' clock is ahead of the run's; a run finds it out itself
  Node node;
};

/// `output`. Absent or `off`: not written; `series` and `checkpoint` are on by default. `frames: {}` takes the defaults below.
struct OutputCase {
  struct Series {
    double every = 0.01;  ///< `every_s`, s
  };
  struct Frames {
    double every = 0.005;  ///< `every_s`, s
    double from = 0;       ///< `from_s`, s; default: analyze_from_s
  };
  struct Tracks {
    std::uint64_t count = 1;         ///< `beads: n`: that many, chosen by the seed
    std::vector<std::uint64_t> ids;  ///< `beads: [ids]`: these; then `count` is their number
    double every = 0.0005;           ///< `every_s`, s
  };
  struct Vtk {
    double every = 0.05;  ///< `every_s`, s
  };
  struct Checkpoint {
    double every_wall = 300;  ///< `every_wall_s`, s of wall time
  };
  std::optional<Series> series = Series{};
  std::optional<Frames> frames;
  std::optional<Tracks> tracks;
  std::optional<Vtk> vtk;
  std::optional<Checkpoint> checkpoint = Checkpoint{};
};

/// `run`.
struct RunCase {
  int threads = 0;              ///< 0: as many as the machine has; no influence on results
  int partitions = 0;           ///< slabs, 1…4096: an input of the result's last bits; 0: as many as suit the number of beads
  double skin = 0.2;            ///< neighbour-list skin in largest bead diameters, 0 < … ≤ 2
  bool allow_unstable = false;  ///< run with a time step that the check refuses
  std::string engine;           ///< another program that moves the beads; empty: this one
  int ranks = 1;                ///< processes of that program
};

/// A whole case.
struct Case {
  std::string file;  ///< as given by the user
  std::string name;  ///< default: the file's stem
  std::uint64_t seed = 1;
  double stiffness_factor = 1;  ///< on every body's Young's modulus, 0 < … ≤ 1
  std::vector<MaterialCase> materials;
  std::vector<BeadCase> beads;
  FillCase fill;
  ContactCase contact;
  PairTable pairs;
  std::vector<PluginInstance> body_forces;
  std::optional<MillCase> mill;
  std::vector<GeometryCase> geometry;
  DomainCase domain;
  TimeCase time;
  std::optional<StartCase> start;
  OutputCase output;
  RunCase run;
  Node root;

  double walls_ahead() const { return start ? start->walls_ahead.value_or(0) : 0; }  ///< s

  const MaterialCase& material(std::string_view material_name) const;
  double softened_young(const MaterialCase& m) const { return stiffness_factor * m.young; }  ///< Pa
  double largest_diameter() const;                                                           ///< m
  double smallest_diameter() const;                                                          ///< m
  double mean_bead_volume() const;                                                           ///< m³, over classes and sizes
  double mean_bead_mass() const;                                                             ///< kg
  bool has_tracers() const;                                                                  ///< some class says `tracer: true`
  /// Whether a bead of this radius, m, and mass, kg, may be followed: it is like a bead of a tracer class, or no class is one. Beads that
  /// are alike may stand for each other.
  bool may_be_followed(double radius, double bead_mass) const;
  /// Of the beads like this one the part, by number, that is of tracer classes: the charge may hold the like. 0 where no class is one.
  double tracer_part(double radius, double bead_mass) const;
};

/// Reads and checks a case; `overrides` are "path.to.key=value". The plugins' own keys are checked by `resolve`; when every plugin has
/// been resolved, call `finish`. Throws UserError.
Case read_case(const std::string& file, const std::vector<std::string>& overrides = {});
/// The same from text.
Case parse_case(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

/// Checks what is left: resolves every plugin instance and every entry of `pairs` whose plugin is among `descriptors` (types, units,
/// ranges; a value that only an unused pair lacks is no error), then throws UserError for any key that nobody has read. Without
/// descriptors every plugin must have been resolved before.
void finish(const Case& c, std::span<const Descriptor* const> descriptors = {});

/// m³, of a bead of this diameter, m.
double sphere_volume(double diameter);

/// Critical speed in rad/s: 42.3/√(D_m − d_b) rpm, D_m and d_b in m (Chagas 2015, Eq. 3.1). Requires D_m > d_b.
double critical_speed(double mill_diameter, double bead_diameter);

/// Number of beads that `fill` asks for. `vessel` is used for a filling when the case names none: round(J V (1 − φ) / mean volume).
/// Throws UserError when a filling has no vessel or gives no bead.
std::uint64_t bead_count(const Case& c, const std::optional<Vessel>& vessel = {});

}  // namespace millscope::config
