// The stated uncertainty against the error on a motion that is known: rides, parabolas, impacts.
#include <catch2/catch.hpp>

#include "recording/support.hpp"
#include "studies/trajectory/trajectory.hpp"

using namespace millscope;
using namespace recording_test;

namespace {

constexpr double kNinety = 1.6449;  // standard deviations that hold 90 %

struct Score {
  double position = 0, velocity = 0;              ///< part of the 90 % intervals that hold the truth
  double position_error = 0, velocity_error = 0;  ///< root mean square, m and m/s
  double speed_bias = 0;                          ///< relative
};

Score score(const Camera& camera, trajectory::SplineKind kind) {
  const Motion motion;
  const trajectory::Trajectory trajectory = trajectory::fit_trajectory(see(motion, camera), {.kind = kind});
  Score s;
  double count = 0, fitted = 0, true_speed = 0;
  for (const trajectory::Piece& piece : trajectory.pieces) {
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const double t = piece.start + static_cast<double>(k) * piece.step;
      const auto x = motion.position(t), v = motion.velocity(t);
      double squared = 0, true_squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double dx = piece.position[axis][k] - x[axis], dv = piece.velocity[axis][k] - v[axis];
        s.position += dx * dx <= kNinety * kNinety * piece.position_variance[k];
        s.velocity += dv * dv <= kNinety * kNinety * piece.velocity_variance[k];
        s.position_error += dx * dx;
        s.velocity_error += dv * dv;
        squared += piece.velocity[axis][k] * piece.velocity[axis][k];
        true_squared += v[axis] * v[axis];
        ++count;
      }
      fitted += std::sqrt(squared);
      true_speed += std::sqrt(true_squared);
    }
  }
  s.position /= count;
  s.velocity /= count;
  s.position_error = std::sqrt(s.position_error / count);
  s.velocity_error = std::sqrt(s.velocity_error / count);
  s.speed_bias = fitted / true_speed - 1;
  return s;
}

}  // namespace

TEST_CASE("the smoothing spline's intervals hold the truth under white noise") {
  const Score s = score({.duration = 120}, trajectory::SplineKind::smoothing);
  INFO("position " << s.position << ", velocity " << s.velocity << ", errors " << s.position_error << " m, " << s.velocity_error
                   << " m/s, bias " << s.speed_bias);
  CHECK(s.position > 0.86);
  CHECK(s.position < 0.97);
  CHECK(s.velocity > 0.86);
  CHECK(s.velocity < 0.995);  // far from impacts the intervals are too wide
  CHECK(s.position_error < 0.6 * 0.7e-3);
  CHECK(std::fabs(s.speed_bias) < 0.01);
}

TEST_CASE("and under correlated noise") {
  for (const double correlation : {0.3, 0.6}) {
    const Score s = score({.correlation = correlation, .duration = 120}, trajectory::SplineKind::smoothing);
    INFO("correlation " << correlation << ": position " << s.position << ", velocity " << s.velocity);
    CHECK(s.position > 0.85);
    CHECK(s.position < 0.97);
    CHECK(s.velocity > 0.85);
  }
}

TEST_CASE("the interpolating spline's intervals are right, and wide") {
  const Score cubic = score({.duration = 60}, trajectory::SplineKind::cubic),
              smooth = score({.duration = 60}, trajectory::SplineKind::smoothing);
  INFO("position " << cubic.position << ", velocity " << cubic.velocity << ", error " << cubic.velocity_error << " m/s");
  CHECK(cubic.position > 0.87);
  CHECK(cubic.position < 0.94);
  CHECK(cubic.velocity > 0.86);
  CHECK(cubic.velocity < 0.94);
  CHECK(cubic.velocity_error > 5 * smooth.velocity_error);
}

TEST_CASE("at an impact the spline lets go: the error there is smaller than one strength for all allows") {
  // The velocity jumps by 1 m/s within no time. Around it the spline is uncertain, and says so.
  const Motion motion;
  const trajectory::Trajectory trajectory = trajectory::fit_trajectory(see(motion, {.duration = 60}), {});
  double near = 0, near_count = 0, calm = 0, calm_count = 0;
  for (const trajectory::Piece& piece : trajectory.pieces) {
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const double t = piece.start + static_cast<double>(k) * piece.step;
      const double phase = t - std::floor(t / motion.period()) * motion.period(), to_impact = std::min(phase, motion.period() - phase);
      (to_impact < 0.01 ? near : calm) += std::sqrt(piece.velocity_variance[k]);
      (to_impact < 0.01 ? near_count : calm_count) += 1;
    }
  }
  CHECK(near / near_count > 2 * calm / calm_count);
}
