// How far a run is: one line that is rewritten on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <string>

#include "kernel/output/terminal.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::run {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Progress {
 public:
  Progress(const Assembly& a, bool quiet, bool terminal);
  /// `first_step`: where this session began, for speed and the time left.
  void update(std::int64_t step, std::int64_t first_step);
  void finish(const std::string& message);

 private:
  std::string text(std::int64_t step, std::int64_t first_step) const;

  const Assembly& a_;
  bool quiet_, terminal_;
  output::TerminalLine line_;
  std::chrono::steady_clock::time_point start_;
  double next_ = 0;
};

}  // namespace millscope::run
