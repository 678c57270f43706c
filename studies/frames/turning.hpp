// How the mill turns: as it is stated, held against the beads that ride along its shell.
#pragma once

#include <string>
#include <vector>

#include "studies/frames/gather.hpp"

namespace millscope::frames {

struct Turning {
  double omega = 0;  ///< Ω about our z, rad/s
  double start = 0;  ///< s, at rest before

  double speed_at(double time) const { return time < start ? 0 : omega; }
  double angle_at(double time) const { return time < start ? 0 : omega * (time - start); }
};

/// Throws base::UserError where speed or sense are neither stated nor to be found, and where the beads contradict what is stated. `notes`
/// receives what was found.
Turning turning_of(const MillFile& mill, const Gather& gathered, std::vector<std::string>& notes);

}  // namespace millscope::frames
