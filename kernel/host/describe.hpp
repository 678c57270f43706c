// What a plugin says of itself, as a page of text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kernel/host/registry.hpp"

namespace millscope::host {

/// The page of `millscope describe NAME`: doc, equation, citation, parameters, channels, history, hypotheses.
std::string describe(const Descriptor& descriptor);

/// The same as JSON, for the manual and editors.
nlohmann::json describe_json(const Descriptor& descriptor);

/// The table of `millscope plugins`: kind, name, version, instruction set, path, hash.
std::string list_plugins(const Registry& registry);

/// Records for the provenance of results.
nlohmann::json provenance_json(const Registry& registry);

}  // namespace millscope::host
