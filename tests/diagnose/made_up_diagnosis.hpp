// Diagnoses end to end on a mill that is a formula.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "made_up_study.hpp"
#include "studies/diagnose/verdict/diagnosis.hpp"

namespace millscope::diagnose {

inline const std::string kSections =
    "nuisances: {fill.filling: {range: [30.4 %, 32.2 %], sigma: 0.313 %, name: filling}}\n"
    "hypotheses: {rolling_resistance: {}, capillary_bridge: {}, lifter_wear: {}}\n"
    "bank: {base: 24, each: 10}\n";
inline const std::string kRolling = "pairs.glass~glass.rolling_friction", kBridge = "pairs.glass~glass.surface_tension",
                         kHeight = "geometry.liner.lifter_height";
inline const std::vector<std::string> kTheta{"pairs.glass~glass.static_friction=0.3", "pairs.glass~liner.static_friction=0.4",
                                             "fill.filling=0.313"};

/// Three effects, each with a signature of its own in every condition.
inline std::vector<Physics> usual() {
  return {{kRolling, 0, 0.2, 3, {21, 22, 23}}, {kBridge, 0, 0.08, 3, {31, 32, 33}}, {kHeight, 0.005, 0.003, 3, {41, 42, 43}}};
}

template <class... Settings>
std::vector<std::string> with(const Settings&... more) {
  std::vector<std::string> truth = kTheta;
  (truth.push_back(more), ...);
  return truth;
}

inline naming::Options quick() {
  naming::Options o;
  o.draws = 240, o.comparison_draws = 160;
  return o;
}

inline const naming::Judged& judged(const Diagnosis& d, const std::string& name) {
  for (std::size_t j = 0; j < d.problem.alternatives.size(); ++j) {
    if (d.problem.alternatives[j].name == name) return d.naming.judged[j];
  }
  throw std::runtime_error("not judged: " + name);
}

inline Diagnosis found(const Question& q, MadeUpMill& mill) { return diagnose::diagnose(q, mill.machinery(), mill.evidence(), quick()); }

inline Diagnosis diagnosed(const std::vector<Physics>& physics, const std::vector<std::string>& truth, double recording_noise = 1,
                           std::uint64_t seed = 0) {
  const testing::Scratch folder;
  const Question q = question_of(folder, kSections);
  MadeUpMill mill(q, physics, truth, recording_noise);
  mill.seed = seed;
  return found(q, mill);
}

}  // namespace millscope::diagnose
