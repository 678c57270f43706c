// Where to simulate next.
#pragma once

#include <cstdint>
#include <functional>

#include "studies/emulate/emulator.hpp"

namespace millscope::emulate {

/// What is to be small, from the observables of a simulation: Eq. 4.3 of Chagas 2015, or the misfit below.
using Objective = std::function<double(const Eigen::VectorXd& observables)>;

/// r' (Σ_recording + N)⁻¹ r with N the noise of one run: the misfit that a run with these observables would have.
Objective misfit_objective(const Emulator& emulator, const Observed& observed);

/// Point of the largest expected improvement, E max(0, best − objective(f)), f drawn from the emulator at the point with the same numbers
/// at every point; best: the smallest expected objective at a run. Where no improvement is to be expected any more, the point where the
/// objective is least known among those not yet implausible.
Eigen::VectorXd next_point(const Emulator& emulator, const Box& box, const Objective& objective, std::uint64_t seed);
Eigen::VectorXd next_point(const Emulator& emulator, const Box& box, const Observed& observed, std::uint64_t seed);

/// Several at once, for several cores: each is chosen as if the ones before had said what is predicted of them (Ginsbourger et al. 2010),
/// at least a fiftieth of the ranges from them.
std::vector<Eigen::VectorXd> next_points(const Emulator& emulator, const Box& box, const Objective& objective, int count,
                                         std::uint64_t seed);

/// Expected improvement at one point, in the objective's units.
double expected_improvement(const Emulator& emulator, const Box& box, const Objective& objective, const Eigen::VectorXd& point,
                            std::uint64_t seed);

struct Optimum {
  Eigen::VectorXd point;
  double expected;   ///< objective's mean over what the emulator leaves open
  double deviation;  ///< and its standard deviation
};

/// The smallest expected objective in the box.
Optimum minimise(const Emulator& emulator, const Box& box, const Objective& objective, std::uint64_t seed);

/// √(r' (Σ + V)⁻¹ r / observables): beyond 3, no simulation there can agree with the recording (Craig et al. 1997).
double implausibility(const Emulator& emulator, const Observed& observed, const Eigen::VectorXd& point);

}  // namespace millscope::emulate
