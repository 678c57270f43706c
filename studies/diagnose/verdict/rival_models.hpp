// What the practice would do instead of naming physics; for the files of this room.
#pragma once

#include <optional>
#include <vector>

#include "studies/diagnose/verdict/held_out.hpp"

namespace millscope::diagnose {

class RivalModels {
 public:
  /// `surrogate`: of the fitted conditions; `held_surrogate`: of the held-out condition alone; both must outlive this.
  /// `variance`: of the recording's errors in the held-out condition.
  RivalModels(const HeldOutRequest& request, std::size_t held, const naming::Surrogate& surrogate, const naming::Surrogate& held_surrogate,
              VectorXd variance);

  /// The first fitted condition with a recorded power.
  std::optional<std::size_t> metered() const;
  /// Coded θ that matches the power of that condition.
  VectorXd power_only(std::size_t condition) const;
  /// By what a parameter of no meaning moves the base's prediction: each observable by a chance number times its error, the same number in
  /// all conditions, its size fitted together with θ; of several such parameters the one that helps the fitted conditions most.
  VectorXd placebo() const;
  /// By what the residuals of the fitted conditions move it, carried over by kriging in the speed of the mill.
  VectorXd discrepancy() const;

 private:
  /// Observable of the fitted condition that stands for number i of the held-out one: the same group, the same place in it.
  std::optional<Index> partner(Index i, std::size_t fitted) const;
  /// Where the powers of a fitted condition stand among the observables of all fitted ones.
  std::vector<Index> powers_of(std::size_t condition) const;

  const HeldOutRequest& r_;
  std::size_t held_;
  const naming::Surrogate& surrogate_;
  const naming::Surrogate& held_surrogate_;
  VectorXd variance_;
};

}  // namespace millscope::diagnose
