// The tracers of a recording in the frame of its mill. For the files of this room.
#pragma once

#include "studies/analysis/open_source.hpp"

namespace millscope::analysis {

/// Reads, moves to the mill's frame and fits trajectories. Throws base::UserError where the frame is neither given nor to be found.
OpenedSource open_recording(const SourceRequest& request, const host::Registry& registry);

}  // namespace millscope::analysis
