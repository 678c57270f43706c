#include "studies/campaign/cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "kernel/base/text.hpp"
#include "kernel/config/writer.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/engine/engine.hpp"

namespace millscope::campaign {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 5> kStages{"waiting", "running", "interrupted", "done", "failed"};

Stage stage_named(const std::string& word) {
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    if (word == kStages[i]) return static_cast<Stage>(i);
  }
  return Stage::waiting;
}

/// Puts a copy named after its content into CACHE/files; returns its path as seen from an entry.
std::string keep_copy(const NamedFile& file, const fs::path& cache) {
  const std::string name = file.hash + fs::path(file.path).extension().string();
  const fs::path copy = cache / "files" / name;
  if (!fs::exists(copy)) {
    make_directory(copy.parent_path());
    const std::optional<std::string> bytes = base::text_if_readable(file.path);
    if (!bytes || content_hash(*bytes) != file.hash)
      throw base::UserError(file.path + ": changes while the campaign is being prepared; start again when it is whole");
    output::write_file(copy, *bytes);
  }
  return "../files/" + name;
}

}  // namespace

void make_directory(const fs::path& directory) {
  std::error_code trouble;
  fs::create_directories(directory, trouble);
  if (trouble) output::throw_write_error(directory, trouble.value());
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string last_line(const fs::path& file) {
  std::string last;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) last = line;
  }
  constexpr std::string_view kName = "millscope: ";
  return last.starts_with(kName) ? last.substr(kName.size()) : last;
}

void Entry::prepare(const Identity& identity, const std::string& label) const {
  make_directory(folder_);
  if (!fs::exists(case_file())) {
    std::string text = identity.case_yaml;
    for (const NamedFile& file : identity.files) {
      if (file.alone) text = replaced(std::move(text), config::quoted(file.path), config::quoted(keep_copy(file, folder_.parent_path())));
    }
    output::write_file(case_file(), text);
  }
  if (fs::exists(folder_ / "task.json")) return;
  TaskRecord record;
  record.label = label;
  record.program = identity.program;
  write(record);
}

void Entry::begin_from(const std::string& donor_key, double develop_s) const {
  constexpr std::string_view kStart = "\nstart: ";
  std::string text = base::text_of(case_file());
  const std::string before = text;
  if (const std::size_t at = text.rfind(kStart); at != std::string::npos) text.resize(at + 1);
  if (!donor_key.empty()) text += fmt::format("{}{{run: ../{}/run, develop_s: {}}}\n", kStart.substr(1), donor_key, develop_s);
  if (text != before) output::write_file(case_file(), text);
}

TaskRecord Entry::read() const {
  const Json json = output::read_json(folder_ / "task.json");
  TaskRecord record;
  if (json.is_object()) {
    record.stage = stage_named(json.value("state", ""));
    record.label = json.value("label", "");
    record.message = json.value("message", "");
    record.attempts = json.value("attempts", 0);
    record.wall_s = json.value("wall_s", 0.0);
    record.host = json.value("host", "");
    record.program = json.value("program", base::ProgramParts{});
  }
  const Json summary = output::read_json(run() / "summary.json");
  if (summary.is_object()) {
    record.stage = Stage::done;
    record.message.clear();
    record.wall_s = summary.value("wall_s", 0.0);
  } else if (record.stage == Stage::done) {
    record.stage = Stage::interrupted;  // somebody took the results away
  }
  return record;
}

void Entry::write(const TaskRecord& record) const {
  Json json;
  json["schema_version"] = 1;
  json["key"] = folder_.filename().string();
  json["label"] = record.label;
  json["state"] = kStages[static_cast<std::size_t>(record.stage)];
  if (!record.message.empty()) json["message"] = record.message;
  json["attempts"] = record.attempts;
  if (record.stage == Stage::done) json["wall_s"] = record.wall_s;
  if (!record.host.empty()) json["host"] = record.host;
  json["program"] = record.program;
  output::write_json(folder_ / "task.json", json);
}

std::int64_t Entry::checkpoint_time() const {
  std::int64_t newest = 0;
  for (const fs::path& file : {run() / "checkpoint.h5", engine::restart_file(run())}) {
    struct stat s {};
    if (::stat(file.c_str(), &s) == 0)
      newest = std::max(newest, static_cast<std::int64_t>(s.st_mtim.tv_sec) * 1'000'000'000 + s.st_mtim.tv_nsec);
  }
  return newest;
}

Outcome outcome_of(const Entry& entry, const TaskRecord& record) {
  Outcome outcome;
  outcome.state = record.stage == Stage::done ? State::done : State::failed;
  outcome.folder = entry.run();
  outcome.message = record.message;
  outcome.wall_s = record.wall_s;
  outcome.key = entry.folder().filename().string();
  return outcome;
}

}  // namespace millscope::campaign
