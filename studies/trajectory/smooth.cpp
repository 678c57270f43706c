// Chooses the loops of smooth_wide.cpp that this machine runs.
#include "studies/trajectory/smooth_wide.hpp"

#include <cmath>

#include "studies/trajectory/pieces.hpp"

namespace millscope::trajectory {
namespace {

static_assert(sizeof(Knot) == kKnot * sizeof(double) && sizeof(Between) == kBetween * sizeof(double) &&
              sizeof(Evidence) == kEvidence * sizeof(double));

bool is_v3() {
  static const bool found = __builtin_cpu_supports("x86-64-v3") != 0;
  return found;
}

PointView view(const Points& p) { return {p.time, p.position[0], p.position[1], p.position[2], p.count}; }

void run(const Points& points, const SmoothingBy& by, const SplineView& out) {
  struct alignas(32) Filtered {
    char bytes[kFilteredBytes];
  };
  thread_local std::vector<Filtered> scratch;
  scratch.resize(points.count);
  const Noise noise{by.noise.data(), by.roughness.data(), by.factor.data()};
  (is_v3() ? wide_v3::smooth : wide_v2::smooth)(view(points), noise, scratch.data(), out);
}

}  // namespace

Lanes misfit(const Points& points, const Lanes& noise, const Lanes& roughness) {
  Lanes found;
  (is_v3() ? wide_v3::misfit : wide_v2::misfit)(view(points), noise.data(), roughness.data(), found.data());
  return found;
}

void smooth(const Points& points, const SmoothingBy& by, Spline& spline) {
  spline.knots.resize(points.count);
  spline.between.resize(points.count - 1);
  run(points, by, {spline.knots[0].x.data(), &spline.between[0].xx, nullptr});
}

void weigh_evidence(const Points& points, const SmoothingBy& by, std::vector<Evidence>& evidence) {
  evidence.resize(points.count - 1);
  run(points, by, {nullptr, nullptr, &evidence[0].found});
}

}  // namespace millscope::trajectory
