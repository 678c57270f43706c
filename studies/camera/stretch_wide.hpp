// The filter of noise_model.hpp over one stretch, built once per instruction set, each with the same bits; noise_model.cpp chooses.
#pragma once

#include <cstddef>

namespace millscope::camera {

/// Locations of a stretch and what one keeps of the one before (`Stretch`, `Steps`).
struct StretchView {
  const double *time, *x, *y, *z;
  const double *dt, *kept, *slowed, *factor;
  double memory;
  std::size_t count;
};

/// Strengths of the noise along x, y and z, m.
struct NoiseView {
  const double *white, *correlated;
};

#define MILLSCOPE_STRETCH_WIDE(level)                                                                                     \
  namespace level {                                                                                                       \
  void stretch_likelihood(const StretchView& stretch, const NoiseView& noise, double strength, double* log_likelihood_3); \
  }
MILLSCOPE_STRETCH_WIDE(wide_v2)
MILLSCOPE_STRETCH_WIDE(wide_v3)
#undef MILLSCOPE_STRETCH_WIDE

}  // namespace millscope::camera
