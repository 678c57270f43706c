// Points of the box as they are before the data speak.
#pragma once

#include <cstdint>

#include "studies/emulate/space.hpp"

namespace millscope::emulate {

/// parameters × count, even over what is allowed. Throws base::UserError when next to nothing is.
Eigen::MatrixXd prior_points(const Box& box, int count, std::uint64_t seed);

}  // namespace millscope::emulate
