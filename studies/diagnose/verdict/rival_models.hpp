// What the practice would do instead of naming physics; for the files of this room.
#pragma once

#include <optional>
#include <vector>

#include "studies/diagnose/verdict/held_out.hpp"

namespace millscope::diagnose {

class RivalModels {
 public:
  RivalModels(const HeldOutRequest& request, std::size_t held);

  /// The first fitted condition with a recorded power.
  std::optional<std::size_t> metered() const;
  /// Coded θ that matches the power of that condition.
  VectorXd power_only(std::size_t condition) const;
  /// The base's prediction moved by a parameter of no meaning: each observable by a chance number times its error, the same number in all
  /// conditions, its size fitted together with θ; of several such parameters the one that helps the fitted conditions most.
  Prediction placebo(const Prediction& base) const;
  /// The base's prediction with the residuals of the fitted conditions, carried over by kriging in the speed of the mill.
  Prediction discrepancy(const Prediction& base) const;

 private:
  /// Observable of the fitted condition that stands for number i of the held-out one: the same group, the same place in it.
  std::optional<Index> partner(Index i, std::size_t fitted) const;
  /// Where the powers of a fitted condition stand among the observables of all fitted ones.
  std::vector<Index> powers_of(std::size_t condition) const;

  const HeldOutRequest& r_;
  std::size_t held_;
  naming::Surrogate surrogate_, held_surrogate_;
};

}  // namespace millscope::diagnose
