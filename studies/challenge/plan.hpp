// challenge.yaml: which sets are made, and how the mill that makes them differs from the one that is fitted.
//
//   study: diagnose.yaml                         # its recordings need not exist: those of the sets take their place
//   camera: ../cameras/study.yaml
//   seed: 20260101
//   truth: {set: {stiffness_factor: 0.01, contact.law.cap: sum}}
//   beads: 60                                    # tracers of every condition
//   seconds: 20                                  # of each
//   held_out_seconds: 40                         # of each in a held-out condition (default: seconds)
//   sets:
//     - {kind: none, count: 5}
//     - {kind: effect, hypothesis: rolling_resistance, strength: [0.3, 1], count: 3}
//     - {kind: two, hypotheses: [rolling_resistance, lifter_wear]}
//     - {kind: outside, name: brittle_glass, set: {pairs.glass~glass.restitution: 0.3}}
//     - {kind: decoy, name: clock, camera: ../cameras/slow_clock.yaml}
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "studies/diagnose/question/question.hpp"

namespace millscope::challenge {

/// A decoy has no physics beyond the base: its camera is another one, or what the study varies lies beyond what is believed of it.
enum class Kind { none, effect, two, outside, decoy };
inline constexpr Kind kKinds[] = {Kind::none, Kind::effect, Kind::two, Kind::outside, Kind::decoy};
const char* name_of(Kind kind);

/// One line of `sets`.
struct SetsOf {
  Kind kind = Kind::none;
  std::vector<std::string> hypotheses;
  double low = 0.3, high = 1;         ///< of the share of the prior range
  std::string name;                   ///< of what lies outside the study's list, of a decoy
  std::vector<std::string> settings;  ///< that make it
  std::filesystem::path camera = {};  ///< of a decoy; empty: that of the challenge
  int count = 1;
  base::Location where;
};

struct Challenge {
  std::filesystem::path file, study, camera;
  std::uint64_t seed = 1;
  std::vector<std::string> truth;  ///< settings of all truths
  base::Location truth_where;
  int beads = 60;
  double seconds = 20, held_out_seconds = 20;
  std::vector<SetsOf> sets;
};

/// Throws base::UserError with file:line.
Challenge read_challenge(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The study without its recordings. Throws base::UserError where the sets name hypotheses that it does not have, or where
/// something is set that is drawn or that a hypothesis of the study stands for.
diagnose::Question question_of(const Challenge& challenge, const host::Registry& registry);

}  // namespace millscope::challenge
