// The simulations that a study has made or is making, from its cache.
#include <fmt/chrono.h>
#include <algorithm>
#include <chrono>

#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "studies/campaign/progress.hpp"
#include "studies/report/one_section.hpp"

namespace millscope::report {
namespace {

namespace fs = std::filesystem;

/// The part of a simulation's time that is done, 0 … 1.
double fraction_of(const fs::path& run) {
  try {
    const double end = config::read_case((run / output::kResolvedCase).string()).time.end;
    return std::clamp(campaign::simulated_time(run) / end, 0.0, 1.0);
  } catch (const base::UserError&) {
    return 0;  // it has only just begun
  }
}

Json number_or_null(const Json& task, const char* key) {
  return task.contains(key) && task.at(key).is_number() ? task.at(key) : Json(nullptr);
}

Json task_json(const fs::path& entry) {
  const fs::path run = entry / "run";
  Json task = Json::object();
  std::error_code none;
  if (fs::exists(entry / "task.json", none)) task = json_object_of(entry / "task.json");
  const bool running = state_of(run, "summary.json") == State::running;
  const std::string state = running ? "running" : task.value("state", "waiting");
  const auto changed = fs::last_write_time(fs::exists(run / "summary.json", none) ? run / "summary.json" : entry / "case.yaml", none);
  const auto since = std::chrono::file_clock::to_sys(changed);
  return {{"label", task.value("label", entry.filename().string())},
          {"state", state},
          {"message", task.value("message", "")},
          {"wall_s", number_or_null(task, "wall_s")},
          {"fraction", state == "done" ? 1.0
                       : running       ? fraction_of(run)
                                       : 0.0},
          {"changed_unix_s", std::chrono::duration_cast<std::chrono::seconds>(since.time_since_epoch()).count()}};
}

}  // namespace

Json campaign_section(const fs::path& folder) {
  Json section = begun("campaign", "Simulations of " + output::without_end_slash(folder).filename().string(), folder);
  std::vector<Json> tasks;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "cache"))
    if (entry.is_directory() && fs::exists(entry.path() / "case.yaml")) tasks.push_back(task_json(entry.path()));
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Json& a, const Json& b) { return a.at("changed_unix_s") < b.at("changed_unix_s"); });
  section["tasks"] = tasks;
  for (const char* state : {"done", "running", "waiting", "failed"})
    section[state] = std::count_if(tasks.begin(), tasks.end(), [&](const Json& t) { return t.at("state") == state; });
  return section;
}

}  // namespace millscope::report
