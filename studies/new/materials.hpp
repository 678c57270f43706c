// The materials that come with millscope, and one from a file of the user's.
#pragma once

#include <string>
#include <vector>

#include "studies/new/mill.hpp"

namespace millscope::new_mill {

/// Names of the library's materials, sorted. Throws UserError when the library is not installed.
std::vector<std::string> library_materials();
/// A name of the library, or a YAML file with one material. Throws UserError that names the option.
Material find_material(const std::string& option, const std::string& name_or_file);
/// ../share/millscope/FILE beside the executable; nothing when it is not there.
std::optional<std::filesystem::path> shared_file(const std::string& file);

}  // namespace millscope::new_mill
