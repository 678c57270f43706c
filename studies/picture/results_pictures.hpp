// Pictures of everything that `analyze` found: one per result that has an axis.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/analysis/results.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::picture {

/// What was drawn, and what was not.
struct DrawnPictures {
  std::vector<std::filesystem::path> files;  ///< without ending: each is there as .svg and .png
  std::vector<std::string> left_out;         ///< "analyzer.name: why"
};

/// Draws each result of rank 1 and 2 as DIRECTORY/ANALYZER.NAME.svg and .png; maps over x and y with the mill. The directory is made.
/// Single numbers and axes have no picture; whatever else has none is listed. Throws base::UserError when nothing can be written.
DrawnPictures draw_results(const analysis::ResultSet& results, const std::filesystem::path& directory, const MillOutline& mill);

/// The shell that the results know of, without lifters.
MillOutline shell_of(const analysis::ResultSet& results);

/// "velocity_x" → "Velocity x".
std::string title_of(const std::string& name);

/// "velocity_x" → "velocity x".
std::string words_of(std::string name);

/// The names of a map of names, index by value: a result of rank 2 whose description is "0 nothing, 1 en masse, 2 …". Else empty.
std::vector<std::string> category_names(const analysis::ResultArray& array);

/// "run1 · 96.1 s of a recording".
std::string source_line(const analysis::ResultMeta& meta);

/// An axis of one dimension as edges of cells; centres are turned into edges. Without an axis: 0.5, 1.5, … of "number".
/// Throws base::UserError when the stored axis does not fit.
CellAxis cell_axis(const analysis::ResultSet& results, const analysis::ResultArray& array, std::size_t dimension);

/// A result of rank 1 as a curve with its interval.
Curve curve_of(const analysis::ResultSet& results, const analysis::ResultArray& array, const std::string& label);

/// Whether it is a map of the plane across the mill's axis: dimensions y and x, in m.
bool is_cross_section(const CellAxis& y, const CellAxis& x);

}  // namespace millscope::picture
