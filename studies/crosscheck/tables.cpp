#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/columns.hpp"
#include "kernel/output/csv.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/summary.hpp"
#include "studies/crosscheck/crosscheck.hpp"

namespace millscope::crosscheck {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kManyTimes = 10;  // so many more seeds are none that anyone would try
constexpr double kLevel = 0.05;    // of all quantities together

/// A unit in which lengths and small powers read well, and its factor on SI.
struct Shown {
  std::string unit;
  double factor;
};

Shown shown(const Compared& c) {
  if (c.unit == "m") return {"mm", 1e3};
  if (c.unit == "J" && std::fabs(c.ours.value) < 1) return {"mJ", 1e3};
  return {c.unit == "1" ? "" : c.unit, 1};
}

/// With two digits of its error.
std::string number(double value, double error) {
  if (!(error > 0) || !std::isfinite(error)) return fmt::format("{:.4g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string with_error(const Mean& m, double factor) {
  const double error = factor * m.error;
  return fmt::format("{} ± {}", number(factor * m.value, error), number(error, error));
}

std::string p_text(double p) { return p < 0.001 ? "<0.001" : fmt::format("{:.3f}", p); }

std::string limit_text(const Compared& c) { return c.limit ? fmt::format("{:.2g}", shown(c).factor * *c.limit) : ""; }

std::string judged(const Compared& c, std::size_t seeds) {
  if (c.judgement != Judgement::unresolved) return text(c.judgement);
  if (c.seeds_needed > kManyTimes * static_cast<double>(seeds)) return "not resolved: lies at the limit";
  return fmt::format("not resolved: {:.0f} seeds would do", std::ceil(c.seeds_needed));
}

/// What has a limit, and what differs; the rest is in the files.
std::string table_of(const Found& found) {
  const std::vector<Compared>& all = found.quantities;
  std::vector<base::Row> rows{{"quantity", "millscope", found.engine, "difference", "unit", "p, all together", "limit", ""}};
  for (const Compared& c : all) {
    if (!c.limit && c.adjusted_p > kLevel) continue;
    const double factor = shown(c).factor;
    rows.push_back({c.name, with_error(c.ours, factor), with_error(c.theirs, factor), with_error(c.difference, factor), shown(c).unit,
                    p_text(c.adjusted_p), limit_text(c), judged(c, found.seeds)});
  }
  std::string said = base::columns_to_left(rows);
  if (const std::size_t rest = all.size() + 1 - rows.size(); rest > 0)
    said += fmt::format("… and {} more that do not differ (quantities.csv)\n", rest);
  return said;
}

/// What a setting of ours moves, and what it leaves, where there are limits.
std::string table_of_switches(const Found& found) {
  std::vector<base::Row> rows{{"setting on our side", "quantity", "moves it by", "leaves", "unit", "limit"}};
  for (const Switched& s : found.switches) {
    for (std::size_t q = 0; q < s.moves.size(); ++q) {
      if (!s.moves[q].limit) continue;
      const Shown by = shown(s.moves[q]);
      rows.push_back({s.setting, s.moves[q].name, with_error(s.moves[q].difference, by.factor), with_error(s.left[q].difference, by.factor),
                      by.unit, limit_text(s.moves[q])});
    }
  }
  return base::columns_to_left(rows);
}

std::vector<std::string> names_of(const Found& found, Judgement judgement) {
  std::vector<std::string> names;
  for (const Compared& c : found.quantities) {
    if (c.judgement != judgement) continue;
    const Shown by = shown(c);
    names.push_back(judgement == Judgement::agree
                        ? c.name
                        : fmt::format("{} by {} {} (limit {})", c.name, with_error(c.difference, by.factor), by.unit, limit_text(c)));
  }
  return names;
}

Json mean_json(const Mean& m) { return {{"value", m.value}, {"error", m.error}}; }

Json json_of(const std::vector<Compared>& all) {
  Json list = Json::array();
  for (const Compared& c : all) {
    Json j{{"name", c.name},
           {"unit", c.unit},
           {"ours", mean_json(c.ours)},
           {"theirs", mean_json(c.theirs)},
           {"difference", mean_json(c.difference)},
           {"p", c.p},
           {"adjusted_p", c.adjusted_p}};
    if (c.limit) j.update({{"limit", *c.limit}, {"judgement", text(c.judgement)}, {"seeds_needed", c.seeds_needed}});
    list.push_back(j);
  }
  return list;
}

std::string csv_of(const std::vector<Compared>& all) {
  std::string csv = "quantity,unit,ours,ours_error,theirs,theirs_error,difference,difference_error,p,adjusted_p,limit,judgement\n";
  for (const Compared& c : all)
    csv += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{},{}\n", output::csv_cell(c.name), c.unit,
                       c.ours.value, c.ours.error, c.theirs.value, c.theirs.error, c.difference.value, c.difference.error, c.p,
                       c.adjusted_p, c.limit ? fmt::format("{:.9g}", *c.limit) : "", text(c.judgement));
  return csv;
}

}  // namespace

std::string sentence(const Found& found) {
  const auto differ = names_of(found, Judgement::differ), open = names_of(found, Judgement::unresolved),
             agree = names_of(found, Judgement::agree);
  std::string said;
  const auto add = [&](const std::vector<std::string>& names, const char* what) {
    if (!names.empty()) said += fmt::format("{}{}: {}", said.empty() ? "" : "; ", what, fmt::join(names, ", "));
  };
  add(differ, "Differ");
  add(open, said.empty() ? "Not resolved" : "not resolved");
  add(agree, said.empty() ? "Agree within the limits" : "agree within the limits");
  const auto beyond =
      std::count_if(found.quantities.begin(), found.quantities.end(), [](const Compared& c) { return c.adjusted_p <= kLevel; });
  return fmt::format("{}. Of {} quantities {} at 5 % together", said, found.quantities.size(),
                     beyond == 0   ? "none differs"
                     : beyond == 1 ? "one differs"
                                   : fmt::format("{} differ", beyond));
}

std::string table(const Found& found) {
  std::string said = table_of(found);
  if (!found.switches.empty()) said += "\n" + table_of_switches(found);
  return said;
}

Json json_of(const Found& found) {
  Json j{{"schema_version", 1},
         {"name", found.name},
         {"engine", found.engine},
         {"engine_version", found.engine_version},
         {"seeds", found.seeds},
         {"window_s", found.window_s},
         {"sentence", sentence(found)},
         {"level", kLevel},
         {"quantities", json_of(found.quantities)},
         {"switches", Json::array()},
         {"differs", found.differs},
         {"left_out", found.left_out},
         {"runs", Json::array()}};
  for (const Switched& s : found.switches)
    j["switches"].push_back({{"setting", s.setting}, {"moves", json_of(s.moves)}, {"leaves", json_of(s.left)}});
  for (const Played& p : found.runs) j["runs"].push_back({{"label", p.label}, {"folder", p.folder.string()}, {"wall_s", p.wall_s}});
  return j;
}

void write(const Found& found, const std::filesystem::path& folder) {
  output::write_file(folder / "quantities.csv", csv_of(found.quantities));
  output::write_json(folder / "crosscheck.json", json_of(found));
}

}  // namespace millscope::crosscheck
