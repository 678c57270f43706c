#include "kernel/dem/motion.hpp"

#include <cmath>
#include <numbers>

namespace millscope::dem {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

/// θ(t) of Ω(t) = Ω · ramp(t) · (1 + a sin 2πf t), the ripple starting when the ramp ends.
double angle_at(const Motion& m, double time) {
  const double t = time + m.ahead - m.start;
  if (t <= 0) return 0;
  if (t < m.ramp) return 0.5 * m.speed * t * t / m.ramp;
  const double steady = t - m.ramp;
  double angle = m.speed * (0.5 * m.ramp + steady);
  if (m.ripple_amplitude != 0 && m.ripple_frequency > 0) {
    const double w = kTwoPi * m.ripple_frequency;
    angle += m.speed * m.ripple_amplitude * (std::cos(m.ripple_phase) - std::cos(w * steady + m.ripple_phase)) / w;
  }
  return angle;
}

}  // namespace

double angular_speed(const Motion& m, double time) {
  const double t = time + m.ahead - m.start;
  if (t <= 0) return 0;
  if (t < m.ramp) return m.speed * t / m.ramp;
  return m.speed * (1 + m.ripple_amplitude * std::sin(kTwoPi * m.ripple_frequency * (t - m.ramp) + m.ripple_phase));
}

// Rodrigues: R = cosθ I + sinθ [a]× + (1 − cosθ) a aᵀ.
Pose pose_at(const Motion& m, double time) {
  Pose p{};
  p.angle = angle_at(m, time);
  const double c = std::cos(p.angle), s = std::sin(p.angle);
  const Vector3& a = m.axis;
  const double skew[3][3] = {{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      p.rotation[i][j] = (i == j ? c : 0.0) + s * skew[i][j] + (1 - c) * a[i] * a[j];
    }
  }
  const double w = kTwoPi * m.oscillation_frequency;
  const double omega = angular_speed(m, time);
  const double moving = time + m.ahead - m.translation_start;
  for (std::size_t i = 0; i < 3; ++i) {
    const double swing = m.oscillation_amplitude[i];
    const double shift =
        moving < 0 ? 0 : m.velocity[i] * moving + swing * (std::sin(w * moving + m.oscillation_phase) - std::sin(m.oscillation_phase));
    p.velocity[i] = moving < 0 ? 0 : m.velocity[i] + swing * w * std::cos(w * moving + m.oscillation_phase);
    p.centre[i] = m.point[i] + shift;
    p.omega[i] = omega * a[i];
    const double* row = p.rotation[i];
    p.offset[i] = p.centre[i] - (row[0] * m.point[0] + row[1] * m.point[1] + row[2] * m.point[2]);
  }
  return p;
}

}  // namespace millscope::dem
