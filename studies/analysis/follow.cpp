#include "studies/analysis/follow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/base/parallel.hpp"

namespace millscope::analysis {
namespace {

using base::UserError;

constexpr std::size_t kNamed = 3;  // runs that are named with their reason; the others are counted

/// A trajectory, or why there is none.
struct Outcome {
  std::optional<trajectory::Trajectory> trajectory;
  std::string reason;
};

void wrap(std::vector<double>& z, double low, double period) {
  for (double& value : z) value -= period * std::floor((value - low) / period);
}

Outcome follow_one(const BeadRun& bead, const FollowRequest& request) {
  const recording::Run& run = *bead.run;
  if (std::ssize(run.time) < bead.options.least_points)
    return {{}, fmt::format("{}: its {} points are too few, at least {} are needed", run.source, run.size(), bead.options.least_points)};
  try {
    Outcome outcome{trajectory::fit_trajectory(run, bead.options), {}};
    trajectory::Trajectory& t = *outcome.trajectory;
    t.diameter = bead.diameter;
    t.density = bead.density;
    if (request.period > 0) {
      for (trajectory::Piece& piece : t.pieces) wrap(piece.position[2], request.mill.mill_low, request.period);
      wrap(t.location_position[2], request.mill.mill_low, request.period);
    }
    return outcome;
  } catch (const UserError& e) {
    return {{}, e.what()};
  }
}

/// "2 of 40 runs are left out: …"
std::string left_out(const std::vector<Outcome>& outcomes, const FollowRequest& request) {
  std::size_t count = 0;
  std::string reasons;
  for (const Outcome& outcome : outcomes) {
    if (outcome.trajectory) continue;
    if (++count <= kNamed) reasons += (count > 1 ? "; " : "") + outcome.reason;
  }
  if (count > kNamed) reasons += fmt::format("; and {} more", count - kNamed);
  return fmt::format("{} of {} {} {} left out: {}", count, outcomes.size(), request.many, count == 1 ? "is" : "are", reasons);
}

}  // namespace

ShellMotion even_motion(double omega) {
  if (omega == 0) return {};
  return {[omega](double) { return omega; }, {}};
}

std::vector<BeadRun> tracer_runs(const recording::Recording& recording, const trajectory::TrajectoryOptions& options) {
  const recording::Condition& c = recording.condition;
  const double diameter = c.tracer.diameter.value_or(c.bead_diameter.value_or(0));
  const double density = c.tracer.density.value_or(c.bead_density.value_or(0));
  std::vector<BeadRun> runs;
  for (const recording::Run& run : recording.runs) runs.push_back({&run, options, diameter, density});
  return runs;
}

Followed follow(std::span<const BeadRun> runs, FollowRequest request) {
  std::vector<Outcome> outcomes(runs.size());
  base::for_each_item(runs.size(), base::worker_count(request.threads, runs.size()),
                      [&](std::size_t i, std::size_t) { outcomes[i] = follow_one(runs[i], request); });
  Followed followed;
  std::vector<trajectory::Trajectory> trajectories;
  double seconds = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!outcomes[i].trajectory) continue;
    trajectory::Trajectory& t = *outcomes[i].trajectory;
    t.id = runs[i].id.value_or(std::ssize(trajectories));
    seconds += t.covered;
    followed.points += runs[i].run->size();
    followed.points_left_out += t.points_left_out;
    followed.runs.push_back(i);
    trajectories.push_back(std::move(t));
  }
  if (trajectories.empty()) {
    throw UserError(runs.size() == 1 ? outcomes.front().reason
                                     : fmt::format("{}: none of its {} {} can be followed{}", request.of, runs.size(), request.many,
                                                   runs.empty() ? "" : "; the first: " + outcomes.front().reason));
  }
  if (trajectories.size() < runs.size()) {
    if (request.named) {
      const auto first = std::find_if(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) { return !outcome.trajectory; });
      throw UserError(first->reason + "; it was asked for by name: leave it out, or widen the span");
    }
    followed.notes.push_back(left_out(outcomes, request));
  }
  std::string description = fmt::format("{}: {} {}, {} points, {:.6g} s covered", request.of, trajectories.size(),
                                        trajectories.size() == 1 ? request.one : request.many, followed.points, seconds);
  followed.source = std::make_unique<TrajectorySource>(std::move(trajectories), request.mill, std::move(request.motion), request.exact,
                                                       std::move(description));
  return followed;
}

}  // namespace millscope::analysis
