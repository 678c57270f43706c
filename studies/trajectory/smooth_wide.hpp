// The smoothing spline's loops over points, built once per instruction set, each with the same bits; smooth.cpp chooses.
#pragma once

#include <cstddef>

namespace millscope::trajectory {

struct PointView {
  const double *time, *x, *y, *z;
  std::size_t count;
};

/// Of each coordinate, and the factor of the roughness in each interval.
struct Noise {
  const double *noise, *roughness, *factor;
};

inline constexpr std::size_t kKnot = 15, kBetween = 5, kEvidence = 2;  ///< doubles in each (pieces.hpp)
/// Either knots and between or evidence; the others are null.
struct SplineView {
  double *knots, *between, *evidence;
};
inline constexpr std::size_t kFilteredBytes = 320;  ///< of scratch for each point, aligned to 32 bytes

#define MILLSCOPE_SMOOTH_WIDE(level)                                                                 \
  namespace level {                                                                                  \
  void misfit(const PointView& points, const double* noise, const double* roughness, double* found); \
  void smooth(const PointView& points, const Noise& by, void* scratch, SplineView spline);           \
  }
MILLSCOPE_SMOOTH_WIDE(wide_v2)
MILLSCOPE_SMOOTH_WIDE(wide_v3)
#undef MILLSCOPE_SMOOTH_WIDE

}  // namespace millscope::trajectory
