// Where the mill's axis stands, how fast it turns and on which circle a bead rides along its shell, from the tracer alone.
//
// Beads against the shell, between the lifters, turn with it: v = Ω ẑ × (x − c), |x − c| = R. First the rigid rotation is sought that the
// outermost moving beads share; then the circle that nearly all points lie within and many lie on; then each ride along that circle is cut
// at its ends, where the bead is not yet or no longer at the shell, and all rides share a centre and a radius.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "studies/inspect/estimate.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::inspect {

struct MillMotion {
  int sense = 0;                ///< of turning, seen with z towards the viewer: +1 counter-clockwise, −1 clockwise, 0 not recognised
  std::array<Finding, 2> axis;  ///< x and y in the frame of the file, m
  /// Standard error of the axis by the choice of rides alone, m: what two recordings of one mill differ by; 0 without rides. All are off
  /// together as well, by beads that ride on lifters, press into the liner or leave it; the intervals of `axis` allow for that.
  std::array<double, 2> axis_scatter{};
  Finding speed;              ///< |Ω| of the shell, rad/s
  Finding path_radius;        ///< of the circle on which the tracer's centre rides along the shell, m: the shell's less a bead's radius
  std::size_t rides = 0;      ///< separate rides along the shell; 0 where no wall is recognised
  double ride_time = 0;       ///< s of them, ends cut off
  double noise = 0;           ///< of a component of a point across the axis, m: the band in which rides are looked for follows from it
  double radial_scatter = 0;  ///< standard deviation of the points of rides about the circle, m: the noise with its slow part

  /// Ω about z with its sign, rad/s; 0 where the speed is not known.
  double angular_velocity() const { return speed.estimate ? sense * speed.estimate->value : 0; }

  /// Best centre; only where `sense` is not 0.
  std::array<double, 2> centre() const { return {axis[0].estimate->value, axis[1].estimate->value}; }
};

/// What a speed that the user states is beside the one found.
enum class Agreement {
  unknown,   ///< nothing is stated, or nothing was found
  within,    ///< its interval
  outside,   ///< its interval
  far,       ///< beyond its interval by half as much again; of a bound, ten times the speed that the charge has
  opposite,  ///< the other sense
};
Agreement compare_speed(const recording::Condition& stated, const MillMotion& motion);

/// Needs motion across x and y, with the axis along z. Never throws; where the data cannot say, the findings give the reason.
MillMotion estimate_motion(const recording::Recording& recording);

/// The axis that `estimate_motion` would find from rides, in a recording whose frame is that of the mill, as of simulated beads: it is off
/// by as much as in a recording of such a mill. m; nothing where no wall is recognised. `path_radius`: m; `angular_velocity`: rad/s;
/// `noise` of a component of a point: m.
std::optional<std::array<double, 2>> axis_by_rides(const recording::Recording& recording, double path_radius, double angular_velocity,
                                                   double noise);

}  // namespace millscope::inspect
