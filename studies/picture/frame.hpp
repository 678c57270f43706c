// What maps and curves share: title and notes around a plot, axes with ticks.
#pragma once

#include <string>
#include <vector>

#include "studies/picture/canvas.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::picture {

inline constexpr Color kInk{0.13, 0.13, 0.13, 1};
inline constexpr Color kFaint{0.42, 0.42, 0.42, 1};
inline constexpr Font kTitleFont{10.5, true, kInk};
inline constexpr Font kTextFont{8.5, false, kInk};
inline constexpr Font kSmallFont{7.5, false, kFaint};

/// A plot and the words around it. The sheet grows with the words, so that none is cut off.
class Frame {
 public:
  struct Words {
    std::string title, subtitle;
    std::vector<std::string> notes;
  };
  struct Room {
    double width, height;  ///< of the plot
    double right = 12;     ///< beside it, for a colour bar
    double legend = 0;     ///< above it
  };
  Frame(const Words& words, const Axis& x, const Axis& y, const Room& room);

  const Box& plot() const { return plot_; }
  /// The top of the room for a legend.
  double legend_top() const { return legend_top_; }
  double width() const { return width_; }
  double height() const { return height_; }
  const Axis& x() const { return x_; }
  const Axis& y() const { return y_; }

  /// On paper; NaN where a logarithmic axis has no place.
  Point at(double x, double y) const { return {plot_.left + x_.place(x) * plot_.width, plot_.bottom() - y_.place(y) * plot_.height}; }

  void draw_words(Canvas& canvas) const;
  void draw_grid(Canvas& canvas) const;
  void draw_axes(Canvas& canvas) const;

 private:
  void draw_x_axis(Canvas& canvas) const;
  void draw_y_axis(Canvas& canvas) const;
  double tick_x(double shown) const { return plot_.left + x_.place(shown / x_.factor) * plot_.width; }
  double tick_y(double shown) const { return plot_.bottom() - y_.place(shown / y_.factor) * plot_.height; }
  Axis x_, y_;
  std::vector<std::string> title_, subtitle_, notes_;
  Box plot_;
  double width_ = 0, height_ = 0, legend_top_ = 0, y_label_ = 0;
};

/// Widest of some words.
double widest(const std::vector<std::string>& words, const Font& font);

}  // namespace millscope::picture
