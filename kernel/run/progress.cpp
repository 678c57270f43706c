#include "kernel/run/progress.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace millscope::run {
namespace {

std::string duration(double seconds) {
  const long s = static_cast<long>(seconds + 0.5);
  if (s >= 3600) return fmt::format("{}:{:02d}:{:02d}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02d}", s / 60, s % 60);
}

/// A line longer than the terminal would wrap, and then not be rewritten.
std::string cut_to_terminal(std::string line) {
  struct winsize size {};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && line.size() >= size.ws_col) line.resize(size.ws_col - 1U);
  return line;
}

}  // namespace

Progress::Progress(const Assembly& a, bool quiet, bool terminal)
    : a_(a), quiet_(quiet), terminal_(terminal), start_(std::chrono::steady_clock::now()) {
  if (quiet_) return;
  fmt::print(stderr, "{}: {} beads, dt {:.3g} s ({:.0f} % of Rayleigh), {} threads, stiffness factor {:g}\n", a.c.name, a.bead_count,
             a.time_step, 100 * a.time_step / a.rayleigh_time, a.system->threads(), a.c.stiffness_factor);
}

double Progress::elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

std::string Progress::line(std::int64_t step, std::int64_t first_step) const {
  const double wall = elapsed(), done = static_cast<double>(step - first_step), left = static_cast<double>(a_.end_step - step);
  const double rate = done / wall;
  const double time = static_cast<double>(step) * a_.time_step;
  return fmt::format("{} {:.3f} of {:.3f} s, {:.1f} M particle-steps/s, {:.1f} s per simulated s, ETA {}",
                     time < 0 ? "settling" : "running", time, a_.c.time.end, rate * static_cast<double>(a_.bead_count) * 1e-6,
                     1 / (rate * a_.time_step), duration(left / rate));
}

void Progress::update(std::int64_t step, std::int64_t first_step) {
  if (quiet_ || elapsed() < next_ || step <= first_step) return;
  const std::string text = line(step, first_step);
  if (terminal_) {
    fmt::print(stderr, "\r\033[K{}", cut_to_terminal(text));
    drawn_ = true;
    next_ = elapsed() + 0.5;
  } else {
    fmt::print(stderr, "{}\n", text);
    next_ = next_ == 0 ? 5 : next_ * 1.5;
  }
  std::fflush(stderr);
}

void Progress::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

void Progress::finish(const std::string& message) {
  if (quiet_) return;
  clear();
  if (!message.empty()) fmt::print(stderr, "{}\n", message);
}

}  // namespace millscope::run
