#include "studies/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <system_error>

#include "kernel/output/directory.hpp"
#include "studies/report/one_section.hpp"

namespace millscope::report {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 3;

/// A kind of result, and the file by which its folder is known.
struct Kind {
  const char* file;
  std::function<Json(const fs::path&, const host::Registry&, const SectionOptions&)> make;
};

const std::array<Kind, 10>& kinds() {
  static const std::array<Kind, 10> all{{
      {output::kResolvedCase, run_section},
      {"results.h5",
       [](const fs::path& folder, const host::Registry& registry, const SectionOptions&) { return analysis_section(folder, registry); }},
      {"comparison.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return comparison_section(folder); }},
      {"crosscheck.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return crosscheck_section(folder); }},
      {"wear.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return wear_section(folder); }},
      {"cache", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return campaign_section(folder); }},
      {"calibration.json",
       [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return calibration_section(folder); }},
      {"validation.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return validation_section(folder); }},
      {"diagnosis.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return diagnosis_section(folder); }},
      {"score.json", [](const fs::path& folder, const host::Registry&, const SectionOptions&) { return challenge_section(folder); }},
  }};
  return all;
}

/// A folder and what it is, ordered as a study goes.
struct Place {
  std::size_t kind;
  fs::path folder;
  auto operator<=>(const Place&) const = default;
};

void find_places(const fs::path& folder, int depth, std::vector<Place>& places) {
  bool any = false;
  for (std::size_t k = 0; k < kinds().size(); ++k) {
    if (!fs::exists(folder / kinds()[k].file)) continue;
    places.push_back({k, folder});
    any = true;
  }
  // Below a score are the sets that it counts, below a wear study its stages.
  if ((any && (fs::exists(folder / "score.json") || fs::exists(folder / "wear.json"))) || depth == kDeepest) return;
  std::error_code error;
  const fs::directory_iterator entries(folder, fs::directory_options::skip_permission_denied, error);
  if (error == std::errc::no_such_file_or_directory) return;  // a campaign that goes on took it away since it was listed
  if (error) throw fs::filesystem_error("cannot list what a report is made of", folder, error);
  for (const fs::directory_entry& entry : entries) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || entry.is_symlink() || name == "cache" || name.starts_with('.')) continue;
    // What another engine was given is no run of its own.
    if (name == output::kEngineFolder && fs::exists(folder / output::kResolvedCase)) continue;
    find_places(entry.path(), depth + 1, places);
  }
}

std::string known_files() {
  std::string names;
  for (const Kind& k : kinds()) names += (names.empty() ? "" : ", ") + std::string(k.file);
  return names;
}

}  // namespace

std::vector<Json> sections_of(const fs::path& out, const host::Registry& registry, const SectionOptions& options) {
  if (!fs::exists(out))
    throw base::UserError(fmt::format(
        "{}: there is no such folder; give one that run, analyze, compare, calibrate, validate or diagnose wrote", out.string()));
  if (!fs::is_directory(out)) throw base::UserError(fmt::format("{}: is a file; give the folder that it lies in", out.string()));
  std::vector<Place> places;
  find_places(out, 0, places);
  if (places.empty())
    throw base::UserError(fmt::format("{}: holds no result of millscope: none of {}; give the folder that a command wrote with -o",
                                      out.string(), known_files()));
  std::sort(places.begin(), places.end());
  std::vector<Json> sections;
  for (const Place& place : places) sections.push_back(kinds()[place.kind].make(place.folder, registry, options));
  return sections;
}

}  // namespace millscope::report
