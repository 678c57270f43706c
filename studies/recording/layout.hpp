// How a text file is laid out: as said, or recognised from its first lines. For the files of this room.
#pragma once

#include <string>
#include <string_view>

#include "studies/recording/description.hpp"
#include "studies/recording/table.hpp"

namespace millscope::recording {

/// A layout, in words too: "table, comma: t ms, x mm, y mm, z mm, error mm".
struct KnownLayout {
  Layout layout;
  std::string words;
  std::string time_unit, length_unit;  ///< as written; for hints
};

/// Throws base::UserError where nothing fits.
KnownLayout layout_of(std::string_view text, const std::filesystem::path& file, const Description& description);

}  // namespace millscope::recording
