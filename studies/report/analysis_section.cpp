#include <cmath>

#include "studies/analysis/results_file.hpp"
#include "studies/picture/outline.hpp"
#include "studies/report/one_section.hpp"

namespace millscope::report {
namespace {

using analysis::ResultArray;
using analysis::ResultSet;

constexpr std::size_t kMostValues = 40000;  ///< of one result; a map of 200 × 200 cells

/// Six digits are more than a page shows, and half the file of seventeen.
Json rounded(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) {
    if (!std::isfinite(v)) {
      out.push_back(nullptr);
      continue;
    }
    const double scale = v == 0 ? 1 : std::pow(10.0, 5 - std::floor(std::log10(std::fabs(v))));
    out.push_back(std::isfinite(scale) && scale > 0 ? std::round(v * scale) / scale : v);
  }
  return out;
}

Json axes_json(const ResultSet& results, const ResultArray& array) {
  Json axes = Json::array();
  for (std::size_t d = 0; d < array.shape.size(); ++d) {
    const ResultArray* axis = results.axis(array, d);
    if (axis == nullptr) {
      axes.push_back(nullptr);
    } else {
      axes.push_back({{"name", axis->name}, {"unit", axis->unit}, {"doc", axis->doc}, {"values", rounded(axis->value)}});
    }
  }
  return axes;
}

Json result_json(const ResultSet& results, const ResultArray& array) {
  const auto or_null = [&](const auto& values) { return values.empty() ? Json(nullptr) : rounded(values); };
  // Of a map the standard error says what its interval says; of curves the interval is drawn.
  const bool is_map = array.shape.size() == 2;
  return {{"analyzer", array.analyzer},
          {"name", array.name},
          {"unit", array.unit},
          {"doc", array.doc},
          {"shape", array.shape},
          {"axes", axes_json(results, array)},
          {"value", rounded(array.value)},
          {"sem", or_null(array.sem)},
          {"low", is_map ? Json(nullptr) : or_null(array.low)},
          {"high", is_map ? Json(nullptr) : or_null(array.high)},
          {"flags", array.flags.empty() ? Json(nullptr) : Json(array.flags)}};
}

Json shell_json(const ResultSet& results, const host::Registry& registry, Json& notes) {
  std::string why;
  const picture::MillOutline outline = picture::outline_of(results, registry, why);
  if (!why.empty()) notes.push_back("the shell is drawn without lifters: " + why);
  if (!(outline.radius > 0)) return nullptr;
  Json segments = Json::array();
  for (const auto& s : outline.section) segments.push_back(rounded({s[0], s[1], s[2], s[3]}));
  const int turns = outline.omega > 0 ? 1 : outline.omega < 0 ? -1 : 0;
  return {{"radius_m", outline.radius}, {"turns", turns}, {"segments_m", segments}, {"angle_rad", 0}};
}

}  // namespace

Json analysis_section(const std::filesystem::path& folder, const host::Registry& registry) {
  const ResultSet results = analysis::read_results(folder);
  Json section = begun("analysis", results.meta.name, folder);
  section["meta"] = analysis::meta_json(results.meta);
  section["shell"] = shell_json(results, registry, section["notes"]);
  section["results"] = Json::array();
  for (const ResultArray& array : results.arrays) {
    if (array.is_axis) continue;
    if (array.shape.size() > 2 || array.size() > kMostValues) {
      section["notes"].push_back(array.analyzer + "." + array.name +
                                 " is not shown: it has more than two dimensions or too many values; results.h5 holds it");
      continue;
    }
    section["results"].push_back(result_json(results, array));
  }
  return section;
}

}  // namespace millscope::report
