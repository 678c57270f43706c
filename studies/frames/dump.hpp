// Text dumps of LIGGGHTS and LAMMPS.
#pragma once

#include "studies/frames/frame.hpp"
#include "studies/frames/input.hpp"

namespace millscope::frames {

std::unique_ptr<FrameStream> open_dump(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace millscope::frames
