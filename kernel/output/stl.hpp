// STL files from surfaces (`geometry export`).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "millscope/geometry.hpp"

namespace millscope::output {

/// `ascii`: one named solid per material slot, so that the names survive. `binary`: smaller; the names are lost (the slot stands in
/// each triangle's attribute word) and coordinates are rounded to float.
enum class StlFormat { ascii, binary };

/// Writes the surface, whole or not at all. `slots[k]` names material slot k (spaces become '_'); slots without triangles are left out.
/// UserError when the file cannot be written.
void write_stl(const std::filesystem::path& path, const Surface& surface, std::span<const std::string> slots,
               StlFormat format = StlFormat::ascii);

}  // namespace millscope::output
