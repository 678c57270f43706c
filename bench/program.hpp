// What the timing programs share: clocks, and how they end.
#pragma once

#include <fmt/format.h>

#include <ctime>
#include <exception>

namespace millscope::bench {

inline double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
inline double cpu_seconds() { return seconds(CLOCK_PROCESS_CPUTIME_ID); }
inline double wall_seconds() { return seconds(CLOCK_MONOTONIC); }

/// What `main` returns: that of run(count, words), or 2 with what went wrong.
template <class Run>
int run_as(const char* name, int count, char** words, const Run& run) {
  try {
    return run(count, words);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", name, e.what());
    return 2;
  }
}

}  // namespace millscope::bench
