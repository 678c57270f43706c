// How well diagnoses met the answers: nothing but counting, so that every number can be checked by hand.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
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
  bool physics = true;  ///< else a nuisance that leaves its prior

  /// λ at a strength, by its root between those of the curve.
  double lambda(double strength) const;
};

struct Gain {
  std::string condition, model;  ///< held out; against this model
  base::Interval90 improvement;
};

/// What a diagnosis says.
struct Found {
  std::string failure;  ///< why there is none; else ""
  std::string verdict;
  std::vector<std::string> named;
  std::vector<Tested> hypotheses;
  std::map<std::string, base::Interval90> retuned, unmasked;  ///< contact parameters and nuisances
  std::vector<Gain> gains;
  std::map<std::string, double> practice;  ///< parameters of the base that was retuned to power

  const Tested* find(const std::string& name) const;
  const Tested* best() const;
  bool names(const std::string& name) const;
  bool names_physics() const;
};

/// Retuned base less truth, in long runs (concealment.hpp); NaN where it cannot be told.
struct Concealment {
  double power_percent = 0, shoulder_deg = 0, toe_deg = 0;
  double chagas = 0;  ///< Eq. 4.3 of Chagas 2015: |ΔP| in W and percent of the distributions, added as cited
};

/// A set with its diagnosis; nothing: not diagnosed yet.
struct Marked {
  Answer answer;
  std::optional<Found> found;
  std::optional<Concealment> concealment = {};
  std::string study = {};  ///< hash of the study that was put to the test
};

/// Reads what `run` left of a set.
std::optional<Found> read_found(const std::filesystem::path& set);
/// Answers, held against their hashes, and diagnoses.
std::vector<Marked> read_sets(const std::filesystem::path& sets);
/// Those of several folders; each set is then called FOLDER/set_001. Throws base::UserError where two folders have one name,
/// or the same manifest.
std::vector<Marked> read_all_sets(const std::vector<std::filesystem::path>& folders);

struct PowerBin {
  double low, high;  ///< of lambda
  Count named;       ///< alone or in a class of two
};

struct Estimated {
  std::string set, hypothesis;
  double truth = 0, estimate = 0;  ///< strengths
  bool found = false;              ///< the hypothesis is among those named
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

  Count false_alarms;  ///< sets with nothing hidden for which something is said to be missing
  Count false_names;   ///< and that are given a name
  Count named_alone;   ///< one effect: the verdict is `named` and right
  Count best_right;    ///< the best candidate is the truth
  Count in_class;      ///< the truth is among those named
  Count in_class_of_two;
  double mean_class = std::numeric_limits<double>::quiet_NaN();  ///< of the sets with one effect that name something
  Count abstained_on_effect;                                     ///< outside_library, though the truth is in the list
  Count two_both, two_one;                                       ///< two effects: both, at least one named
  Count outside_abstained, outside_named, outside_missed;
  Count decoys_named, decoys_outside;  ///< decoys in which physics is named, or said to lie outside: wrong

  Count strength;                                    ///< truth in the 90 % interval
  std::vector<std::pair<std::string, Count>> theta;  ///< the same, by parameter
  std::vector<PowerBin> power;
  std::vector<Estimated> estimates;
  Line line;
  std::vector<double> at_zero;  ///< estimated strengths of hypotheses in sets that hide nothing
  std::vector<Recovery> recovery;
  std::vector<GainCount> gains;

  std::vector<std::string> truths, answers;  ///< of the confusion matrix
  std::vector<std::vector<int>> confusion;
};

Score score(const std::vector<Marked>& sets);

/// "none", "rolling_resistance", "a + b", "outside: x", "decoy: x".
std::string label_of(const Answer& answer);
/// The verdict; with its names where there are some: "named: a", "ambiguous: a, b".
std::string label_of(const Found& found);

}  // namespace millscope::challenge
