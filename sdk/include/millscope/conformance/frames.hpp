// A made-up mill whose frames the checks of an analyzer read.
#pragma once

#include <array>

#include "millscope/analyzer.hpp"
#include "millscope/conformance/values.hpp"

namespace millscope::conformance {

/// Owns the arrays of a FrameBlock: `beads` in every frame, all fields of a simulation.
class Frames {
 public:
  explicit Frames(std::size_t beads) : beads_(beads) {}

  /// Adds a frame in which every bead weighs `weight`, at a time of `mill_of_spheres`.
  void add(double time, double weight, std::int32_t piece = 0);

  /// Fields beside those named are left out. Valid until the frames change.
  FrameBlock block(std::uint64_t has);

  static constexpr std::uint64_t kAll =
      kHasVelocity | kHasSpin | kHasOmega | kHasPhase | kHasWallWork | kHasDissipation | kHasAllBeads | kHasImpacts;
  static constexpr std::size_t kBins = 4;

 private:
  std::size_t beads_;
  double duration_ = 0;
  std::vector<double> time_, omega_, phase_, wall_work_, dissipation_, weight_, radius_, mass_, impacts_;
  std::vector<std::int32_t> piece_;
  std::vector<std::int64_t> first_{0}, id_;
  std::array<std::vector<double>, 3> position_, velocity_, spin_;
};

/// The mill of these frames: 300 mm, 270 mm long, clockwise at 6 rad/s, everything known.
inline AnalyzerContext known_mill(std::size_t beads);

namespace detail {

inline constexpr const char* kChannelNames[] = {"bead~bead.normal_damping", "bead~liner.friction"};
inline constexpr const char* kImpactPairs[] = {"bead~bead"};
inline constexpr double kImpactEdges[Frames::kBins + 1] = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4};
inline constexpr double kOmega = -6.0, kBeadRadius = 2.5e-3, kBeadMass = 1.636e-4;

}  // namespace detail

/// Every bead circles about a point of its own beside the axis, so that it climbs at one side, falls at the other and never leaves the
/// mill.
inline void Frames::add(double time, double weight, std::int32_t piece) {
  time_.push_back(time);
  piece_.push_back(piece);
  omega_.push_back(detail::kOmega);
  phase_.push_back(detail::kOmega * time);
  wall_work_.push_back(7.0 * time);
  dissipation_.insert(dissipation_.end(), {4.0 * time, 3.0 * time});
  for (std::size_t k = 0; k < kBins; ++k) impacts_.push_back(std::floor(time * 1000.0 / static_cast<double>(k + 1)));
  duration_ += weight;
  for (std::size_t b = 0; b < beads_; ++b) {
    const double n = static_cast<double>(b), rate = detail::kOmega * (0.6 + 0.013 * n), angle = 0.7 * n + rate * time;
    const double across = 0.02 + 0.0006 * n, x0 = -0.05 - 0.0004 * n, y0 = -0.06 + 0.0003 * n, sway = 0.3 + 0.01 * n;
    const double x[3] = {x0 + across * std::cos(angle), y0 + across * std::sin(angle), 0.135 + 0.1 * std::sin(n + sway * time)};
    const double v[3] = {-rate * across * std::sin(angle), rate * across * std::cos(angle), 0.1 * sway * std::cos(n + sway * time)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position_[axis].push_back(x[axis]);
      velocity_[axis].push_back(v[axis]);
      spin_[axis].push_back(axis == 2 ? 3.0 * rate : 0.0);
    }
    id_.push_back(static_cast<std::int64_t>(b));
    weight_.push_back(weight);
    radius_.push_back(detail::kBeadRadius);
    mass_.push_back(detail::kBeadMass);
  }
  first_.push_back(static_cast<std::int64_t>(id_.size()));
}

inline FrameBlock Frames::block(std::uint64_t has) {
  FrameBlock b{};
  const auto given = [has](std::uint64_t field, const std::vector<double>& column) { return (has & field) != 0 ? column.data() : nullptr; };
  b.has = has;
  b.duration = duration_;
  b.frame_count = static_cast<std::int64_t>(time_.size());
  b.time = time_.data();
  b.piece = piece_.data();
  b.omega = given(kHasOmega, omega_);
  b.phase = given(kHasPhase, phase_);
  b.wall_work = given(kHasWallWork, wall_work_);
  b.dissipation = given(kHasDissipation, dissipation_);
  if ((has & kHasDissipation) != 0) b.channel_count = 2, b.channel_name = detail::kChannelNames;
  b.first = first_.data();
  b.weight = weight_.data();
  b.id = id_.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    b.position[axis] = position_[axis].data();
    b.velocity[axis] = given(kHasVelocity, velocity_[axis]);
    b.spin[axis] = given(kHasSpin, spin_[axis]);
  }
  b.radius = radius_.data();
  b.mass = mass_.data();
  if ((has & kHasImpacts) != 0) {
    b.impacts = impacts_.data();
    b.impact_pair_count = 1, b.impact_bin_count = kBins;
    b.impact_pair = detail::kImpactPairs, b.impact_energy_edge = detail::kImpactEdges;
  }
  return b;
}

inline AnalyzerContext known_mill(std::size_t beads) {
  AnalyzerContext c{};
  c.mill_radius = 0.15;
  c.mill_high = c.mill_length = 0.27;
  c.omega = detail::kOmega;
  c.gravity = 9.81;
  c.charge_count = static_cast<double>(beads);
  c.charge_mass = c.charge_count * detail::kBeadMass;
  c.bead_radius = detail::kBeadRadius;
  c.bead_density = 2500.0;
  c.end = 2.0;
  c.largest_id = static_cast<std::int64_t>(beads) - 1;
  c.has = Frames::kAll;
  c.filling = 0.3;
  c.porosity = 0.4;
  c.channel_count = 2, c.channel_name = detail::kChannelNames;
  c.impact_pair_count = 1, c.impact_bin_count = static_cast<std::int64_t>(Frames::kBins);
  c.impact_pair = detail::kImpactPairs, c.impact_energy_edge = detail::kImpactEdges;
  return c;
}

}  // namespace millscope::conformance
