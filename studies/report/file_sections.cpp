#include <fmt/format.h>
#include <sys/file.h>

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>

#include "kernel/base/table.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/directory.hpp"
#include "studies/report/one_section.hpp"

namespace millscope::report {
namespace {

namespace fs = std::filesystem;

/// Whether a process holds the folder's lock. A file that a killed run left behind is held by nobody.
bool is_held(const fs::path& folder) {
  const int lock = ::open((folder / ".lock").c_str(), O_RDONLY | O_CLOEXEC);
  if (lock < 0) return false;
  const bool held = ::flock(lock, LOCK_SH | LOCK_NB) != 0;
  ::close(lock);
  return held;
}

std::vector<fs::path> sorted_files(const fs::path& folder, const char* ending) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Json table_json(const fs::path& file) {
  const base::Table table = base::Table::read(file);
  Json rows = Json::array();
  for (std::size_t r = 0; r < table.rows(); ++r) {
    Json row = Json::array();
    for (std::size_t c = 0; c < table.names().size(); ++c) {
      const std::string& cell = table.cell(r, c);
      const Json number = Json::parse(cell, nullptr, false);
      row.push_back(cell.empty() ? Json(nullptr) : number.is_number() ? number : Json(cell));
    }
    rows.push_back(row);
  }
  return {{"columns", table.names()}, {"rows", rows}};
}

/// A section that is one JSON file.
Json from_file(const char* kind, const char* file, const fs::path& folder) {
  Json section = begun(kind, output::without_end_slash(folder).filename(), folder);
  section[kind] = json_object_of(folder / file);
  return section;
}

/// The version of a file whose keys changed their name or meaning, and what is new in it.
struct Version {
  int number;
  const char* change;
};

Json from_version(const Version& version, const char* kind, const char* file, const fs::path& folder) {
  Json section = from_file(kind, file, folder);
  if (section[kind].value("schema_version", Json()) != version.number)
    throw base::UserError(fmt::format("{}: is of another schema_version than {}, in which {}; run the command that wrote it again",
                                      (folder / file).string(), version.number, version.change));
  return section;
}

}  // namespace

Json begun(const char* kind, const std::string& title, const fs::path& folder) {
  return {{"kind", kind}, {"title", title}, {"source", folder.lexically_normal().string()}, {"notes", Json::array()}};
}

Json json_object_of(const fs::path& file) {
  Json json = Json::parse(base::text_of(file), nullptr, false);
  if (!json.is_object())
    throw base::UserError(fmt::format("{}: is damaged: no JSON object; run the command that wrote it again", file.string()));
  return json;
}

State state_of(const fs::path& folder, const char* done) {
  if (is_held(folder)) return State::running;
  return fs::exists(folder / done) ? State::done : State::stopped;
}

const char* text(State state) { return state == State::running ? "running" : state == State::done ? "done" : "stopped"; }

Json comparison_section(const fs::path& folder) {
  Json section = from_file("comparison", "comparison.json", folder);
  section["pictures"] = Json::array();
  for (const fs::path& file : sorted_files(folder / "pictures", ".svg")) {
    section["pictures"].push_back({{"name", file.stem().string()}, {"svg", base::text_of(file)}});
  }
  return section;
}

Json crosscheck_section(const fs::path& folder) {
  Json section = from_file("crosscheck", "crosscheck.json", folder);
  section["title"] = section["crosscheck"].value("name", section["title"]);
  return section;
}

Json wear_section(const fs::path& folder) {
  Json section = from_file("wear", "wear.json", folder);
  section["title"] = section["wear"].value("name", section["title"]);
  return section;
}

Json calibration_section(const fs::path& folder) {
  Json section = from_file("calibration", "calibration.json", folder);
  section["runs"] = fs::exists(folder / "runs.csv") ? table_json(folder / "runs.csv") : Json(nullptr);
  return section;
}

Json validation_section(const fs::path& folder) {
  return from_version({2, "all numbers of a condition are judged at once, too"}, "validation", "validation.json", folder);
}

Json diagnosis_section(const fs::path& folder) {
  return from_version({2, "'share' and 'dose' are called 'strength'"}, "diagnosis", "diagnosis.json", folder);
}

Json challenge_section(const fs::path& folder) {
  Json section = from_version({3, "intervals are counted for each engine"}, "challenge", "score.json", folder);
  section["score"] = section["challenge"];
  section.erase("challenge");
  return section;
}

}  // namespace millscope::report
