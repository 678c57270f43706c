#include "studies/analysis/trajectory_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kernel/base/error.hpp"
#include "studies/analysis/times.hpp"

namespace millscope::analysis {
namespace {

struct TrajectoryScratch : FrameSource::Scratch {
  FrameBlock block{};
};

double covered(const trajectory::Trajectory& t) {
  double sum = 0;
  for (const trajectory::Piece& piece : t.pieces) sum += std::accumulate(piece.weight.begin(), piece.weight.end(), 0.0);
  return sum;
}

/// How many parts a trajectory of `own` seconds out of `total` gets: its share of `most`, none shorter than `duration`.
std::size_t parts_of(double own, double total, double duration, std::size_t most) {
  const double fair = total > 0 ? std::floor(static_cast<double>(most) * own / total + 1e-6) : 1;
  const double fit = duration > 0 ? std::floor(own / duration + 1e-6) : fair;
  return static_cast<std::size_t>(std::max(1.0, std::min(fair, fit)));
}

Basics sample_of(const trajectory::Piece& piece, std::size_t k) {
  const double x = piece.position[0][k], y = piece.position[1][k], u = piece.velocity[0][k], v = piece.velocity[1][k],
               w = piece.velocity[2][k];
  return {x, y, std::sqrt(x * x + y * y), piece.position[2][k], std::sqrt(u * u + v * v + w * w)};
}

double mass_of(const trajectory::Trajectory& t) { return t.density * std::numbers::pi / 6 * t.diameter * t.diameter * t.diameter; }

}  // namespace

struct TrajectorySource::Arrays {
  std::vector<double> time, omega, phase, weight, position[3], velocity[3], radius, mass, position_variance, velocity_variance;
  std::vector<std::int32_t> piece;
  std::vector<std::int64_t> id;
  std::vector<double> location_variance;
  std::vector<std::int64_t> location_id;

  std::size_t size() const { return time.size(); }
  void reserve(std::size_t samples) {
    piece.reserve(samples);
    for (auto* values : {&time, &omega, &phase, &weight, &position[0], &position[1], &position[2], &velocity[0], &velocity[1], &velocity[2],
                         &position_variance, &velocity_variance})
      values->reserve(samples);
  }
  void add(const trajectory::Piece& from, std::size_t k, std::int32_t number, double sample_weight) {
    time.push_back(from.start + static_cast<double>(k) * from.step);
    piece.push_back(number);
    weight.push_back(sample_weight);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis].push_back(from.position[axis][k]);
      velocity[axis].push_back(from.velocity[axis][k]);
    }
    position_variance.push_back(from.position_variance[k]);
    velocity_variance.push_back(from.velocity_variance[k]);
  }
};

TrajectorySource::TrajectorySource(std::vector<trajectory::Trajectory> trajectories, AnalyzerContext context, ShellMotion motion,
                                   bool exact, std::string description)
    : trajectories_(std::move(trajectories)),
      context_(context),
      motion_(std::move(motion)),
      exact_(exact),
      description_(std::move(description)) {
  tell_trimmed();
  context_.has = kHasVelocity | kHasLocations;
  if (motion_.omega) context_.has |= kHasOmega;
  if (motion_.phase) context_.has |= kHasPhase;
  context_.largest_id = 0;
  context_.start = std::numeric_limits<double>::infinity();
  context_.end = -context_.start;
  for (const trajectory::Trajectory& t : trajectories_) {
    context_.largest_id = std::max(context_.largest_id, t.id);
    for (const trajectory::Piece& piece : t.pieces) {
      context_.start = std::min(context_.start, piece.start);
      context_.end = std::max(context_.end, piece.start + static_cast<double>(piece.size() - 1) * piece.step);
    }
  }
}

TrajectorySource::~TrajectorySource() = default;

void TrajectorySource::tell_trimmed() {
  double trimmed = 0, kept = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const trajectory::Trajectory& t : trajectories_) {
    trimmed += static_cast<double>(t.samples_trimmed);
    for (const trajectory::Piece& piece : t.pieces) kept += static_cast<double>(piece.size());
    for (const double z : t.location_position[2]) low = std::min(low, z), high = std::max(high, z);
  }
  if (trimmed == 0) return;
  const auto outside = std::erase_if(trajectories_, [](const trajectory::Trajectory& t) { return t.pieces.empty(); });
  if (trajectories_.empty()) {
    throw base::UserError(
        fmt::format("{}: nothing lies between trajectory.low and trajectory.high: z goes from {:.4g} m to {:.4g} m; give a range within "
                    "that, with its unit (low: 20 mm)",
                    description_, low, high));
  }
  notes_.push_back(fmt::format("{:.3g} % of the samples ({:.0f} of {:.0f}) lie outside trajectory.low … trajectory.high and are left out{}",
                               100 * trimmed / (trimmed + kept), trimmed, trimmed + kept,
                               outside == 0 ? "" : fmt::format(", {} of {} beads altogether", outside, outside + trajectories_.size())));
}

std::size_t TrajectorySource::stretch(std::size_t chunk) const { return chunks_.at(chunk).stretch; }

double TrajectorySource::duration() const {
  double sum = 0;
  for (const trajectory::Trajectory& t : trajectories_) sum += covered(t);
  return sum;
}

std::vector<BasicSeries> TrajectorySource::survey() const {
  std::vector<BasicSeries> all;
  for (const trajectory::Trajectory& t : trajectories_) {
    BasicSeries& series = all.emplace_back();
    for (const trajectory::Piece& piece : t.pieces) {
      for (std::size_t k = 0; k < piece.size(); ++k) {
        if (piece.weight[k] > 0) series.add(piece.start + static_cast<double>(k) * piece.step, piece.weight[k], sample_of(piece, k));
      }
    }
  }
  return all;
}

std::unique_ptr<FrameSource::Scratch> TrajectorySource::make_scratch() const { return std::make_unique<TrajectoryScratch>(); }

void TrajectorySource::cut(double duration, std::size_t most) {
  std::vector<double> own;
  for (const trajectory::Trajectory& t : trajectories_) own.push_back(covered(t));
  const double total = std::accumulate(own.begin(), own.end(), 0.0);
  std::vector<std::size_t> parts;
  for (const double seconds : own) parts.push_back(parts_of(seconds, total, duration, most));
  arrays_.clear();
  chunks_.clear();
  std::size_t longest = 0;
  for (std::size_t k = 0; k < trajectories_.size(); ++k) {
    lay_out(k, parts[k]);
    longest = std::max(longest, arrays_.back()->size());
  }
  first_.resize(longest + 1);
  std::iota(first_.begin(), first_.end(), std::int64_t{0});
}

void TrajectorySource::lay_out(std::size_t number, std::size_t parts) {
  const trajectory::Trajectory& t = trajectories_[number];
  auto arrays = std::make_unique<Arrays>();
  std::size_t samples = parts;
  for (const trajectory::Piece& piece : t.pieces) samples += piece.size();
  arrays->reserve(samples);
  const double total = covered(t);
  double before = 0;
  std::size_t part = 0;
  chunks_.push_back({number, 0, 0, 0, 0, 0});
  for (std::size_t p = 0; p < t.pieces.size(); ++p) {
    const trajectory::Piece& piece = t.pieces[p];
    const auto label = static_cast<std::int32_t>(p);
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const double middle = before + 0.5 * piece.weight[k];
      const auto here = total > 0 ? static_cast<std::size_t>(middle / total * static_cast<double>(parts)) : 0;
      if (here > part && here < parts) {
        part = here;
        chunks_.back().last = arrays->size();
        chunks_.push_back({number, arrays->size(), 0, 0, 0, 0});
        if (k > 0) arrays->add(piece, k - 1, label, 0.0);
      }
      arrays->add(piece, k, label, piece.weight[k]);
      before += piece.weight[k];
      chunks_.back().duration += piece.weight[k];
    }
  }
  chunks_.back().last = arrays->size();
  const std::size_t size = arrays->size(), points = t.location_time.size();
  arrays->id.assign(size, t.id);
  arrays->radius.assign(size, 0.5 * t.diameter);
  arrays->mass.assign(size, mass_of(t));
  for (const double time : arrays->time) {
    if (motion_.omega) arrays->omega.push_back(motion_.omega(time));
    if (motion_.phase) arrays->phase.push_back(motion_.phase(time));
  }
  const double variance = (t.noise[0] * t.noise[0] + t.noise[1] * t.noise[1] + t.noise[2] * t.noise[2]) / 3;
  arrays->location_variance.assign(points, variance);
  arrays->location_id.assign(points, t.id);
  std::size_t from = 0;
  for (Chunk& chunk : chunks_) {
    if (chunk.stretch != number) continue;
    const bool is_last = chunk.last == size;
    const double until = is_last ? std::numeric_limits<double>::infinity() : arrays->time[chunk.last - 1];
    chunk.location_first = from;
    from = std::upper_bound(t.location_time.begin(), t.location_time.end(), until) - t.location_time.begin();
    chunk.location_last = from;
  }
  arrays_.push_back(std::move(arrays));
}

const FrameBlock& TrajectorySource::load(std::size_t number, Scratch& scratch) const {
  FrameBlock& block = static_cast<TrajectoryScratch&>(scratch).block;
  const Chunk& chunk = chunks_.at(number);
  const Arrays& a = *arrays_[chunk.stretch];
  const trajectory::Trajectory& t = trajectories_[chunk.stretch];
  const std::size_t from = chunk.first;
  block = {};
  block.has = context_.has;
  block.duration = chunk.duration;
  block.frame_count = static_cast<std::int64_t>(chunk.last - chunk.first);
  block.time = a.time.data() + from;
  block.piece = a.piece.data() + from;
  block.omega = motion_.omega ? a.omega.data() + from : nullptr;
  block.phase = motion_.phase ? a.phase.data() + from : nullptr;
  block.first = first_.data();
  block.weight = a.weight.data() + from;
  block.id = a.id.data() + from;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block.position[axis] = a.position[axis].data() + from;
    block.velocity[axis] = a.velocity[axis].data() + from;
    block.location_position[axis] = t.location_position[axis].data() + chunk.location_first;
  }
  block.radius = t.diameter > 0 ? a.radius.data() + from : nullptr;
  block.mass = t.diameter > 0 && t.density > 0 ? a.mass.data() + from : nullptr;
  block.position_variance = exact_ ? nullptr : a.position_variance.data() + from;
  block.velocity_variance = exact_ ? nullptr : a.velocity_variance.data() + from;
  block.location_count = static_cast<std::int64_t>(chunk.location_last - chunk.location_first);
  block.location_time = t.location_time.data() + chunk.location_first;
  block.location_variance = exact_ ? nullptr : a.location_variance.data() + chunk.location_first;
  block.location_id = a.location_id.data() + chunk.location_first;
  return block;
}

}  // namespace millscope::analysis
