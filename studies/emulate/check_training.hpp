// Training data that no emulator can be made of, refused in plain words.
#pragma once

#include "studies/emulate/space.hpp"

namespace millscope::emulate {

std::string observable_name(const Training& training, Eigen::Index observable);

/// Throws base::UserError; std::invalid_argument when the tables do not belong together.
void check_training(const Box& box, const Training& training);

}  // namespace millscope::emulate
