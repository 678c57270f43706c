// Writing a case back, and the schema for editors.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "kernel/config/case.hpp"
#include "millscope/abi.hpp"

namespace millscope::config {

/// The case with every default filled in and every number in SI, as YAML that reads back to the same case. Parameters of plugins that
/// are not among `descriptors` are copied as written (relative files made absolute only where a descriptor names them).
/// Call it after `finish`: what it copies counts as read.
std::string resolved_yaml(const Case& c, std::span<const Descriptor* const> descriptors = {});

/// A text as `resolved_yaml` writes it: in double quotes; JSON's quoting is also YAML's.
std::string quoted(const std::string& text);

/// JSON Schema (draft 7) of case files, and of files that cases include, with the parameters of these plugins.
nlohmann::json case_schema(std::span<const Descriptor* const> descriptors);

}  // namespace millscope::config
