// Curves with bands, several sources over each other.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/base/error.hpp"
#include "studies/picture/frame.hpp"
#include "studies/picture/picture.hpp"

namespace millscope::picture {
namespace {

constexpr double kWidth = 360, kHeight = 230;  // of the plot, points
constexpr double kLegendLine = 13, kSample = 22;
constexpr double kDecades = 3;  // positive values that span more are drawn on a logarithmic axis

/// Middles of bins where `x` holds edges.
std::vector<double> places(const Curve& curve, bool logarithmic) {
  if (curve.x.size() == curve.value.size()) return curve.x;
  std::vector<double> middle;
  for (std::size_t i = 0; i + 1 < curve.x.size(); ++i) {
    const double a = curve.x[i], b = curve.x[i + 1];
    middle.push_back(logarithmic ? std::sqrt(a * b) : std::midpoint(a, b));
  }
  return middle;
}

/// Positive and growing by one factor, at least thirtyfold altogether.
bool is_geometric(const std::vector<double>& x) {
  if (x.size() < 4 || !(x.front() > 0) || x.back() / x.front() < 30) return false;
  const double factor = std::pow(x.back() / x.front(), 1 / static_cast<double>(x.size() - 1));
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (std::abs(x[i + 1] / x[i] / factor - 1) > 0.02) return false;
  }
  return true;
}

void check(const CurvePicture& picture) {
  if (picture.curves.empty()) throw base::UserError("picture '" + picture.title + "': no curve");
  for (const Curve& curve : picture.curves) {
    const std::size_t n = curve.value.size();
    const bool band = curve.low.size() == curve.high.size() && (curve.low.empty() || curve.low.size() == n);
    if (n == 0 || (curve.x.size() != n && curve.x.size() != n + 1) || !band) {
      throw base::UserError(
          fmt::format("picture '{}': {} values on an axis of {}; check the axes of this result", picture.title, n, curve.x.size()));
    }
  }
}

/// Smallest and largest of what is drawn.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value), high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

class CurveDrawing {
 public:
  explicit CurveDrawing(const CurvePicture& picture)
      : picture_(picture),
        log_x_(std::all_of(picture.curves.begin(), picture.curves.end(), [](const Curve& c) { return is_geometric(c.x); })),
        y_(value_axis()),
        frame_(words(), x_axis(), y_, {kWidth, kHeight, 14, kLegendLine * legend_rows()}) {}

  Sheet sheet() {
    return {frame_.width(), frame_.height(), picture_.title, picture_.subtitle, [this](Canvas& canvas) { draw(canvas); }};
  }

 private:
  Axis x_axis() const {
    Range range;
    for (const Curve& curve : picture_.curves) add_defined(curve, range);
    if (picture_.points && !range.empty()) range = {range.low - 0.6, range.high + 0.6};
    if (range.empty() || range.low == range.high) range = {range.empty() ? 0 : range.low - 0.5, range.empty() ? 1 : range.low + 0.5};
    Axis axis = make_axis(picture_.x_label, picture_.x_unit, range.low, range.high, log_x_, kWidth);
    if (picture_.points && range.high - range.low < 40) {  // whole numbers only
      axis.ticks = {};
      const int step = range.high - range.low < 20 ? 1 : 5;
      for (int n = static_cast<int>(std::ceil(range.low)); n <= range.high; n += step) {
        axis.ticks.major.push_back(n);
        axis.ticks.label.push_back(fmt::format("{}", n));
      }
    }
    return axis;
  }

  // From the first to the last value that is defined; of a spectrum, that is not zero.
  void add_defined(const Curve& curve, Range& range) const {
    const std::size_t last = curve.x.size() - curve.value.size();  // edges: the upper one counts, too
    for (std::size_t i = 0; i < curve.value.size(); ++i) {
      if (!std::isfinite(curve.value[i]) || (log_x_ && curve.value[i] == 0)) continue;
      range.add(curve.x[i]);
      range.add(curve.x[i + last]);
    }
  }

  // The values decide; bands may widen the axis threefold, what lies beyond is cut and counted.
  Axis value_axis() {
    Range values, bands;
    double least = std::numeric_limits<double>::infinity();
    for (const Curve& curve : picture_.curves) {
      for (const double v : curve.value) {
        values.add(v);
        if (v > 0) least = std::min(least, v);
      }
      for (const double v : curve.low) bands.add(v);
      for (const double v : curve.high) bands.add(v);
    }
    if (values.empty()) values = {0, 1};
    const bool logarithmic = log_x_ && !picture_.zero_line && values.low >= 0 && values.high > std::pow(10, kDecades) * least;
    if (logarithmic) {
      return make_axis(picture_.value_label, picture_.value_unit, least / 1.5,
                       std::min(std::max(bands.high, values.high), 10 * values.high) * 1.3, true, kHeight);
    }
    if (picture_.zero_line || (values.low > 0 && values.low < 0.5 * values.high)) values.add(0);
    const double span = values.high > values.low ? values.high - values.low : std::max(std::abs(values.high), 1e-12);
    const bool from_zero = values.low == 0 && !(bands.low < 0) && !picture_.zero_line;
    double low = std::min(values.low, std::max(bands.low, values.low - span)),
           high = std::max(values.high, std::min(bands.high, values.high + span));
    low = from_zero ? 0 : low - 0.05 * span;
    return make_axis(picture_.value_label, picture_.value_unit, low, high + 0.05 * span, false, kHeight);
  }

  double legend_rows() const {
    if (picture_.curves.size() == 1) return 0;  // the line below the title says what it is
    double rows = 1, x = 0;
    for (const Curve& curve : picture_.curves) {
      const double width = entry_width(curve);
      if (x > 0 && x + width > kWidth) rows += 1, x = 0;
      x += width;
    }
    return rows;
  }

  static double entry_width(const Curve& curve) { return kSample + 5 + text_width(curve.label, kTextFont) + 16; }

  Frame::Words words() const {
    Frame::Words words{picture_.title, picture_.subtitle, {}};
    if (!picture_.note.empty()) words.notes.push_back(picture_.note);
    const bool band = std::any_of(picture_.curves.begin(), picture_.curves.end(), [](const Curve& c) { return !c.low.empty(); });
    if (band) words.notes.push_back((picture_.points ? "Whiskers: " : "Shaded: ") + picture_.band + ".");
    std::size_t cut = 0, unplaced = 0;
    for (const Curve& curve : picture_.curves) {
      for (std::size_t i = 0; i < curve.value.size(); ++i) {
        const bool placed = std::isfinite(y_.place(curve.value[i]));
        unplaced += std::isfinite(curve.value[i]) && !placed ? 1 : 0;
        if (placed && !curve.low.empty()) cut += y_.place(curve.high[i]) > 1 || (!y_.logarithmic && y_.place(curve.low[i]) < 0) ? 1 : 0;
      }
    }
    if (cut > 0) words.notes.push_back(fmt::format("The band runs out of the picture at {} point{}.", cut, cut == 1 ? "" : "s"));
    if (unplaced > 0)
      words.notes.push_back(fmt::format("{} value{} of zero ha{} no place on the logarithmic axis.", unplaced, unplaced == 1 ? "" : "s",
                                        unplaced == 1 ? "s" : "ve"));
    return words;
  }

  static Pen pen(std::size_t index) {
    static const std::vector<std::vector<double>> dashes{{}, {6, 2.5}, {1.5, 2}, {7, 2, 1.5, 2}};
    return {distinct_color(index), 1.5, dashes[index % dashes.size()]};
  }

  void draw(Canvas& canvas) const {
    frame_.draw_words(canvas);
    frame_.draw_grid(canvas);
    canvas.within(frame_.plot(), [&] {
      for (std::size_t i = 0; i < picture_.curves.size() && !picture_.points; ++i) draw_band(canvas, i);
      if (picture_.zero_line)
        canvas.line(frame_.at(frame_.x().low / frame_.x().factor, 0), frame_.at(frame_.x().high / frame_.x().factor, 0), {kInk, 0.9});
      for (std::size_t i = 0; i < picture_.curves.size(); ++i) {
        if (picture_.points) {
          draw_points(canvas, i);
        } else {
          draw_curve(canvas, i);
        }
      }
    });
    frame_.draw_axes(canvas);
    draw_legend(canvas);
  }

  void draw_band(Canvas& canvas, std::size_t index) const {
    const Curve& curve = picture_.curves[index];
    if (curve.low.empty()) return;
    const std::vector<double> x = places(curve, log_x_);
    Color color = distinct_color(index);
    color.alpha = 0.2;
    std::vector<Point> upper, lower;
    const auto finish = [&] {
      upper.insert(upper.end(), lower.rbegin(), lower.rend());
      if (upper.size() > 2) canvas.fill(upper, color);
      upper.clear(), lower.clear();
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Point high = frame_.at(x[i], curve.high[i]);
      Point low = frame_.at(x[i], curve.low[i]);
      if (std::isfinite(curve.low[i]) && !std::isfinite(low.y)) low = {high.x, frame_.plot().bottom()};  // zero on a logarithmic axis
      if (!std::isfinite(high.y) || !std::isfinite(low.y)) {
        finish();
        continue;
      }
      upper.push_back(high), lower.push_back(low);
    }
    finish();
  }

  void draw_curve(Canvas& canvas, std::size_t index) const {
    const Curve& curve = picture_.curves[index];
    const std::vector<double> x = places(curve, log_x_);
    std::vector<Point> line;
    const auto finish = [&] {
      if (line.size() > 1) canvas.polyline(line, pen(index));
      if (line.size() == 1) canvas.dot(line[0], 1.6, distinct_color(index));  // alone between gaps
      line.clear();
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Point at = frame_.at(x[i], curve.value[i]);
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) {
        finish();
        continue;
      }
      line.push_back(at);
    }
    finish();
  }

  // Sources side by side, so that whiskers do not cover each other.
  void draw_points(Canvas& canvas, std::size_t index) const {
    const Curve& curve = picture_.curves[index];
    const double aside = 5 * (static_cast<double>(index) - 0.5 * static_cast<double>(picture_.curves.size() - 1));
    for (std::size_t i = 0; i < curve.value.size(); ++i) {
      Point at = frame_.at(curve.x[i], curve.value[i]);
      if (!std::isfinite(at.y)) continue;
      at.x += aside;
      if (!curve.low.empty() && std::isfinite(curve.low[i]) && std::isfinite(curve.high[i])) {
        canvas.line({at.x, frame_.at(curve.x[i], curve.low[i]).y}, {at.x, frame_.at(curve.x[i], curve.high[i]).y},
                    {distinct_color(index), 1.2});
      }
      canvas.dot(at, 2.4, distinct_color(index));
    }
  }

  void draw_legend(Canvas& canvas) const {
    if (picture_.curves.size() == 1) return;
    double x = 0, y = frame_.legend_top() + 9;
    for (std::size_t i = 0; i < picture_.curves.size(); ++i) {
      const double width = entry_width(picture_.curves[i]);
      if (x > 0 && x + width > kWidth) x = 0, y += kLegendLine;
      const double left = frame_.plot().left + x;
      if (picture_.points) {
        canvas.dot({left + kSample / 2, y - 3}, 2.4, distinct_color(i));
      } else {
        canvas.line({left, y - 3}, {left + kSample, y - 3}, pen(i));
      }
      canvas.text({left + kSample + 5, y}, picture_.curves[i].label, kTextFont);
      x += width;
    }
  }

  const CurvePicture& picture_;
  bool log_x_;
  Axis y_;
  Frame frame_;
};

}  // namespace

void draw_curves(const CurvePicture& picture, const std::filesystem::path& stem) {
  check(picture);
  write_sheet(CurveDrawing(picture).sheet(), stem);
}

}  // namespace millscope::picture
