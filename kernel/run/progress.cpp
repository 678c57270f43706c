#include "kernel/run/progress.hpp"

#include <fmt/core.h>

#include <cstdio>

namespace millscope::run {

Progress::Progress(const Assembly& a, bool quiet, bool terminal)
    : a_(a), quiet_(quiet), terminal_(terminal), start_(std::chrono::steady_clock::now()) {
  if (quiet_) return;
  fmt::print(stderr, "{}: {} beads, dt {:.3g} s ({:.0f} % of Rayleigh), {} threads, stiffness factor {:g}\n", a.c.name, a.bead_count,
             a.time_step, 100 * a.time_step / a.rayleigh_time, a.system->threads(), a.c.stiffness_factor);
}

std::string Progress::text(std::int64_t step, std::int64_t first_step) const {
  const double wall = seconds_since(start_), done = static_cast<double>(step - first_step), left = static_cast<double>(a_.end_step - step);
  const double rate = done / wall;
  const double time = static_cast<double>(step) * a_.time_step;
  return fmt::format("{} {:.3f} of {:.3f} s, {:.1f} M particle-steps/s, {:.1f} s per simulated s, ETA {}",
                     time < 0 ? "settling" : "running", time, a_.c.time.end, rate * static_cast<double>(a_.bead_count) * 1e-6,
                     1 / (rate * a_.time_step), output::duration_text(left / rate));
}

void Progress::update(std::int64_t step, std::int64_t first_step) {
  if (quiet_ || seconds_since(start_) < next_ || step <= first_step) return;
  const std::string now = text(step, first_step);
  if (terminal_) {
    line_.draw(now);
    next_ = seconds_since(start_) + 0.5;
  } else {
    fmt::print(stderr, "{}\n", now);
    next_ = next_ == 0 ? 5 : next_ * 1.5;
  }
}

void Progress::finish(const std::string& message) {
  if (quiet_) return;
  line_.clear();
  if (!message.empty()) fmt::print(stderr, "{}\n", message);
}

}  // namespace millscope::run
