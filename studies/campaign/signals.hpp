// SIGINT and SIGTERM while a campaign runs.
#pragma once

#include <csignal>

namespace millscope::campaign {

/// Takes the two signals over for its lifetime. The first one is noted; a second one kills as usual.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  bool arrived() const;

 private:
  struct sigaction interrupt_ {
  }, terminate_{};
};

}  // namespace millscope::campaign
