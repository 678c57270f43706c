// summary.json and what a run needs to be repeated.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace millscope::output {

/// A loaded plugin library, as the host knows it.
struct PluginRecord {
  std::string name, version, file, hash, code_hash;
};

/// Where, when and with what: version, commit, what of the program can change a number, compiler, host, processor, cores, date (UTC),
/// command line, plugins.
nlohmann::ordered_json provenance(std::span<const std::string> command_line, std::span<const PluginRecord> plugins);

/// What a file holds as JSON; `is_discarded()` where it cannot be read or holds none.
nlohmann::ordered_json read_json(const std::filesystem::path& path);

/// The number below a key; NaN where there is none.
double number_in(const nlohmann::ordered_json& json, const char* key);

/// Writes `json` indented, whole or not at all. NaN and infinity become null. UserError when it cannot be written.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace millscope::output
