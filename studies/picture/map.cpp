// Maps of cells: colours, bar, shell, turning sense.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernel/base/error.hpp"
#include "studies/picture/frame.hpp"
#include "studies/picture/map_colors.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::picture {
namespace {

constexpr double kLongSide = 300, kShortSide = 60;        // of the plot, points
constexpr double kBarGap = 12, kBarWidth = 12, kTip = 7;  // colour bar
constexpr Color kHatch{0.80, 0.80, 0.80, 1};

/// The cell between edges that holds `value`.
std::size_t cell_of(const std::vector<double>& edges, double value) {
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
  return static_cast<std::size_t>(above - edges.begin()) - 1;
}

void check(const MapPicture& picture) {
  const auto increasing = [](const std::vector<double>& e) {
    return e.size() >= 2 && std::is_sorted(e.begin(), e.end()) && std::adjacent_find(e.begin(), e.end()) == e.end();
  };
  if (!increasing(picture.x.edges) || !increasing(picture.y.edges)) {
    throw base::UserError("picture '" + picture.title + "': the edges of its cells do not increase; check the axes of this result");
  }
  const std::size_t cells = (picture.x.edges.size() - 1) * (picture.y.edges.size() - 1);
  if (picture.value.values.size() != cells || (!picture.framed.empty() && picture.framed.size() != cells)) {
    throw base::UserError(fmt::format("picture '{}': {} values for {} cells; check the axes of this result", picture.title,
                                      picture.value.values.size(), cells));
  }
}

class MapDrawing {
 public:
  MapDrawing(const MapPicture& picture)
      : picture_(picture),
        colors_(choose_colors(picture)),
        room_(choose_room()),
        bar_(bar_axis()),
        frame_(words(), x_axis(), y_axis(), room_) {}

  Sheet sheet() {
    return {frame_.width(), frame_.height(), picture_.title, picture_.subtitle, [this](Canvas& canvas) { draw(canvas); }};
  }

 private:
  bool same_scale() const {
    const double ratio = x_span() / y_span();
    return picture_.x.unit == picture_.y.unit && ratio <= kLongSide / kShortSide && ratio >= kShortSide / kLongSide;
  }
  double x_span() const { return picture_.x.edges.back() - picture_.x.edges.front(); }
  double y_span() const { return picture_.y.edges.back() - picture_.y.edges.front(); }

  Frame::Room choose_room() const {
    if (!same_scale()) return {kLongSide, 0.75 * kLongSide, 75, 0};
    const double unit = kLongSide / std::max(x_span(), y_span());
    return {std::round(unit * x_span()), std::round(unit * y_span()), 75, 0};
  }

  Axis x_axis() const {
    return make_axis(picture_.x.label, picture_.x.unit, picture_.x.edges.front(), picture_.x.edges.back(), false, room_.width);
  }
  Axis y_axis() const {
    return make_axis(picture_.y.label, picture_.y.unit, picture_.y.edges.front(), picture_.y.edges.back(), false, room_.height);
  }
  Axis bar_axis() {
    Axis axis = make_axis(picture_.value.label, picture_.value.unit, colors_.low, colors_.high, false, std::max(room_.height, 100.0));
    if (colors_.named) {
      room_.right = std::ceil(kBarGap + kBarWidth + 6 + widest(picture_.names, kTextFont) + 9);
      return axis;
    }
    room_.right = std::ceil(kBarGap + kBarWidth + 6 + widest(axis.ticks.label, kTextFont) + 6 + 10 + 9);
    return axis;
  }

  Frame::Words words() const {
    Frame::Words words{picture_.title, picture_.subtitle, {}};
    if (!picture_.note.empty()) words.notes.push_back(picture_.note);
    if (!colors_.any) words.notes.emplace_back("No cell has data.");
    const DisplayUnit unit = display_unit(picture_.value.unit, std::max(std::abs(colors_.low), std::abs(colors_.high)));
    const auto shown = [&](double value) { return significant_text(value * unit.factor, 3) + (unit.text.empty() ? "" : " " + unit.text); };
    if (colors_.any && colors_.beyond_high())
      words.notes.push_back("Single cells lie above the colour bar, up to " + shown(colors_.largest) + ".");
    if (colors_.any && colors_.beyond_low())
      words.notes.push_back("Single cells lie below the colour bar, down to " + shown(colors_.smallest) + ".");
    if (has_blank()) words.notes.push_back("Hatched: " + picture_.blank + ".");
    if (!same_scale() && picture_.x.unit == picture_.y.unit) words.notes.emplace_back("The axes are not to the same scale.");
    return words;
  }

  bool has_blank() const {
    for (std::size_t i = 0; i < picture_.value.values.size(); ++i) {
      if (is_blank(picture_.value.values[i]) && (picture_.mill.radius == 0 || is_inside(i))) return true;
    }
    return false;
  }

  /// Whether the middle of a cell is in the mill.
  bool is_inside(std::size_t cell) const {
    const std::size_t nx = picture_.x.edges.size() - 1, ix = cell % nx, iy = cell / nx;
    const double x = std::midpoint(picture_.x.edges[ix], picture_.x.edges[ix + 1]) - picture_.mill.centre[0];
    const double y = std::midpoint(picture_.y.edges[iy], picture_.y.edges[iy + 1]) - picture_.mill.centre[1];
    return std::hypot(x, y) < picture_.mill.radius;
  }

  Point shell_centre() const { return frame_.at(picture_.mill.centre[0], picture_.mill.centre[1]); }
  double paper(double length) const { return length * frame_.plot().width / x_span(); }

  void draw(Canvas& canvas) const {
    frame_.draw_words(canvas);
    canvas.within(frame_.plot(), [&] {
      draw_blank(canvas);
      canvas.image(pixels(), frame_.plot());
      draw_framed(canvas);
      draw_outlines(canvas);
      draw_mill(canvas);
    });
    frame_.draw_axes(canvas);
    draw_marks(canvas);
    if (colors_.named) {
      draw_key(canvas);
    } else if (colors_.any) {
      draw_bar(canvas);
    }
  }

  void draw_blank(Canvas& canvas) const {
    const auto hatch = [&] { canvas.hatch(frame_.plot(), {kHatch, 0.5}, 5); };
    if (picture_.mill.radius > 0) {
      canvas.within(shell_centre(), paper(picture_.mill.radius), hatch);
    } else {
      hatch();
    }
  }

  // As many pixels as the PNG has, so that cells of any widths keep sharp edges there.
  Pixels pixels() const {
    Pixels image{static_cast<int>(frame_.plot().width) * kPixelsPerPoint, static_cast<int>(frame_.plot().height) * kPixelsPerPoint, {}};
    image.color.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    const std::size_t nx = picture_.x.edges.size() - 1;
    for (int row = 0; row < image.height; ++row) {
      const std::size_t iy = cell_of(picture_.y.edges, picture_.y.edges.back() - (row + 0.5) / image.height * y_span());
      for (int column = 0; column < image.width; ++column) {
        const std::size_t ix = cell_of(picture_.x.edges, picture_.x.edges.front() + (column + 0.5) / image.width * x_span());
        const double value = picture_.value.values[iy * nx + ix];
        image.color.push_back(is_blank(value) ? Color{0, 0, 0, 0} : colors_(value));
      }
    }
    return image;
  }

  void draw_framed(Canvas& canvas) const {
    if (picture_.framed.empty()) return;
    const auto nx = static_cast<std::ptrdiff_t>(picture_.x.edges.size()) - 1, ny = static_cast<std::ptrdiff_t>(picture_.y.edges.size()) - 1;
    const auto framed = [&](std::ptrdiff_t ix, std::ptrdiff_t iy) {
      return ix >= 0 && iy >= 0 && ix < nx && iy < ny && picture_.framed[iy * nx + ix] != 0;
    };
    const Pen pen{{0, 0, 0, 1}, 0.9};
    const auto corner = [&](std::ptrdiff_t ix, std::ptrdiff_t iy) { return frame_.at(picture_.x.edges[ix], picture_.y.edges[iy]); };
    for (std::ptrdiff_t iy = 0; iy <= ny; ++iy) {
      for (std::ptrdiff_t ix = 0; ix <= nx; ++ix) {
        if (framed(ix, iy) != framed(ix - 1, iy)) canvas.line(corner(ix, iy), corner(ix, iy + 1), pen);
        if (framed(ix, iy) != framed(ix, iy - 1)) canvas.line(corner(ix, iy), corner(ix + 1, iy), pen);
      }
    }
  }

  void draw_outlines(Canvas& canvas) const {
    for (const Outline& outline : picture_.outlines) {
      std::vector<Point> line;
      for (const auto& corner : outline) line.push_back(frame_.at(corner[0], corner[1]));
      canvas.polyline(line, {kInk, 1.3, {4, 2.5}});
    }
  }

  void draw_mill(Canvas& canvas) const {
    if (picture_.mill.radius <= 0) return;
    for (const auto& l : picture_.mill.section) canvas.line(frame_.at(l[0], l[1]), frame_.at(l[2], l[3]), {kInk, 0.7});
    canvas.circle(shell_centre(), paper(picture_.mill.radius), {kInk, 1.1});
    if (picture_.mill.omega != 0) draw_turning(canvas);
  }

  // In the free upper right corner, outside the shell: an arc with a head, and the speed.
  void draw_turning(Canvas& canvas) const {
    constexpr double from = 30 * std::numbers::pi / 180, to = 54 * std::numbers::pi / 180;
    const Point centre = shell_centre();
    const double radius = 1.10 * paper(picture_.mill.radius), sense = picture_.mill.omega > 0 ? 1 : -1;
    const auto on_arc = [&](double angle, double r) { return Point{centre.x + r * std::cos(angle), centre.y - r * std::sin(angle)}; };
    const double tip = sense > 0 ? to : from, head = 8 / radius;
    std::vector<Point> arc;
    for (int i = 0; i <= 24; ++i) arc.push_back(on_arc((sense > 0 ? from : to) + sense * (to - from - head / 2) * i / 24, radius));
    canvas.polyline(arc, {kInk, 1.4});
    canvas.fill(std::array{on_arc(tip, radius), on_arc(tip - sense * head, radius + 3.2), on_arc(tip - sense * head, radius - 3.2)}, kInk);
    const double rpm = std::abs(picture_.mill.omega) * 30 / std::numbers::pi;
    canvas.text({frame_.plot().right() - 4, frame_.plot().top + 10}, significant_text(rpm, 3) + " rpm", kSmallFont, Align::end);
  }

  void draw_marks(Canvas& canvas) const {
    for (const Mark& mark : picture_.marks) {
      const Point at = frame_.at(mark.x, mark.y);
      canvas.dot(at, 3.6, {1, 1, 1, 1});
      canvas.dot(at, 2.4, kInk);
      const bool at_right = at.x < frame_.plot().left + 0.6 * frame_.plot().width;
      const double width = text_width(mark.label, kSmallFont), left = at_right ? at.x + 6 : at.x - 6 - width;
      const double base = std::clamp(at.y + 2, frame_.plot().top + 9, frame_.plot().bottom() - 4);
      canvas.fill_rectangle({left - 1.5, base - 8.5, width + 3, 10}, {1, 1, 1, 0.8});
      canvas.text({left, base}, mark.label, {kSmallFont.size, false, kInk});
    }
  }

  void draw_key(Canvas& canvas) const {
    const double left = frame_.plot().right() + kBarGap;
    for (std::size_t n = 1; n < picture_.names.size(); ++n) {
      const Box swatch{left, frame_.plot().top + 16 * static_cast<double>(n - 1), kBarWidth, 10};
      canvas.fill_rectangle(swatch, colors_(static_cast<double>(n)));
      canvas.rectangle(swatch, {kInk, 0.6});
      canvas.text({swatch.right() + 6, swatch.bottom() - 2}, picture_.names[n], kTextFont);
    }
  }

  void draw_bar(Canvas& canvas) const {
    const double height = std::max(frame_.plot().height, 100.0) - 2 * kTip;
    const Box bar{frame_.plot().right() + kBarGap, frame_.plot().top + kTip, kBarWidth, height};
    Pixels shades{1, 256, {}};
    for (int i = 0; i < 256; ++i) shades.color.push_back(colors_(colors_.high - (i + 0.5) / 256 * (colors_.high - colors_.low)));
    canvas.image(shades, bar);
    std::vector<Point> outline{{bar.left, bar.top}};
    const double middle = bar.left + bar.width / 2;
    if (colors_.beyond_high()) outline.push_back({middle, bar.top - kTip});
    outline.insert(outline.end(), {{bar.right(), bar.top}, {bar.right(), bar.bottom()}});
    if (colors_.beyond_low()) outline.push_back({middle, bar.bottom() + kTip});
    outline.push_back({bar.left, bar.bottom()});
    if (colors_.beyond_high())
      canvas.fill(std::array{Point{bar.left, bar.top}, Point{middle, bar.top - kTip}, Point{bar.right(), bar.top}}, colors_(colors_.high));
    if (colors_.beyond_low())
      canvas.fill(std::array{Point{bar.left, bar.bottom()}, Point{middle, bar.bottom() + kTip}, Point{bar.right(), bar.bottom()}},
                  colors_(colors_.low));
    canvas.polyline(outline, {kInk, 0.7}, true);
    for (std::size_t i = 0; i < bar_.ticks.major.size(); ++i) {
      const double y = bar.bottom() - bar_.place(bar_.ticks.major[i] / bar_.factor) * bar.height;
      canvas.line({bar.right(), y}, {bar.right() + 3, y}, {kInk, 0.7});
      canvas.text({bar.right() + 6, y + 3}, bar_.ticks.label[i], kTextFont);
    }
    const double x = bar.right() + 6 + widest(bar_.ticks.label, kTextFont) + 13;
    canvas.text({x, bar.top + bar.height / 2}, bar_.label, kTextFont, Align::middle, true);
  }

  const MapPicture& picture_;
  MapColors colors_;
  Frame::Room room_;
  Axis bar_;
  Frame frame_;
};

}  // namespace

void draw_map(const MapPicture& picture, const std::filesystem::path& stem) {
  check(picture);
  write_sheet(MapDrawing(picture).sheet(), stem);
}

}  // namespace millscope::picture
