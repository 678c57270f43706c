// From a case and the loaded plugins to a system that can be stepped.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/config/case.hpp"
#include "kernel/dem/system.hpp"
#include "kernel/host/objects.hpp"

namespace millscope::run {

/// A geometry of the case with what the run needs to know of it.
struct GeometryUse {
  host::GeometryObject object;
  std::vector<std::string> slots;
  Surface surface{};
  Interior interior{};
};

/// More steps than any run will take, and few enough to be counted exactly.
inline constexpr double kMostSteps = 1e15;
/// From one output to the next, `interval` s apart: at least one. An interval beyond any run is as good as never.
std::int64_t steps_of(double interval, double time_step);

/// Everything a run is made of. Movable only.
struct Assembly {
  config::Case c;
  std::vector<std::string> materials;  ///< index → name
  std::vector<host::LawObject> laws;
  std::vector<host::InteractionObject> interactions;
  std::vector<host::PairParameterObject> pair_parameters;
  std::vector<host::WearLawObject> wear_laws;
  std::vector<host::BodyForceObject> body_forces;
  std::vector<GeometryUse> geometries;
  std::unique_ptr<dem::System> system;

  double rayleigh_time = 0;          ///< s, of the smallest and softest bead
  double time_step = 0;              ///< s
  double typical_speed = 0;          ///< m/s
  double hertz_contact_time = 0;     ///< s, shortest over the pairs at the typical speed; Hertz's where the law gives none
  bool stiffness_from_young = true;  ///< by what the law says, its contacts get shorter where materials get stiffer
  double mill_speed = 0;             ///< Ω about z, rad/s
  std::int64_t first_step = 0;       ///< below 0: of settling, with the walls at rest
  std::int64_t end_step = 0, analyze_step = 0;
  std::uint64_t bead_count = 0;
  std::array<double, 3> gravity{};

  int index_of_material(const std::string& name) const;
  std::optional<int> wall_body_of_mill() const;  ///< index of the first body that rotates
};

struct AssemblyOptions {
  int threads = 0;  ///< 0: what the case says
  std::string instruction_set;
};

/// Creates every plugin object, derives the time step and checks it; no beads yet. Throws UserError.
Assembly assemble(config::Case c, const host::Registry& registry, const AssemblyOptions& options = {});

/// Puts the beads in: so that none overlaps another or a wall, or, where the case has a `start`, as another run left them (warm_start.cpp).
/// Throws UserError when they do not fit.
void insert_beads(Assembly& a);

/// first_step … end_step are absolute: time = step · Δt.
void begin(Assembly& a);

/// The shortest contact of any pair at this closing speed, m/s, in s: as its law says, Hertz's where it says nothing.
double shortest_contact(const Assembly& a, double speed);

/// Rayleigh time π R √(ρ/G)/(0.1631 ν + 0.8766), s.
double rayleigh_time(double radius, double density, double young, double poisson);

}  // namespace millscope::run
