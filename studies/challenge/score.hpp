// How well diagnoses met the answers: nothing but counting, so that every number can be checked by hand.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "studies/challenge/answer.hpp"
#include "studies/challenge/statistics.hpp"
#include "studies/diagnose/naming/naming.hpp"

namespace millscope::challenge {

/// One hypothesis of a diagnosis.
struct Tested {
  std::string name, class_of;                           ///< "best", "not rejected", …
  std::vector<std::pair<double, double>> lambda_curve;  ///< (strength, λ), strengths rising
  std::optional<base::Interval90> strength;
  bool physics = true;                                  ///< else a nuisance that leaves its prior
  bool tested = true;                                   ///< else no part of the family that shares the level
  double p = std::numeric_limits<double>::quiet_NaN();  ///< for all hypotheses together

  /// λ at a strength, by its root between those of the curve; NaN where there is none.
  double lambda(double strength) const;
  bool two_sided() const { return !lambda_curve.empty() && lambda_curve.front().first < 0; }
};

struct Gain {
  std::string condition, model;  ///< held out; against this model
  base::Interval90 improvement;
};

/// What a diagnosis says.
struct Found {
  std::string failure;  ///< why there is none; else ""
  std::string verdict;
  double level = std::numeric_limits<double>::quiet_NaN();   ///< for all hypotheses together; NaN: of before diagnosis.json told it
  double base_p = std::numeric_limits<double>::quiet_NaN();  ///< that the base looks like the recordings
  double base_q = std::numeric_limits<double>::quiet_NaN();  ///< its misfit, of each number compared
  std::vector<std::string> named;
  bool together = false;  ///< `named` are two at once, else a class of which one is true
  std::vector<Tested> hypotheses;
  std::map<std::string, base::Interval90> retuned, unmasked;  ///< contact parameters and nuisances
  std::vector<Gain> gains;
  std::optional<bool> improves;            ///< on every rival, in all held-out conditions that were simulated; nothing: none was
  std::map<std::string, double> practice;  ///< parameters of the base that was retuned to power
  std::map<std::string, double> power;     ///< %, of each model: mean |predicted less recorded| of the held-out conditions

  const Tested* find(const std::string& name) const;
  const Tested* best() const;
  bool names(const std::string& name) const;
  bool names_physics() const;
  /// Whether a name is that of physics, and of no belief.
  bool is_physics(const std::string& name) const;
  /// The smallest of all hypotheses; NaN: none was tested.
  double smallest_p() const;
  /// What one hypothesis has of the level (Bonferroni); half of it at each end where its strength may have either sign.
  double level_of(const Tested& tested) const;
};

/// A tuned base less truth, in long runs (concealment.hpp); NaN where it cannot be told.
struct Concealment {
  double power_percent = 0, shoulder_deg = 0, toe_deg = 0;
  double chagas = 0;  ///< Eq. 4.3 of Chagas 2015: |ΔP| in W and percent of the distributions, added as cited
};

/// Of the base whose friction was retuned to the power alone, and of the one that was refitted to all numbers; nothing: nobody has looked.
struct Practice {
  std::optional<Concealment> to_power = {}, to_all = {};
};
using Tuned = std::optional<Concealment> Practice::*;

/// A set with its diagnosis; nothing: not diagnosed yet.
struct Marked {
  Answer answer;
  std::optional<Found> found;
  Practice practice = {};
  std::string study = {};    ///< hash of the study that was put to the test
  std::string remark = {};   ///< of whoever looked into it
  std::string program = {};  ///< first digits of the commit that was put to the test; empty: not told

  /// Of the truth that was recorded, at its first condition; "": it has none.
  std::string setting(std::string_view key) const;
  std::string engine() const;  ///< that played the mills
  std::string peers() const;   ///< equal for sets of one study and engine with recordings of equal length and as many tracers
  std::string folder() const;  ///< of FOLDER/set_001; else ""
  /// λ at an effect's strength, by the diagnosis' surrogate; nothing where it is not known.
  std::optional<double> lambda(const TrueEffect& effect) const;
  /// The diagnosis is not what a user needs: an alarm for nothing, an effect that is not in a class of two, …
  bool missed() const;
};

inline constexpr double kFaint = 10;  ///< λ below which an ideal test finds an effect in about half of the sets, or fewer
inline constexpr const char* kRemarksFile = "remarks.txt";  ///< lines of "set_001: why"
inline constexpr const char* kFrozenFile = "frozen.json";   ///< of published sets: the commit that was put to the test

/// Reads what `run` left of a set.
std::optional<Found> read_found(const std::filesystem::path& set);
/// Answers, held against their hashes, and diagnoses.
std::vector<Marked> read_sets(const std::filesystem::path& sets);
/// Those of several folders; each set is then called FOLDER/set_001. Throws base::UserError where two folders have one name,
/// or the same manifest.
std::vector<Marked> read_all_sets(const std::vector<std::filesystem::path>& folders);

struct PowerBin {
  double low, high;  ///< of lambda
  Count named = {};  ///< alone or in a class of two
  /// Of these, the ones that practice would not suspect, by the base that was retuned to power, and by the one refitted to everything.
  Count concealed_to_power = {}, concealed_to_all = {};
  double ideal = 0;  ///< mean of ideal_power …
  int ideals = 0;    ///< … of so many sets
};

/// What a diagnosis may say, and how often it was so: all of it; what is hidden among more, or not all of it; not so.
struct Said {
  std::string what;
  int right = 0, part = 0, wrong = 0;
};

/// Mean error of the held-out power, %, of a model.
struct PowerError {
  std::string model;
  double effect = 0, empty = 0;  ///< one effect, and the best candidate is it; nothing hidden
  int effects = 0, empties = 0;  ///< sets behind each
};

struct Estimated {
  std::string set, hypothesis;
  double truth = 0, estimate = 0;  ///< strengths
  bool found = false;              ///< the hypothesis is listed
  bool faint = false;              ///< λ at the hidden strength is below kFaint
};

inline constexpr const char* kStrengthRow = "the hidden strength";

/// The 90 % intervals of one quantity, in the sets that one engine played.
struct Coverage {
  std::string of, engine;
  std::optional<double> truth = {};  ///< of all these sets, and so one trial; nothing: drawn for each set
  Count inside = {};
  double p = std::numeric_limits<double>::quiet_NaN();  ///< that 90 % gives such a count, for all that are drawn together (Holm)
};

struct GainCount {
  std::string model;
  Count surely;       ///< the 90 % interval lies above 0
  double median = 0;  ///< improvement of the misfit
};

struct Recovery {
  std::string parameter;
  int sets = 0;
  double retuned = 0, unmasked = 0;  ///< mean |estimate − truth|
};

struct Score {
  int sets = 0, diagnosed = 0, failed = 0;

  Count false_alarms;                         ///< sets with nothing hidden for which something is said to be missing
  Count false_names;                          ///< and that are given a name
  Count false_physics;                        ///< which is that of physics
  std::vector<double> empty_p, empty_base_p;  ///< of the sets with nothing hidden: smallest_p, base_p
  Count named_alone;                          ///< one effect: the verdict is `named` and right
  Count best_right;                           ///< the best candidate is the truth
  Count in_class;                             ///< the truth is listed
  Count in_class_of_two;
  double mean_class = std::numeric_limits<double>::quiet_NaN();  ///< of the sets with one effect that name something
  Count faint_nothing_else;                                      ///< faint (kFaint): no physics is named but the truth
  Count abstained_on_effect;                                     ///< outside_library, though the truth is in the list
  Count two_both, two_class, two_one;                            ///< two effects: listed together; both listed; at least one
  Count outside_abstained, outside_named, outside_missed;
  Count decoys_named, decoys_outside;  ///< decoys in which physics is named, or said to lie outside: wrong

  std::vector<Coverage> coverage;  ///< of strengths and parameters, in order of their names
  Count improves;                  ///< one effect whose candidate is best: held out, surely better than every rival
  int not_held_out = 0;            ///< the same, but without simulations of a held-out condition
  std::vector<PowerBin> power;
  std::vector<Estimated> estimates;
  Line line, line_of_clear;                         ///< through all, and without those that are faint
  std::vector<std::pair<std::string, Line>> lines;  ///< by hypothesis
  std::vector<double> at_zero;                      ///< estimated strengths of hypotheses in sets that hide nothing
  std::vector<Recovery> recovery;
  std::vector<GainCount> gains;
  std::vector<PowerError> held_out_power;
  std::vector<Said> said;
  std::vector<double> empty_base_q;  ///< of the sets with nothing hidden

  std::vector<std::string> truths, answers;  ///< of the confusion matrix
  std::vector<std::vector<int>> confusion;
};

Score score(const std::vector<Marked>& sets);

/// Sets of one mill that one engine played and one program diagnosed; groups stand in the order of their first sets.
struct Group {
  std::string engine, program, folders;
  std::vector<Marked> sets;
};
std::vector<Group> groups_of(const std::vector<Marked>& sets);

/// "none", "rolling_resistance", "a + b", "outside: x", "decoy: x".
std::string label_of(const Answer& answer);
/// The verdict; with its names where there are some: "named: a", "ambiguous: a, b".
std::string label_of(const Found& found);

}  // namespace millscope::challenge
