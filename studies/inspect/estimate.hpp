// A figure read from a recording: with its interval, or with the reason why the recording cannot say.
#pragma once

#include <optional>
#include <string>

#include "kernel/base/statistics.hpp"

namespace millscope::studies {

/// A value and its 90 % interval, in the unit that the holder states.
struct Estimate {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Of which the interval would be if it were normal.
inline double standard_error(const Estimate& e) { return (e.high - e.low) / (2 * base::kNormal90); }

/// How a bound is to be read.
enum class Bound {
  both,      ///< the interval holds on both sides
  at_least,  ///< the true value may lie anywhere above `low`; `high` is infinite
};

/// Either an estimate with what it rests on, or none and why not.
struct Finding {
  std::optional<Estimate> estimate;
  std::string note;
  Bound bound = Bound::both;
};

}  // namespace millscope::studies
