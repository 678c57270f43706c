#include "studies/picture/frame.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::picture {
namespace {

constexpr double kEdge = 8;    // around everything
constexpr double kTick = 3.5;  // length of a tick
constexpr double kTitleLine = 13.5, kSubtitleLine = 10.5, kNoteLine = 9.5;
constexpr double kLeastPaper = 250;  // for the words

std::vector<std::string> wrap_all(const std::vector<std::string>& notes, const Font& font, double width) {
  std::vector<std::string> lines;
  for (const std::string& note : notes) {
    for (std::string& line : wrap(note, font, width)) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace

double widest(const std::vector<std::string>& words, const Font& font) {
  double width = 0;
  for (const std::string& word : words) width = std::max(width, text_width(word, font));
  return width;
}

Frame::Frame(const Words& words, const Axis& x, const Axis& y, const Room& room) : x_(x), y_(y) {
  const double labels = widest(y.ticks.label, kTextFont);
  const double left = std::ceil(kEdge + 12 + 4 + labels + kTick + 3);
  width_ = std::max(left + room.width + room.right, kLeastPaper);
  const double paper = width_ - 2 * kEdge;
  title_ = wrap(words.title, kTitleFont, paper);
  subtitle_ = wrap(words.subtitle, kSmallFont, paper);
  notes_ = wrap_all(words.notes, kSmallFont, paper);
  legend_top_ = kEdge + kTitleLine * static_cast<double>(title_.size()) + kSubtitleLine * static_cast<double>(subtitle_.size()) + 4;
  plot_ = {left, std::ceil(legend_top_ + room.legend + 4), room.width, room.height};
  y_label_ = left - kTick - 3 - labels - 7;
  height_ = std::ceil(plot_.bottom() + 34 + kNoteLine * static_cast<double>(notes_.size()) + (notes_.empty() ? 0 : 7));
}

void Frame::draw_words(Canvas& canvas) const {
  double y = kEdge;
  for (const std::string& line : title_) canvas.text({kEdge, (y += kTitleLine) - 3.5}, line, kTitleFont);
  for (const std::string& line : subtitle_) canvas.text({kEdge, (y += kSubtitleLine) - 2}, line, kSmallFont);
  y = plot_.bottom() + 34;
  for (const std::string& line : notes_) canvas.text({kEdge, y += kNoteLine}, line, kSmallFont);
}

void Frame::draw_grid(Canvas& canvas) const {
  const Pen pen{{0.88, 0.88, 0.88, 1}, 0.5};
  for (const double value : x_.ticks.major) canvas.line({tick_x(value), plot_.top}, {tick_x(value), plot_.bottom()}, pen);
  for (const double value : y_.ticks.major) canvas.line({plot_.left, tick_y(value)}, {plot_.right(), tick_y(value)}, pen);
}

void Frame::draw_axes(Canvas& canvas) const {
  canvas.rectangle(plot_, {kInk, 0.7});
  draw_x_axis(canvas);
  draw_y_axis(canvas);
}

void Frame::draw_x_axis(Canvas& canvas) const {
  const Pen pen{kInk, 0.7};
  const double bottom = plot_.bottom();
  for (const double value : x_.ticks.minor) canvas.line({tick_x(value), bottom}, {tick_x(value), bottom + kTick / 2}, pen);
  for (std::size_t i = 0; i < x_.ticks.major.size(); ++i) {
    const double x = tick_x(x_.ticks.major[i]);
    canvas.line({x, bottom}, {x, bottom + kTick}, pen);
    canvas.text({x, bottom + kTick + 9}, x_.ticks.label[i], kTextFont, Align::middle);
  }
  canvas.text({plot_.left + plot_.width / 2, bottom + kTick + 22}, x_.label, kTextFont, Align::middle);
}

void Frame::draw_y_axis(Canvas& canvas) const {
  const Pen pen{kInk, 0.7};
  for (const double value : y_.ticks.minor) canvas.line({plot_.left - kTick / 2, tick_y(value)}, {plot_.left, tick_y(value)}, pen);
  for (std::size_t i = 0; i < y_.ticks.major.size(); ++i) {
    const double y = tick_y(y_.ticks.major[i]);
    canvas.line({plot_.left - kTick, y}, {plot_.left, y}, pen);
    canvas.text({plot_.left - kTick - 3, y + 3}, y_.ticks.label[i], kTextFont, Align::end);
  }
  canvas.text({y_label_, plot_.top + plot_.height / 2}, y_.label, kTextFont, Align::middle, true);
}

}  // namespace millscope::picture
