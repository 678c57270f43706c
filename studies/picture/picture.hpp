// Pictures of maps and curves, from plain arrays. Each call writes STEM.svg and STEM.png, whole or not at all; the same arrays give the
// same bytes. SI in; the axes show mm, %, mW and so on.
//
//   draw_map({.title = "Speed", .subtitle = "run1 · 96.1 s analysed", .x = {"x", "m", x_edges}, .y = {"y", "m", y_edges},
//             .value = {"speed", "m/s", values}, .mill = {.radius = 0.15, .omega = -6.1}}, "out/speed");
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace millscope::picture {

/// One axis of an array: edges of cells (one more than cells), increasing.
struct CellAxis {
  std::string label;
  std::string unit;
  std::vector<double> edges;
};

struct MapValues {
  std::string label;           ///< beside the colour bar
  std::string unit;            ///< "m/s"
  std::vector<double> values;  ///< [ny, nx], row-major: x runs fastest; NaN or exactly 0: no data, left blank
};

/// What is drawn of the mill in a map across its axis; a radius of 0: nothing.
struct MillOutline {
  double radius = 0;                                ///< of the bare shell, m
  std::array<double, 2> centre{0, 0};               ///< m
  double omega = 0;                                 ///< rad/s about z; not 0: an arrow shows the sense
  std::vector<std::array<double, 4>> section = {};  ///< lines x0 y0 x1 y1 of lifters, m
};

/// A line on a map, m; closed where it ends at its beginning.
using Outline = std::vector<std::array<double, 2>>;

/// A point that is worth a name, e.g. the toe.
struct Mark {
  std::string label;
  double x, y;  ///< m
};

enum class ColorScale { automatic, sequential, diverging };

struct MapPicture {
  std::string title;
  std::string subtitle;  ///< source, seconds analysed
  CellAxis x, y;
  MapValues value;
  MillOutline mill = {};
  ColorScale scale = ColorScale::automatic;  ///< automatic: diverging about zero where values of both signs matter
  std::vector<std::uint8_t> framed = {};     ///< [ny, nx] or empty: cells to be framed, e.g. those that differ
  std::vector<Mark> marks = {};
  std::vector<Outline> outlines = {};  ///< dashed, e.g. regions that differ
  std::string blank = "no data";       ///< why cells are hatched
  /// Not empty: the values are whole numbers, 0 is blank and n is called names[n]; a key stands in place of the colour bar.
  std::vector<std::string> names = {};
  std::string note = {};  ///< a line below, in front of what the drawing itself has to say
};

/// Colours end at the quantiles 0.01 and 0.99 of the values where single cells lie far outside; the bar then has points at its ends and
/// the note below gives the extremes.
void draw_map(const MapPicture& picture, const std::filesystem::path& stem);

/// One source. Where `x` has one value more than `value` it holds edges of bins, and the curve goes through their middles.
struct Curve {
  std::string label;
  std::vector<double> x;
  std::vector<double> value;                ///< NaN: undefined, the line breaks
  std::vector<double> low = {}, high = {};  ///< ends of the band, or empty
};

struct CurvePicture {
  std::string title;
  std::string subtitle;
  std::string x_label, x_unit;
  std::string value_label, value_unit;
  std::vector<Curve> curves;  ///< at least one
  std::string band = "90 % interval";
  bool zero_line = false;  ///< for differences
  bool points = false;     ///< places 1, 2, … without an order between: dots with whiskers, no line
  std::string note = {};
};

/// Logarithmic x where the edges grow by a constant factor; then also logarithmic values where all are positive and span three decades.
void draw_curves(const CurvePicture& picture, const std::filesystem::path& stem);

}  // namespace millscope::picture
