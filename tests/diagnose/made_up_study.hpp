// A diagnosis of a mill that answers at once: the study and its case are real, observables are a formula of a simulation's settings.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scratch.hpp"
#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {

/// The plugins of the build.
const host::Registry& registry();

/// study.yaml beside empty recordings: configs/mill10/case.yaml at 75 and 60 % (fitted) and 50 % (held out), two frictions; with further
/// `sections`.
std::filesystem::path write_study(const testing::Scratch& folder, const std::string& sections);
Question question_of(const testing::Scratch& folder, const std::string& sections);

/// What a value of the case does to the observables: `size` times its strength along a direction of each condition.
struct Physics {
  std::string path;
  double null_value = 0, far = 1;
  double size = 3;
  std::vector<std::uint64_t> direction;  ///< of each condition
  std::size_t coordinate = 0;            ///< of θ, on which the size depends …
  double growth = 0;                     ///< … for every step of its coded value above −1
  std::string beside = {};               ///< it is there with this setting alone …
  double beside_far = 1;                 ///< … as much as that has of this
};

class MadeUpMill {
 public:
  /// `truth`: settings that the recordings were made with, beside those of the conditions.
  MadeUpMill(const Question& question, std::vector<Physics> physics, const std::vector<std::string>& truth, double recording_noise = 1);

  calibrate::Machinery machinery();
  Evidence evidence() const;
  int computed() const { return static_cast<int>(cache_.size()); }            ///< simulations, each once
  double run_noise = 0.3;                                                     ///< of the bank's simulations
  std::uint64_t seed = 0;                                                     ///< of all noise
  std::optional<std::size_t> idle = {};                                       ///< a condition in which wall friction does nothing
  std::function<bool(const std::map<std::string, std::string>&)> fails = {};  ///< of a simulation's settings; empty: none

 private:
  calibrate::Observation observation(std::size_t condition, const std::string& key, double noise) const;

  std::vector<naming::Coordinate> theta_;
  std::vector<std::string> paths_;  ///< of θ
  std::vector<Physics> physics_;
  std::vector<std::string> truth_;
  double recording_noise_;
  std::size_t conditions_;
  std::map<std::string, std::map<std::string, std::string>> cache_;  ///< settings by key
};

}  // namespace millscope::diagnose
