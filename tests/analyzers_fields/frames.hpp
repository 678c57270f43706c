// Frames of an analytic motion, as blocks that an analyzer takes: all beads at once (a simulation) or one bead at a time (a tracer).
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "millscope/analyzer.hpp"

namespace analyzers_test {

using namespace millscope;

inline constexpr double kPi = 3.14159265358979323846;

struct Sample {
  std::array<double, 3> position{}, velocity{};
};

/// Where bead `id` is at time t.
using Motion = std::function<Sample(std::int64_t id, double t)>;

/// A stretch of frames; the arrays behind FrameBlock.
struct Frames {
  static constexpr double kBeadRadius = 0.005;  ///< m, of all
  std::vector<double> time, omega, phase, work, lost, weight, mass, radius, variance, impacts;
  std::vector<std::int32_t> piece;
  std::vector<std::int64_t> first{0}, id;
  std::array<std::vector<double>, 3> position, velocity;
  std::int64_t pairs = 0, bins = 0;

  void add_sample(std::int64_t bead, const Sample& s, double dwell, double bead_mass = 1) {
    id.push_back(bead);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis].push_back(s.position[axis]);
      velocity[axis].push_back(s.velocity[axis]);
    }
    weight.push_back(dwell);
    mass.push_back(bead_mass);
    radius.push_back(kBeadRadius);
  }
  void end_frame(double t, double turning, double power = 0, std::int32_t unbroken = 0) {
    time.push_back(t);
    omega.push_back(turning);
    phase.push_back(turning * t);
    work.push_back(power * t);
    lost.push_back(power * t);
    piece.push_back(unbroken);
    first.push_back(static_cast<std::int64_t>(id.size()));
  }

  /// Frames from … to − 1 as one block.
  FrameBlock block(std::size_t from = 0, std::size_t to = static_cast<std::size_t>(-1)) const {
    to = std::min(to, time.size());
    FrameBlock b{};
    b.has = kHasVelocity | kHasOmega | kHasPhase | kHasWallWork | kHasDissipation;
    b.frame_count = static_cast<std::int64_t>(to - from);
    b.time = time.data() + from;
    b.piece = piece.data() + from;
    b.omega = omega.data() + from;
    b.phase = phase.data() + from;
    b.wall_work = work.data() + from;
    b.dissipation = lost.data() + from;
    b.channel_count = 1;
    b.first = first.data() + from;
    b.weight = weight.data();
    b.id = id.data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      b.position[axis] = position[axis].data();
      b.velocity[axis] = velocity[axis].data();
    }
    b.mass = mass.data();
    b.radius = radius.data();
    b.velocity_variance = variance.empty() ? nullptr : variance.data();
    b.impact_pair_count = pairs;
    b.impact_bin_count = bins;
    b.impacts = impacts.empty() ? nullptr : impacts.data() + from * static_cast<std::size_t>(pairs * bins);
    return b;
  }
};

/// Beads 0 … beads − 1 in every frame; frame f at times[f] with weights[f].
inline Frames all_beads(const Motion& motion, std::int64_t beads, const std::vector<double>& times, const std::vector<double>& weights,
                        double omega) {
  Frames frames;
  for (std::size_t f = 0; f < times.size(); ++f) {
    for (std::int64_t bead = 0; bead < beads; ++bead) frames.add_sample(bead, motion(bead, times[f]), weights[f]);
    frames.end_frame(times[f], omega);
  }
  return frames;
}

/// One bead, one sample in a frame: a tracer's run.
inline Frames one_bead(const Motion& motion, std::int64_t bead, const std::vector<double>& times, const std::vector<double>& weights,
                       double omega) {
  Frames frames;
  for (std::size_t f = 0; f < times.size(); ++f) {
    frames.add_sample(bead, motion(bead, times[f]), weights[f]);
    frames.end_frame(times[f], omega);
  }
  return frames;
}

/// n even times from 0 with the given step.
inline std::vector<double> even_times(std::size_t n, double step) {
  std::vector<double> times(n);
  for (std::size_t i = 0; i < n; ++i) times[i] = static_cast<double>(i) * step;
  return times;
}

/// Beads spread evenly over a disc (sunflower), each turning about the axis with its own angular velocity.
inline Motion turning_disc(std::int64_t beads, double radius, double omega) {
  return [=](std::int64_t id, double t) {
    const double r = radius * std::sqrt((static_cast<double>(id) + 0.5) / static_cast<double>(beads));
    const double angle = 2.399963229728653 * static_cast<double>(id) + omega * t;
    const double x = r * std::cos(angle), y = r * std::sin(angle), z = 0.27 * (static_cast<double>(id) + 0.5) / static_cast<double>(beads);
    return Sample{{x, y, z}, {-omega * y, omega * x, 0}};
  };
}

/// The mirror image x → −x, which turns the other way.
inline Motion mirrored(const Motion& motion) {
  return [motion](std::int64_t id, double t) {
    Sample s = motion(id, t);
    s.position[0] = -s.position[0];
    s.velocity[0] = -s.velocity[0];
    return s;
  };
}

}  // namespace analyzers_test
