// What cairo's SVG lacks: names that do not depend on what was drawn before, and words for readers that cannot see.
#pragma once

#include <string>

namespace millscope::picture {

/// cairo numbers clips, images and surfaces with a counter of the whole process; here they are numbered anew within the file.
std::string stable_svg_names(const std::string& svg);

/// Adds <title> and <desc>: letters are outlines in cairo's SVG, so a search or a screen reader would find none.
std::string describe_svg(const std::string& svg, const std::string& title, const std::string& description);

}  // namespace millscope::picture
