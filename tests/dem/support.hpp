// Small systems for the tests: a case from YAML text, beads placed by hand.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "kernel/run/assembly.hpp"

namespace dem_test {

using namespace millscope;
using Vector = std::array<double, 3>;
using run::Assembly;

inline constexpr double kRadius = 2.5e-3, kDensity = 2500.0;  // of a bead, unless said otherwise
inline constexpr double kGravity = 9.81;

/// The plugins of this build; `level`: "v2", "v3", "v4" or "" for the best.
const host::Registry& registry(const std::string& level = "");
/// The levels that this machine runs.
std::vector<std::string> levels();

/// Sections of a case as YAML flow text. Materials: glass (beads), heavy (beads), wall.
struct Setup {
  std::string law = "{kind: hertz_mindlin}";
  std::string pairs = "restitution: 0.8, static_friction: 0.3";  ///< of every pair of materials …
  std::string wall_pairs;                                        ///< … those with the wall, when they differ
  std::string beads = "{glass: {material: glass, diameter: 5 mm}}";
  std::string fill = "{count: 1, settle_s: 0}";
  std::string interactions = "{}", pair_parameters = "{}", wear = "{}";
  std::string body_forces = "{}";  ///< or "{gravity: {kind: gravity}}"
  std::string geometry = "{}";
  std::string domain = "{low: [-10, -10, -10], high: [10, 10, 10]}";
  std::string time = "{end_s: 100, step_fraction: 0.2}";
  std::string run = "{partitions: 1}";
  std::string mill;
  double stiffness_factor = 1e-3;
  std::string text() const;
};

inline const std::string kWithGravity = "{gravity: {kind: gravity}}";
/// The plane y = 0 under the beads.
inline const std::string kFloor = "{floor: {kind: plane, point: [0, 0, 0], normal: [0, 1, 0], material: wall}}";

Assembly assembled(const Setup& setup, const run::AssemblyOptions& options = {1, ""}, const std::string& level = "");

struct Bead {
  Vector position{}, velocity{}, spin{};
  double radius = kRadius, density = kDensity;
  int material = 0;
};

/// Puts the beads in, moving freely under gravity until now: velocities belong to step 0.
void place(Assembly& a, const std::vector<Bead>& beads);
/// place + start at step 0.
void start(Assembly& a, const std::vector<Bead>& beads);
/// The same for beads that touch already: half steps are taken back with the accelerations of step 0.
void start_in_contact(Assembly& a, const std::vector<Bead>& beads);

void advance(Assembly& a, std::int64_t steps);

/// Index of the bead with that id.
std::size_t index_of(const Assembly& a, std::uint32_t id);
Vector position(const Assembly& a, std::uint32_t id);
/// v and ω half a step ago: between free flights and for sums that leapfrog keeps exactly.
Vector velocity(const Assembly& a, std::uint32_t id);
Vector spin(const Assembly& a, std::uint32_t id);
double mass(const Assembly& a, std::uint32_t id);
double inertia(const Assembly& a, std::uint32_t id);

/// Energies at one step, taken where the system says they are valid.
struct Energy {
  double kinetic = 0, elastic = 0, potential = 0, dissipated = 0, wall_work = 0;
  double stored() const { return kinetic + elastic + potential; }
};
/// Advances one step and gives the energies at its beginning.
Energy observed(Assembly& a);

/// A box of 30 × 60 × 30 mm with 200 beads, shaken: the book over 0.4 s after 0.15 s.
struct Book {
  double input = 0, lost = 0, kept = 0;  ///< J
};
Book shaken_box(Setup s);

/// What System::save gives, by name.
struct Saved {
  std::map<std::string, std::vector<double>> doubles;
  std::map<std::string, std::vector<std::int64_t>> integers;
};
Saved saved(const Assembly& a);
void restore(Assembly& a, const Saved& s);

double length(const Vector& v);
Vector minus(const Vector& a, const Vector& b);
Vector plus(const Vector& a, double factor, const Vector& b);
Vector cross(const Vector& a, const Vector& b);

/// E* of bead and wall (or bead and bead) of the test's glass, Pa.
double effective_young(double stiffness_factor);
double bead_mass(double radius = kRadius, double density = kDensity);
/// Overlap at which Hertz carries the sphere on a plane inclined by `slope`, m.
double resting_overlap(double stiffness_factor, double slope = 0);

}  // namespace dem_test
