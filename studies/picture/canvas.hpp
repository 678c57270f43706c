// Paper to draw on: one drawing code, written as SVG and as PNG. Lengths are points (1/72 inch), y downwards.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "studies/picture/color.hpp"

struct _cairo;  // cairo_t; NOLINT(bugprone-reserved-identifier): named so by cairo's header

namespace millscope::picture {

struct Point {
  double x = 0, y = 0;
};

struct Box {
  double left = 0, top = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

struct Pen {
  Color color;
  double width = 0.8;
  std::vector<double> dashes = {};
};

struct Font {
  double size = 8.5;
  bool bold = false;
  Color color = {};
};

enum class Align { start, middle, end };

/// Cells of an image, row by row from the top; a color with alpha 0 is left out.
struct Pixels {
  int width = 0, height = 0;
  std::vector<Color> color;
};

/// Pixels of the PNG per point.
inline constexpr int kPixelsPerPoint = 2;

class Canvas {
 public:
  explicit Canvas(_cairo* context) : context_(context) {}

  void line(Point from, Point to, const Pen& pen);
  void polyline(std::span<const Point> points, const Pen& pen, bool closed = false);
  void fill(std::span<const Point> outline, const Color& color);
  void rectangle(const Box& box, const Pen& pen);
  void fill_rectangle(const Box& box, const Color& color);
  void circle(Point centre, double radius, const Pen& pen);
  void dot(Point centre, double radius, const Color& color);
  /// Slanting lines over the box, or over the disc where `radius` is not 0.
  void hatch(const Box& box, const Pen& pen, double spacing);
  /// `at` is the left end, the middle or the right end of the base line; turned by 90° anticlockwise where `upright`.
  void text(Point at, const std::string& words, const Font& font, Align align = Align::start, bool upright = false);
  void image(const Pixels& pixels, const Box& box);
  /// What `draw` draws is cut off at the box, or at the circle.
  void within(const Box& box, const std::function<void()>& draw);
  void within(Point centre, double radius, const std::function<void()>& draw);

 private:
  void stroke(const Pen& pen);
  _cairo* context_;
};

/// Width of one line of text.
double text_width(const std::string& words, const Font& font);

/// Words broken into lines no wider than `width` (a single word may be).
std::vector<std::string> wrap(const std::string& words, const Font& font, double width);

/// What is written: `draw` is called once for each format and must draw the same each time.
struct Sheet {
  double width = 0, height = 0;
  std::string title, description;  ///< for readers that cannot see the SVG
  std::function<void(Canvas&)> draw;
};

/// Writes STEM.svg and STEM.png, aside and renamed; the same sheet gives the same bytes. Throws base::UserError when they cannot be
/// written or no font is installed.
void write_sheet(const Sheet& sheet, const std::filesystem::path& stem);

}  // namespace millscope::picture
