// How far a campaign is: one line that is rewritten on a terminal, plain lines now and then elsewhere.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/output/terminal.hpp"

namespace millscope::campaign {

/// A simulation under way, for the estimate of the time that is left.
struct Underway {
  double work = 0;      ///< as Identity::work
  double elapsed = 0;   ///< s, in this session
  double fraction = 0;  ///< of the simulated time that is done; 0: not known
};

class ProgressLine {
 public:
  ProgressLine(bool quiet, std::size_t total);

  /// A simulation has ended. `wall`: its cost in s, 0 when it tells nothing.
  void count(bool done, bool cached, double work, double wall);
  /// True when a new line is due: what `update` wants need not be gathered before.
  bool due() const;
  /// `waiting`: work of those that have not begun; `slots`: how many run at once.
  void update(const std::vector<Underway>& underway, double waiting, int slots);
  void clear() { line_.clear(); }
  /// "12 of 26 done, 3 of them from the cache, 1 failed".
  std::string counts() const;
  /// s, or nothing while no simulation has told what work costs.
  std::optional<double> time_left(const std::vector<Underway>& underway, double waiting, int slots) const;

 private:
  double elapsed() const;
  bool quiet_, terminal_;
  output::TerminalLine line_;
  std::size_t total_, done_ = 0, cached_ = 0, failed_ = 0;
  double known_work_ = 0, known_wall_ = 0;
  double next_ = 0, interval_ = 5;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The simulated time that the last row of a run's series.csv tells, s; 0 when there is none yet.
double simulated_time(const std::filesystem::path& run);

}  // namespace millscope::campaign
