#include "studies/picture/canvas.hpp"

#include <cairo-svg.h>
#include <cairo.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "studies/picture/svg_names.hpp"

#ifdef __SANITIZE_ADDRESS__
// fontconfig keeps what it found until the process ends, without giving it back: no leak of ours.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() { return "leak:libfontconfig"; }
#endif

namespace millscope::picture {
namespace {

constexpr const char* kFamily = "DejaVu Sans";

using CairoSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using CairoContext = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void set_color(cairo_t* cairo, const Color& color) { cairo_set_source_rgba(cairo, color.red, color.green, color.blue, color.alpha); }

// Without hinting, so that letters have the same widths at every size and in both formats.
void set_font(cairo_t* cairo, const Font& font) {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo, options);
  cairo_font_options_destroy(options);
  cairo_select_font_face(cairo, kFamily, CAIRO_FONT_SLANT_NORMAL, font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, font.size);
}

double advance(cairo_t* cairo, const std::string& words) {
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, words.c_str(), &extents);
  return extents.x_advance;
}

void path(cairo_t* cairo, std::span<const Point> points) {
  cairo_new_path(cairo);
  for (const Point& p : points) cairo_line_to(cairo, p.x, p.y);
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

void require(cairo_status_t status, const std::filesystem::path& file) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw base::UserError(file.string() + ": the picture cannot be drawn (" + cairo_status_to_string(status) + "); is there memory left?");
  }
}

std::string draw_svg(const Sheet& sheet, const std::filesystem::path& file) {
  std::string bytes;
  CairoSurface surface(cairo_svg_surface_create_for_stream(append, &bytes, sheet.width, sheet.height), cairo_surface_destroy);
  const CairoContext context(cairo_create(surface.get()), cairo_destroy);
  Canvas canvas(context.get());
  sheet.draw(canvas);
  require(cairo_status(context.get()), file);
  cairo_surface_finish(surface.get());
  require(cairo_surface_status(surface.get()), file);
  return describe_svg(stable_svg_names(bytes), sheet.title, sheet.description);
}

std::string draw_png(const Sheet& sheet, const std::filesystem::path& file) {
  const auto pixels = [](double points) { return static_cast<int>(std::ceil(points * kPixelsPerPoint)); };
  CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(sheet.width), pixels(sheet.height)), cairo_surface_destroy);
  const CairoContext context(cairo_create(surface.get()), cairo_destroy);
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  cairo_scale(context.get(), kPixelsPerPoint, kPixelsPerPoint);
  Canvas canvas(context.get());
  sheet.draw(canvas);
  require(cairo_status(context.get()), file);
  std::string bytes;
  require(cairo_surface_write_to_png_stream(surface.get(), append, &bytes), file);
  return bytes;
}

}  // namespace

void Canvas::stroke(const Pen& pen) {
  set_color(context_, pen.color);
  cairo_set_line_width(context_, pen.width);
  cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(context_, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
  cairo_stroke(context_);
}

void Canvas::line(Point from, Point to, const Pen& pen) { polyline(std::array{from, to}, pen); }

void Canvas::polyline(std::span<const Point> points, const Pen& pen, bool closed) {
  path(context_, points);
  if (closed) cairo_close_path(context_);
  stroke(pen);
}

void Canvas::fill(std::span<const Point> outline, const Color& color) {
  path(context_, outline);
  set_color(context_, color);
  cairo_fill(context_);
}

void Canvas::rectangle(const Box& box, const Pen& pen) {
  cairo_rectangle(context_, box.left, box.top, box.width, box.height);
  stroke(pen);
}

void Canvas::fill_rectangle(const Box& box, const Color& color) {
  cairo_rectangle(context_, box.left, box.top, box.width, box.height);
  set_color(context_, color);
  cairo_fill(context_);
}

void Canvas::circle(Point centre, double radius, const Pen& pen) {
  cairo_new_path(context_);
  cairo_arc(context_, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  stroke(pen);
}

void Canvas::dot(Point centre, double radius, const Color& color) {
  cairo_new_path(context_);
  cairo_arc(context_, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  set_color(context_, color);
  cairo_fill(context_);
}

void Canvas::hatch(const Box& box, const Pen& pen, double spacing) {
  within(box, [&] {
    cairo_new_path(context_);
    for (double x = box.left - box.height; x < box.right(); x += spacing) {
      cairo_move_to(context_, x, box.bottom());
      cairo_line_to(context_, x + box.height, box.top);
    }
    stroke(pen);
  });
}

void Canvas::text(Point at, const std::string& words, const Font& font, Align align, bool upright) {
  set_font(context_, font);
  set_color(context_, font.color);
  const double width = align == Align::start ? 0 : advance(context_, words);
  const double back = align == Align::middle ? width / 2 : width;
  cairo_save(context_);
  cairo_translate(context_, at.x, at.y);
  if (upright) cairo_rotate(context_, -std::numbers::pi / 2);
  cairo_move_to(context_, align == Align::start ? 0 : -back, 0);
  cairo_show_text(context_, words.c_str());
  cairo_restore(context_);
  cairo_new_path(context_);
}

void Canvas::image(const Pixels& pixels, const Box& box) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, pixels.width, pixels.height), cairo_surface_destroy);
  unsigned char* const data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  const auto byte = [](double part) { return static_cast<std::uint32_t>(std::lround(255 * part)); };
  for (int row = 0; data != nullptr && row < pixels.height; ++row) {
    auto* const line = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(row) * stride);
    for (int column = 0; column < pixels.width; ++column) {
      const Color& c =
          pixels.color[static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(column)];
      line[column] = c.alpha == 0 ? 0 : (255U << 24) | (byte(c.red) << 16) | (byte(c.green) << 8) | byte(c.blue);
    }
  }
  cairo_surface_mark_dirty(surface.get());
  cairo_save(context_);
  cairo_translate(context_, box.left, box.top);
  cairo_scale(context_, box.width / pixels.width, box.height / pixels.height);
  cairo_set_source_surface(context_, surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(context_), CAIRO_FILTER_NEAREST);
  cairo_paint(context_);
  cairo_restore(context_);
}

void Canvas::within(const Box& box, const std::function<void()>& draw) {
  cairo_save(context_);
  cairo_rectangle(context_, box.left, box.top, box.width, box.height);
  cairo_clip(context_);
  draw();
  cairo_restore(context_);
}

void Canvas::within(Point centre, double radius, const std::function<void()>& draw) {
  cairo_save(context_);
  cairo_new_path(context_);
  cairo_arc(context_, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_clip(context_);
  draw();
  cairo_restore(context_);
}

double text_width(const std::string& words, const Font& font) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), cairo_surface_destroy);
  const CairoContext context(cairo_create(surface.get()), cairo_destroy);
  set_font(context.get(), font);
  return advance(context.get(), words);
}

std::vector<std::string> wrap(const std::string& words, const Font& font, double width) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    std::string longer = line;
    longer.append(line.empty() ? "" : " ").append(word);
    if (!line.empty() && text_width(longer, font) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

void write_sheet(const Sheet& sheet, const std::filesystem::path& stem) {
  if (!(text_width("mill", Font{}) > 0)) {
    throw base::UserError("no font is installed, so pictures would have no words; install a font package, e.g. fonts-dejavu-core");
  }
  // Names hold dots ("shoulder.x"), so the ending is appended rather than replaced.
  const std::filesystem::path svg = stem.string() + ".svg", png = stem.string() + ".png";
  output::write_file(svg, draw_svg(sheet, svg));
  output::write_file(png, draw_png(sheet, png));
}

}  // namespace millscope::picture
