// An inspection for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "studies/inspect/inspect.hpp"

namespace millscope::inspect {

/// Aligned text with units; ends with a newline.
std::string inspection_text(const Inspection& inspection);

/// The same content; units are in the names of the keys; what the recording cannot say is null, with a note.
nlohmann::ordered_json inspection_json(const Inspection& inspection);

}  // namespace millscope::inspect
