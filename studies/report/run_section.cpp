#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/text.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/series.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/report/movie.hpp"
#include "studies/report/one_section.hpp"

namespace millscope::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRows = 2000;

/// Means over as many neighbouring rows as it takes to have at most kMostRows.
Json thinned(const std::vector<double>& column) {
  const std::size_t width = (column.size() + kMostRows - 1) / kMostRows;
  Json out = Json::array();
  for (std::size_t i = 0; width > 0 && i < column.size(); i += width) {
    double sum = 0;
    const std::size_t end = std::min(i + width, column.size());
    for (std::size_t k = i; k < end; ++k) sum += column[k];
    out.push_back(sum / static_cast<double>(end - i));
  }
  return out;
}

Json series_json(const fs::path& folder) {
  Json out = Json::object();
  if (!fs::exists(folder / "series.csv")) return out;
  const output::Series series = output::read_series(folder / "series.csv");
  for (std::size_t c = 0; c < series.names.size(); ++c) out[series.names[c]] = thinned(series.columns[c]);
  return out;
}

Json mill_json(const fs::path& case_file, const host::Registry& registry) {
  const analysis::MillOfCase mill = analysis::read_mill_of_case(case_file, registry);
  if (!(mill.context.mill_radius > 0)) return nullptr;
  return {{"radius_m", mill.context.mill_radius},
          {"omega_rad_per_s", mill.context.omega},
          {"low_m", mill.context.mill_low},
          {"high_m", mill.context.mill_high}};
}

/// Movie, liner and mill; what cannot be shown is a note, not the end of the report: the figures do not need it.
void add_pictures(Json& section, const fs::path& folder, const host::Registry& registry, const SectionOptions& options) {
  const fs::path case_file = folder / output::kResolvedCase;
  for (const char* key : {"movie", "liner", "mill"}) section[key] = nullptr;
  try {
    const config::Case c = config::read_case(case_file.string());
    section["liner"] = liner_of(c, registry, section["notes"]);
    section["mill"] = mill_json(case_file, registry);
  } catch (const base::UserError& e) {
    section["notes"].push_back(fmt::format("the mill is not drawn: {}", e.what()));
  }
  if (!fs::exists(folder / "frames.h5")) {
    section["notes"].push_back("the charge is not drawn: the run wrote no frames; give it output: {frames: {every_s: 0.01, from_s: 0}}");
    return;
  }
  try {
    section["movie"] = movie_of(output::FrameReader(folder / "frames.h5"), options.movie_bytes);
  } catch (const base::UserError& e) {
    section["notes"].push_back(fmt::format("the charge is not drawn: {}", e.what()));
  }
}

}  // namespace

Json run_section(const fs::path& folder, const host::Registry& registry, const SectionOptions& options) {
  const State state = state_of(folder, "summary.json");
  const Json summary = state == State::done ? json_object_of(folder / "summary.json") : Json(nullptr);
  const config::Case c = config::read_case((folder / output::kResolvedCase).string());
  Json section = begun("run", c.name, folder);
  section["state"] = text(state);
  section["summary"] = summary;
  if (summary.is_object() && summary.contains("engine") && summary["engine"].contains("notes")) {
    for (const Json& note : summary["engine"]["notes"]) section["notes"].push_back(note);
  }
  section["case"] = base::text_of(folder / output::kResolvedCase);
  section["series"] = series_json(folder);
  section["progress"] = nullptr;
  const Json& times = section["series"].contains("time_s") ? section["series"]["time_s"] : Json::array();
  if (state != State::done && !times.empty()) section["progress"] = {{"time_s", times.back()}, {"end_s", c.time.end}};
  add_pictures(section, folder, registry, options);
  return section;
}

}  // namespace millscope::report
