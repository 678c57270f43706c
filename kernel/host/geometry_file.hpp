// A geometry from a file alone, without a case: its reader is the plugin whose parameter `file` names the extension.
#pragma once

#include <string>
#include <vector>

#include "kernel/host/objects.hpp"

namespace millscope::host {

/// Throws UserError with the extensions that are read.
const Loaded& reader_of(const std::string& file, const Registry& registry);

/// Units that a reader asks for; empty: its files say theirs.
std::vector<std::string> units_of(const Loaded& reader);

struct GeometryFile {
  std::string file, unit;   ///< unit "": not given
  std::string unit_option;  ///< what the user gives the unit by, for messages: "--unit"
  bool turned = false;      ///< its axis is found and brought to z through the origin
};

/// Throws UserError, also for a unit where the file says its own.
GeometryObject open_geometry(const GeometryFile& what, const Registry& registry);

}  // namespace millscope::host
