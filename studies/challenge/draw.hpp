// Truths, drawn; for the files of this room.
#pragma once

#include <vector>

#include "kernel/base/random.hpp"
#include "studies/campaign/campaign.hpp"
#include "studies/challenge/plan.hpp"

namespace millscope::challenge {

/// One set before it is made.
struct Truth {
  Kind kind = Kind::none;
  std::string name;
  Eigen::VectorXd theta;  ///< natural units, rounded as the bank rounds
  std::vector<naming::ActiveCandidate> effects;
  std::vector<std::string> settings;  ///< of what lies outside, of a decoy
  std::filesystem::path camera;       ///< through which it is recorded
  std::uint64_t stream = 0;           ///< of the random numbers of its runs
};

/// Contact parameters evenly from the middle 70 % of their ranges, nuisances from their priors (those apart are what the challenge sets
/// them to), strengths evenly; in a drawn order, so that a set's number tells nothing.
std::vector<Truth> draw_truths(const Challenge& challenge, const diagnose::Question& question);

/// The run that a recording of one condition is made of. `label` tells nothing of the truth.
campaign::Simulation simulation_of(const Challenge& challenge, const diagnose::Question& question, const Truth& truth,
                                   std::size_t condition, const std::string& label);

/// Numbers of one condition of a truth: seed of its run, of its camera, error of its meter.
base::RandomStream random_of(const Challenge& challenge, const Truth& truth, std::size_t condition);

}  // namespace millscope::challenge
