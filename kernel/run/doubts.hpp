// What a run gives cause to doubt: where a number is beyond the limit up to which it is known not to matter.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace millscope::run {

/// One doubt, as summary.json tells it.
struct Doubt {
  std::string name;        ///< "overlap", "contact_steps", "short_window", "not_steady", "lifter_gap"
  std::string of;          ///< a pair of materials, or a body; "": the whole run
  double value = 0;        ///< measured
  double limit = 0;        ///< `value` is beyond it
  std::string unit;        ///< of both
  std::string finding;     ///< what was found, with value and limit
  std::string may_change;  ///< which results, and by how much where that is known
  std::string remedy;
};
void to_json(nlohmann::ordered_json& j, const Doubt& doubt);
void from_json(const nlohmann::ordered_json& j, Doubt& doubt);

/// The deepest contact of one pair of materials since the start.
struct DeepestContact {
  std::string pair;
  bool wall = false;   ///< the second material is of a body
  double overlap = 0;  ///< against a wall δ/R; between two beads δ/(2 R*), which is δ/R for equal ones: each is flattened by half of it
};

/// The narrowest gap between neighbouring lifters.
struct LifterGap {
  std::string body;
  double width = 0;  ///< m
};

/// A difference between the window's halves.
struct Drift {
  double errors = 0;  ///< in its standard errors
  double part = 0;    ///< of the mean
};

/// What doubts are judged from.
struct Soundness {
  std::vector<DeepestContact> deepest;
  double stiffness_factor = 1;
  bool stiffness_from_young = true;     ///< as Assembly has it; else stiffness_factor may change nothing
  std::optional<double> contact_steps;  ///< time steps in the shortest contact; nothing: none was counted
  double turn = 0;                      ///< s, of the mill; 0: nothing turns
  std::optional<double> window;         ///< s, that means are taken over; nothing: it is too short for means
  bool steady = true;
  Drift drift;                      ///< of the power
  std::optional<double> imbalance;  ///< energy that the window's book cannot account for, as part of the walls' work; nothing: they do none
  std::optional<double> unaccounted;  ///< the same, as part of the larger one of the walls' work and the losses; nothing: neither is known
  double power_error = 0;             ///< standard error of the mean power, as part of it; 0: not known
  double centre_error = 0;            ///< m, standard error of the mean place of the charge's centre of mass across the axis; 0: not known
  double bead_radius = 0;             ///< m, mean by mass
  std::optional<LifterGap> gap;
};

/// Those that apply, always in the same order. What matters less than the standard errors of power and centre of mass is left out.
std::vector<Doubt> doubts_of(const Soundness& run);

/// "finding; may_change; remedy".
std::string sentence_of(const Doubt& doubt);

/// The doubts in a summary.json that was read; none where it has none, as one of before there were any.
std::vector<Doubt> doubts_in(const nlohmann::ordered_json& summary);

}  // namespace millscope::run
