#include "kernel/output/terminal.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace millscope::output {
namespace {

/// A line longer than the terminal would wrap, and then not be rewritten.
std::string cut_to_terminal(std::string line) {
  struct winsize size {};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col) line.resize(size.ws_col - 1U);
  return line;
}

}  // namespace

std::string duration_text(double seconds) {
  const long s = std::lround(seconds);
  if (s >= 3600) return fmt::format("{}:{:02d}:{:02d}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02d}", s / 60, s % 60);
}

void TerminalLine::draw(const std::string& text) {
  fmt::print(stderr, "\r\033[K{}", cut_to_terminal(text));
  std::fflush(stderr);
  drawn_ = true;
}

void TerminalLine::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace millscope::output
