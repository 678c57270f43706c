// What commands show while they work: one line of stderr that is rewritten, and how much time is left.
#pragma once

#include <string>

namespace millscope::output {

/// "4:05" or "1:02:03", to the second.
std::string duration_text(double seconds);

/// A line of stderr, which must be a terminal, that is drawn over again and again. It is cleared in the end, so that an error's own line
/// stands alone.
class TerminalLine {
 public:
  TerminalLine() = default;
  ~TerminalLine() { clear(); }
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  /// Shows `text` in the place of what was drawn before, cut to the terminal's width.
  void draw(const std::string& text);
  /// Leaves the line empty; nothing when nothing is drawn.
  void clear();

 private:
  bool drawn_ = false;
};

}  // namespace millscope::output
