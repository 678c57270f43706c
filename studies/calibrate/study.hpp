// study.yaml: what is to be calibrated, on which recordings, how. docs/calibrate.md explains the keys.
//
//   base: slice_75.yaml
//   conditions:
//     dry75: {set: {mill.speed: 75 %critical}, recording: r75.yaml, role: fit}
//     dry50: {set: {mill.speed: 50 %critical}, recording: r50.yaml, role: held_out}
//   parameters:
//     pairs.glass~glass.static_friction: {range: [0.1, 0.8], name: CFPP}
//   objective: likelihood
//   method: emulator
//   budget: {simulations: 60, wall: 75 min}
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kernel/config/document.hpp"
#include "kernel/host/registry.hpp"
#include "studies/calibrate/observation.hpp"

namespace millscope::calibrate {

enum class Role { fit, held_out };

/// One state of the mill with the recording made in it.
struct Condition {
  std::string name;
  std::vector<std::string> settings;  ///< "mill.speed=75 %critical", laid on the base case
  std::filesystem::path recording;
  Role role = Role::fit;
  base::Location where;
};

/// One number of the case that is looked for.
struct Parameter {
  std::string path;                      ///< "pairs.glass~glass.static_friction"
  std::string name;                      ///< short, for tables; unique: `name`, else the path's last word, else the path
  double low = 0, high = 0;              ///< SI
  std::vector<std::string> tied;         ///< paths that take the same value
  std::optional<double> centre, spread;  ///< of the first design: `centre`, `step`; default: the middle, a quarter of the range
  base::Location where;
};

/// An inequality between parameters, e.g. "mu_r < 0.5 * mu_s".
struct Constraint {
  std::string text;
  std::function<bool(const Eigen::VectorXd&)> holds;
};

enum class ObjectiveKind { chagas2015, likelihood };

/// A number of an analyzer that enters the objective besides the usual ones.
struct Term {
  std::string analyzer, result;
  double weight = 1;  ///< chagas2015: per percent of the recorded value
  base::Location where;
  std::string name() const { return analyzer + "." + result; }
};

struct ObjectiveChoice {
  ObjectiveKind kind = ObjectiveKind::likelihood;
  std::vector<Term> terms;
  std::vector<ObservableKind> without;  ///< kinds of observables that are left out
};

enum class Method { response_surface, emulator, cma_es };

/// `design`: what the methods do with the budget.
struct DesignChoice {
  std::vector<std::string> generators;  ///< of the screening design: "CFPG=CRPP*CFPP*CRPG"; none: the full factorial
  int screening_centre_points = 3;
  int descent_steps = 6;            ///< at most
  int kept_factors = 2;             ///< with the largest effects, that go on to the central composite design
  double composite_step = 0.5;      ///< of the screening's step
  std::string axial = "rotatable";  ///< or "face_centred"
  int composite_centre_points = 5;
  std::string start = "latin_hypercube";  ///< of the emulator; or "sobol"
  int start_runs = 0;                     ///< 0: half of the budget, at most ten per parameter
  int batch = 2;                          ///< points that are chosen at once; part of the result, so never taken from the cores
  std::uint64_t seed = 1;
};

struct Budget {
  int simulations = 60;  ///< of the fit conditions; validation comes on top
  double wall = 0;       ///< s; 0: no limit. Counted from the simulations' own times, so that it holds over interruptions
};

/// How a simulation is looked at.
struct Observing {
  std::string camera = "recording";     ///< "recording": estimated from it; "exact"; or a file
  int beads = 1000;                     ///< of the charge, that the virtual camera follows
  std::optional<double> z_low, z_high;  ///< m, part of the recording's mill along the axis that is used
  int draws = 200;                      ///< resamples behind every covariance
  bool camera_is_file() const { return camera != "recording" && camera != "exact"; }
};

struct Study {
  std::filesystem::path file, base;
  base::Location base_place;
  std::vector<Condition> conditions;  ///< in the order of the file
  std::vector<Parameter> parameters;
  std::vector<Constraint> constraints;
  ObjectiveChoice objective;
  Method method = Method::emulator;
  DesignChoice design;
  Budget budget;
  std::string runner = "local";
  Observing observing;
  double power_error = 0.005;  ///< of the mill's speed and the power meter together, relative; 0 … 0.5
  config::Node root;           ///< for `analyzers`, which are chosen where they are needed

  Eigen::VectorXd low() const;
  Eigen::VectorXd high() const;
  bool allowed(const Eigen::VectorXd& point) const;  ///< all constraints hold
  std::vector<std::size_t> with_role(Role role) const;
};

/// "path=value" for every parameter and what is tied to it.
std::vector<std::string> settings_of(const Study& study, const Eigen::VectorXd& point);

/// Sections of a study that `diagnose` reads and `calibrate` has no use for: one file may serve both.
inline constexpr std::array<std::string_view, 4> kDiagnoseSections{"nuisances", "hypotheses", "bank", "level"};

/// Reads the file alone; `also`: sections that another room reads from `Study::root`. Throws base::UserError with file:line.
Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                 std::span<const std::string_view> also = {});

/// Holds the study against the plugins and the base case: unknown or idle parameters, values that a plugin refuses. Its recordings are not
/// read for that: see check_recordings. Throws base::UserError.
void check_study(const Study& study, const host::Registry& registry);

/// Leaves of a map as "path=value", as `--set` takes them, paths below the map; a list is one value.
std::vector<std::string> settings_below(const config::Node& map);

const char* name_of(Method method);
const char* name_of(ObjectiveKind kind);

}  // namespace millscope::calibrate
