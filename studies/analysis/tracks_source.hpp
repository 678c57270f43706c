// Simulated beads that are followed (tracks.h5), processed as a real bead is. For the files of this room.
#pragma once

#include "studies/analysis/mill.hpp"
#include "studies/analysis/open_source.hpp"

namespace millscope::analysis {

/// The tracks that `request` names, or all. Throws base::UserError.
OpenedSource open_tracks(const SourceRequest& request, MillOfCase mill);

/// The shell's turning speed and angle as functions of time; empty for a mill at rest.
struct ShellMotion shell_motion(const dem::Motion& motion);

}  // namespace millscope::analysis
