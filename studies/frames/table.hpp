// Tables of beads as text, among them EDEM's "Export Results Data".
#pragma once

#include "studies/frames/frame.hpp"

namespace millscope::frames {

std::unique_ptr<FrameStream> open_table(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace millscope::frames
