#include "kernel/dem/particles.hpp"

#include <cstdio>

namespace millscope::dem {

std::string complaint(const Particles& particles, std::int64_t bead, double time, const char* what) {
  const double* x = particles.position[bead].centre;
  const double* v = particles.motion[bead].v;
  char line[700];
  std::snprintf(
      line, sizeof line,
      "at t = %.6g s bead %u %s: centre (%.4g, %.4g, %.4g) m, velocity (%.4g, %.4g, %.4g) m/s. Likely causes, in order: a time step "
      "too long for the stiffness (lower time.step_fraction), beads that overlapped walls or each other at the start, a liner with "
      "an open edge (millscope geometry report)",
      time, particles.id[bead], what, x[0], x[1], x[2], v[0], v[1], v[2]);
  return line;
}

}  // namespace millscope::dem
