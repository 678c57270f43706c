#include "kernel/output/summary.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <fstream>
#include <limits>
#include <thread>

#include "kernel/base/program.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/file.hpp"
#include "millscope/abi.hpp"

namespace millscope::output {

namespace {

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

}  // namespace

nlohmann::ordered_json provenance(std::span<const std::string> command_line, std::span<const PluginRecord> plugins) {
  nlohmann::ordered_json json;
  json["version"] = base::version();
  json["commit"] = *base::commit() != '\0' ? nlohmann::ordered_json(base::commit()) : nlohmann::ordered_json();
  json["program"] = base::program_parts(base::simulating_folders());
  json["compiler"] = kCompiler;
  json["host"] = host_name();
  json["processor"] = processor_name();
  json["cores"] = std::thread::hardware_concurrency();
  json["date_utc"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  json["command_line"] = std::vector<std::string>(command_line.begin(), command_line.end());
  json["plugins"] = nlohmann::ordered_json::array();
  for (const PluginRecord& plugin : plugins) {
    json["plugins"].push_back({{"name", plugin.name},
                               {"version", plugin.version},
                               {"file", plugin.file},
                               {"hash", plugin.hash},
                               {"code_hash", plugin.code_hash}});
  }
  return json;
}

double number_in(const nlohmann::ordered_json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_number() ? json[key].get<double>()
                                                                         : std::numeric_limits<double>::quiet_NaN();
}

nlohmann::ordered_json read_json(const std::filesystem::path& path) {
  return nlohmann::ordered_json::parse(base::text_if_readable(path).value_or(""), nullptr, false);
}

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json) {
  // Names of files may hold any bytes; what is not UTF-8 is replaced.
  write_file(path, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace millscope::output
