// How tracks become results: the one road that recordings and simulations share. On it every verdict stands: what differs between the two
// sides of a comparison would pass for physics.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "studies/analysis/instances.hpp"
#include "studies/analysis/recorded_mill.hpp"
#include "studies/analysis/results.hpp"
#include "studies/calibrate/study.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::calibrate {

/// What a recording says of its tracks. It decides how each track of its condition is cleaned, smoothed and cut into blocks, also a
/// simulated bead's.
struct Smoothing {
  std::array<double, 3> noise{};      ///< standard deviation of each component of a point, m
  double noise_correlation = 0;       ///< from one point to the next
  std::array<double, 3> roughness{};  ///< of the motion, about: random acceleration of each component, m²/s³
  double gap_limit = 0;               ///< s
  recording::Travel travel;           ///< what a bead can do
  analysis::BlockLengths blocks;      ///< by what it forgets
  bool operator==(const Smoothing&) const = default;
};
Smoothing smoothing_of(const recording::Recording& recording);  ///< but for the blocks, which come from its results

/// Which side of the comparison a track is on.
enum class Side { recorded, simulated };

/// The options by which each track of a condition is followed. The sides differ in two things alone: `z_low` and `z_high` are places along
/// the recorded mill, and beads that no camera has seen (camera: exact) have none of the recording's noise, each track tells its own.
trajectory::TrajectoryOptions trajectory_options(Side side, const Smoothing& smoothing, const Observing& observing);

/// Tracks of a condition with the mill that they were made in.
struct Tracks {
  const recording::Recording& recording;
  analysis::RecordedMill mill;
  Side side = Side::recorded;
};

struct Processing {
  const Study& study;
  const host::Registry& registry;
  int threads = 0;
  /// Read beforehand: what reads the study's file must not be done by several threads.
  std::vector<analysis::AskedAnalyzer> analyzers = {};
  std::string own_analyzers = {};  ///< the study's section `analyzers` as text; empty: it has none
  bool all_uncertain = true;       ///< false: only what becomes a summary gets an uncertainty
};

/// Tracks through spline and analyzers. Those that cannot be followed are left out, and `notes` of the results' meta names them.
analysis::ResultSet process(const Tracks& tracks, const Smoothing& smoothing, const Processing& how);

/// An analyzer that the observables rest on, with its parameters as in analysis.yaml: no bins or maps that nothing is made of.
struct UsedAnalyzer {
  std::string_view plugin, parameters;
};
inline constexpr UsedAnalyzer kDistributions{"distributions",
                                             "{bins_x: 50, bins_y: 50, bins_z: 1, bins_r: 1, bins_speed: 60, largest_speed: 3}"};
inline constexpr UsedAnalyzer kPower{"power", "{cells_x: 1, cells_y: 1}"};
inline constexpr UsedAnalyzer kPowerOfTerms{"power", "{cells_x: 25, cells_y: 25}"};  ///< where a term may ask for Bbosa's sum
inline constexpr std::array<UsedAnalyzer, 3> kUsedAnalyzers{
    {kDistributions, kPower, {"pept_grid", "{cells_x: 24, cells_y: 24, maps: occupancy_and_speed}"}}};

/// Those behind the observables, and those of the study's own section `analyzers`. Throws base::UserError.
std::vector<analysis::AskedAnalyzer> analyzers_of(const Study& study, const host::Registry& registry);
/// Those of a text as in analysis.yaml, alone.
std::vector<analysis::AskedAnalyzer> analyzers_of(const std::string& text, const host::Registry& registry);

}  // namespace millscope::calibrate
