#include "studies/picture/results_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>

#include "kernel/base/error.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::picture {
namespace {

/// "theta_edges_deg" → "theta": what an axis counts, without how.
std::string axis_label(const std::string& name) {
  constexpr std::array<const char*, 9> how{"edges", "edge", "centres", "centre", "centers", "deg", "mm", "ms", "s"};
  std::string label;
  const std::string words = words_of(name);
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    if (std::find(how.begin(), how.end(), word) == how.end()) label += (label.empty() ? "" : " ") + word;
    begin = end + 1;
  }
  return label.empty() ? words : label;
}

const analysis::ResultArray* axis_array(const analysis::ResultSet& results, const analysis::ResultArray& array, std::size_t dimension) {
  if (dimension >= array.axes.size() || array.axes[dimension].empty()) return nullptr;
  for (const analysis::ResultArray& other : results.arrays) {
    if (other.analyzer == array.analyzer && other.name == array.axes[dimension]) return &other;
  }
  return nullptr;
}

std::vector<double> edges_between(const std::vector<double>& centres) {
  std::vector<double> edges;
  const std::size_t n = centres.size();
  if (n == 1) return {centres[0] - 0.5, centres[0] + 0.5};
  edges.push_back(centres[0] - (centres[1] - centres[0]) / 2);
  for (std::size_t i = 0; i + 1 < n; ++i) edges.push_back(std::midpoint(centres[i], centres[i + 1]));
  edges.push_back(centres[n - 1] + (centres[n - 1] - centres[n - 2]) / 2);
  return edges;
}

std::string full_name(const analysis::ResultArray& array) { return array.analyzer + "." + array.name; }

/// What a reader must know of the uncertainty, after the sentence that says what is drawn.
std::string note_of(const analysis::ResultArray& array) {
  std::size_t few = 0, all = 0;
  for (std::size_t i = 0; i < array.flags.size(); ++i) {
    if (!std::isfinite(array.value[i]) || array.value[i] == 0) continue;
    ++all;
    few += (array.flags[i] & (analysis::kFewBlocks | analysis::kNoUncertainty)) != 0 ? 1 : 0;
  }
  if (few == 0) return array.doc;
  return fmt::format("{} {} of {} values rest on fewer than 10 independent blocks.", array.doc, few, all);
}

bool has_value(const analysis::ResultArray& array) {
  return std::any_of(array.value.begin(), array.value.end(), [](double v) { return std::isfinite(v); });
}

void draw_result_map(const analysis::ResultSet& results, const analysis::ResultArray& array, const MillOutline& mill,
                     const std::filesystem::path& stem) {
  const CellAxis y = cell_axis(results, array, 0), x = cell_axis(results, array, 1);
  const bool across = is_cross_section(y, x);
  draw_map({.title = title_of(array.name),
            .subtitle = source_line(results.meta),
            .x = x,
            .y = y,
            .value = {words_of(array.name), array.unit, array.value},
            .mill = across ? mill : MillOutline{},
            .names = category_names(array),
            .note = category_names(array).empty() ? note_of(array) : ""},
           stem);
}

void draw_result_curve(const analysis::ResultSet& results, const analysis::ResultArray& array, const std::filesystem::path& stem) {
  const analysis::ResultArray* const axis = axis_array(results, array, 0);
  draw_curves({.title = title_of(array.name),
               .subtitle = source_line(results.meta),
               .x_label = axis != nullptr ? axis_label(axis->name) : "number",
               .x_unit = axis != nullptr ? axis->unit : "1",
               .value_label = words_of(array.name),
               .value_unit = array.unit,
               .curves = {curve_of(results, array, results.meta.name.empty() ? "result" : results.meta.name)},
               .band = fmt::format("{:.0f} % interval", 100 * results.meta.confidence),
               .points = axis == nullptr,
               .note = note_of(array)},
              stem);
}

/// Why a result has no picture; empty: it has one.
std::string obstacle(const analysis::ResultArray& array) {
  if (array.shape.size() > 2) return fmt::format("{} dimensions; see the tables", array.shape.size());
  if (!has_value(array)) return "no value is defined";
  if (array.shape.size() == 1 && array.size() < 2) return "a single value";
  return "";
}

}  // namespace

std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::vector<std::string> category_names(const analysis::ResultArray& array) {
  if (array.shape.size() != 2 || array.unit != "1") return {};
  std::vector<std::string> names;
  for (std::size_t at = 0; at < array.doc.size();) {
    const std::string number = std::to_string(names.size()) + " ";
    if (array.doc.compare(at, number.size(), number) != 0) return {};
    const std::size_t end = std::min(array.doc.find(", ", at), array.doc.size());
    names.push_back(array.doc.substr(at + number.size(), end - at - number.size()));
    at = end + 2;
  }
  if (names.size() < 2) return {};
  if (names.back().ends_with('.')) names.back().pop_back();
  return names;
}

std::string title_of(const std::string& name) {
  std::string title = words_of(name);
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

std::string source_line(const analysis::ResultMeta& meta) {
  double seconds = 0;
  for (const analysis::ResultBlock& block : meta.blocks) seconds += block.duration;
  if (meta.blocks.empty()) seconds = meta.context.end - meta.context.start;
  const char* what = meta.source == "recording" ? "recording" : meta.source == "tracks" ? "simulated beads" : "simulation";
  const bool one_frame = meta.blocks.size() == 1 && meta.context.start == meta.context.end;
  return fmt::format("{}{} · {}", meta.name.empty() ? "" : meta.name + " · ", what,
                     one_frame ? "one frame" : significant_text(seconds, 3) + " s analysed");
}

MillOutline shell_of(const analysis::ResultSet& results) {
  return {.radius = results.meta.context.mill_radius, .omega = results.meta.context.omega};
}

CellAxis cell_axis(const analysis::ResultSet& results, const analysis::ResultArray& array, std::size_t dimension) {
  const std::size_t count = array.shape.at(dimension);
  const analysis::ResultArray* const axis = axis_array(results, array, dimension);
  CellAxis cells{"number", "1", {}};
  if (axis == nullptr) {
    for (std::size_t i = 0; i <= count; ++i) cells.edges.push_back(static_cast<double>(i) + 0.5);
    return cells;
  }
  cells.label = axis_label(axis->name);
  cells.unit = axis->unit;
  if (axis->size() == count + 1) {
    cells.edges = axis->value;
  } else if (axis->size() == count) {
    cells.edges = edges_between(axis->value);
  } else {
    throw base::UserError(fmt::format("{}: its axis '{}' has {} values for {} cells; an axis holds edges (one more) or centres",
                                      full_name(array), axis->name, axis->size(), count));
  }
  return cells;
}

Curve curve_of(const analysis::ResultSet& results, const analysis::ResultArray& array, const std::string& label) {
  Curve curve{label, {}, array.value, array.low, array.high};
  if (const analysis::ResultArray* const axis = axis_array(results, array, 0)) {
    curve.x = axis->value;
  } else {
    curve.x.resize(array.size());
    std::iota(curve.x.begin(), curve.x.end(), 1.0);
  }
  return curve;
}

bool is_cross_section(const CellAxis& y, const CellAxis& x) { return x.label == "x" && y.label == "y" && x.unit == "m" && y.unit == "m"; }

DrawnPictures draw_results(const analysis::ResultSet& results, const std::filesystem::path& directory, const MillOutline& mill) {
  DrawnPictures drawn;
  std::filesystem::create_directories(directory);
  for (const analysis::ResultArray& array : results.arrays) {
    if (array.is_axis || array.shape.empty()) continue;
    if (const std::string why = obstacle(array); !why.empty()) {
      drawn.left_out.push_back(full_name(array) + ": " + why);
      continue;
    }
    const std::filesystem::path stem = directory / full_name(array);
    if (array.shape.size() == 2) {
      draw_result_map(results, array, mill, stem);
    } else {
      draw_result_curve(results, array, stem);
    }
    drawn.files.push_back(stem);
  }
  return drawn;
}

}  // namespace millscope::picture
