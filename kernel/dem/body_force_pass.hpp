// Body forces that differ from bead to bead, on the beads of one slab.
#pragma once

#include <array>
#include <vector>

#include "kernel/dem/slab.hpp"

namespace millscope::dem {

class BodyForcePass {
 public:
  /// `acceleration`: of the body forces that are uniform.
  BodyForcePass(const SlabPass& pass, const std::vector<BodyForceReference>& forces, const std::array<double, 3>& acceleration, double time)
      : pass_(pass), forces_(forces), acceleration_(acceleration), time_(time) {}

  /// At most one batch of beads.
  void run(BeadRange beads);

 private:
  void evaluate(std::int64_t count);

  const SlabPass& pass_;
  const std::vector<BodyForceReference>& forces_;
  const std::array<double, 3>& acceleration_;
  double time_;
};

}  // namespace millscope::dem
