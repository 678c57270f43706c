// A figure read from a recording: with its interval, or with the reason why the recording cannot say.
#pragma once

#include <optional>
#include <string>

#include "kernel/base/statistics.hpp"

namespace millscope::inspect {

/// How a bound is to be read.
enum class Bound {
  both,      ///< the interval holds on both sides
  at_least,  ///< the true value may lie anywhere above `low`; `high` is infinite
};

/// Either an estimate with what it rests on, or none and why not.
struct Finding {
  std::optional<base::Interval90> estimate;
  std::string note;
  Bound bound = Bound::both;
};

}  // namespace millscope::inspect
