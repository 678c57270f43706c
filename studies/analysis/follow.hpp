// One road from runs of points to a source of blocks. A recorded tracer, a simulated bead of tracks.h5 and a bead that the virtual camera
// has seen all go along it, so that their results can be compared.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/analysis/trajectory_source.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::analysis {

/// The points of one bead, with what they do not tell themselves.
struct BeadRun {
  const recording::Run* run = nullptr;
  trajectory::TrajectoryOptions options;
  double diameter = 0, density = 0;               ///< m, kg/m³; 0: unknown
  std::optional<std::int64_t> id = std::nullopt;  ///< of the bead; nothing: its number among those that are followed
};

struct FollowRequest {
  std::string of;                           ///< file that the runs are of, for messages
  const char *one = "run", *many = "runs";  ///< what each of them is called
  AnalyzerContext mill{};
  ShellMotion motion = {};
  double period = 0;   ///< along z from mill.mill_low, m, into which places are put back; 0: not periodic
  bool exact = false;  ///< positions without noise
  bool named = false;  ///< the user named each run: one that cannot be followed is an error
  int threads = 0;     ///< 0: all cores; no influence on results
};

struct Followed {
  std::unique_ptr<FrameSource> source;
  std::vector<std::size_t> runs;  ///< numbers of those behind the source, rising
  std::uint64_t points = 0;       ///< of them
  std::uint64_t points_left_out = 0;
  std::vector<std::string> notes;  ///< which runs cannot be followed and are left out, and why
};

/// The runs of a recording, all of its one kind of tracer. They point into it.
std::vector<BeadRun> tracer_runs(const recording::Recording& recording, const trajectory::TrajectoryOptions& options);

/// A run of which no stretch is long enough between its gaps is left out and named: of many runs some are always short, and they must not
/// take the others with them. Throws base::UserError, with the reason of the first, where nothing is left, or where it was `named`.
Followed follow(std::span<const BeadRun> runs, FollowRequest request);

/// Ω as it is stated or found, the same at all times; unknown where it is 0.
ShellMotion even_motion(double omega);

}  // namespace millscope::analysis
