// Mindlin's contact of two spheres with all its history, as a row of many springs; and the impact of a sphere on a plane with it.
//
// The row is exact as it gets finer (reduction of dimension: Jäger 1995; Popov & Heß 2015, ch. 5): the spring at x bears when the overlap
// passes x²/R, its normal and tangential stiffness per length are E* and 4 G*, and each slides by Coulomb's law alone. With equal
// compliances that is what Maw, Barber & Fawcett (1976) solved with concentric rings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace laws_test {

/// Everything is made free of units: R = E* = m = 1. `stiffness` is S_t/S_n = 4 G*/E*.
class RowOfSprings {
 public:
  RowOfSprings(double stiffness, double friction, double largest_overlap, std::size_t count)
      : stiffness_(stiffness), friction_(friction), spacing_(std::sqrt(largest_overlap) / static_cast<double>(count)), slips_(count, 0.0) {}

  /// Tangential force after half of this slip at this overlap; the other half follows without sliding (the midpoint rule).
  double pull(double overlap, double slip) {
    double force = 0;
    for (std::size_t k = 0; k < slips_.size(); ++k) {
      const double x = (static_cast<double>(k) + 0.5) * spacing_, depth = std::max(overlap - x * x, 0.0);
      const double limit = friction_ * depth / stiffness_;
      const double slip_now = std::clamp(slips_[k] + 0.5 * slip, -limit, limit);
      force += 2.0 * stiffness_ * slip_now * spacing_;
      slips_[k] = depth > 0.0 ? slip_now + 0.5 * slip : 0.0;
    }
    return force;
  }

 private:
  double stiffness_, friction_, spacing_;
  std::vector<double> slips_;
};

/// ψ₂ of a sphere that hits a plane with ψ₁, undamped: ψ = S_t/S_n v_t/(μ v_n) of the contact point. Nothing else enters.
inline double row_rebound(double incidence, double stiffness, std::size_t springs) {
  const double friction = 0.1, speed = 1e-4;  // so slow that the overlap does not shorten the lever
  const double largest = std::pow(15.0 / 16.0 * speed * speed, 0.4), steps = 2.0 * static_cast<double>(springs);
  const double time_step = 2.94 * largest / speed / steps;
  RowOfSprings row(stiffness, friction, 1.001 * largest, springs);
  double normal = speed, sliding = incidence * friction / stiffness * speed, overlap = 0.5 * time_step * normal;
  while (overlap > 0.0) {
    const double force = row.pull(overlap, sliding * time_step);
    normal -= 4.0 / 3.0 * overlap * std::sqrt(overlap) * time_step;
    sliding -= 3.5 * force * time_step;  // 1/m + R²/I
    overlap += normal * time_step;
  }
  return stiffness * sliding / (friction * -normal);
}

/// Maw, Barber & Fawcett's ψ₂: the row's error falls as 1/springs and is taken off.
inline double maw_rebound(double incidence, double stiffness, std::size_t springs = 400) {
  return 2.0 * row_rebound(incidence, stiffness, springs) - row_rebound(incidence, stiffness, springs / 2);
}

}  // namespace laws_test
