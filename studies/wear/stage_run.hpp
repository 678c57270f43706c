// The simulations of one stage: the case with the worn liner, and what they say.
#pragma once

#include <limits>

#include "kernel/run/assembly.hpp"
#include "studies/wear/wear.hpp"
#include "studies/wear/worn_mesh.hpp"

namespace millscope::wear {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  ///< not known

/// What a stage's simulations tell.
struct Told {
  std::vector<Loss> losses;  ///< of each seed
  double power = 0, power_error = 0, shoulder = 0, toe = 0;
  std::vector<std::filesystem::path> runs;
  std::vector<std::string> doubts;
};

/// Plays the stages of one case.
class Stages {
 public:
  /// `body`: index of the geometry that wears.
  Stages(const Request& request, const host::Registry& registry, const run::Assembly& given, std::size_t body)
      : request_(request), registry_(registry), given_(given), body_(body) {}

  /// Writes OUT/stages/NUMBER and runs it. Throws UserError where a simulation fails.
  Told run(int number, const Profile& p, const Stretches& s) const;

 private:
  std::filesystem::path write_case(int number, const Profile& p, const Stretches& s) const;

  const Request& request_;
  const host::Registry& registry_;
  const run::Assembly& given_;
  std::size_t body_;
};

}  // namespace millscope::wear
