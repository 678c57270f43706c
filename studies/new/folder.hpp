// The folder of a new mill.
#pragma once

#include <string>

#include "studies/new/mill.hpp"

namespace millscope::new_mill {

/// case.yaml with what it needs and README.md, all as text.
std::string case_text(const Mill& mill, const Choices& choices, const std::string& title);
std::string readme_text(const Mill& mill, const Choices& choices, const std::string& title);
/// Name of the liner's copy in the folder.
std::string liner_name(const Liner& liner);

/// What the finished case was found to be.
struct Found {
  std::uint64_t beads = 0, steps = 0;
  double time_step = 0;     ///< s
  double wall_seconds = 0;  ///< 0: not tried, the mill is too large for a quick look
};

/// Writes the folder aside, checks its case as 'millscope check' does, and renames it. Nothing is left behind when it throws.
Found write_folder(const std::filesystem::path& folder, const Mill& mill, const Choices& choices, const host::Registry& registry);

}  // namespace millscope::new_mill
