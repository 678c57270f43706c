// A range that turned out too narrow: the bank reaches beyond it where a fit stands at its end.
//
// Only simulations beyond the end are added; those of the bank keep their places, for a parameter set is written in natural units.
#pragma once

#include <optional>
#include <vector>

#include "studies/diagnose/bank/bank.hpp"

namespace millscope::diagnose {

/// One end of the range of a parameter or of a nuisance that every simulation varies, or of a candidate's prior.
struct End {
  std::optional<Index> coordinate = {};  ///< of θ, below Question::case_dimensions()
  std::optional<Index> candidate = {};
  bool upper = true;

  bool operator==(const End&) const = default;
};

/// Whether a group of the bank is of plan_beyond().
inline bool is_beyond(const std::string& group) { return group.find_first_of("<>") != std::string::npos; }

/// Where it stands now, and as far as it may be moved: natural units, or strengths. Equal where the case allows no more.
double place_of(const Question& question, const End& end);
double farthest_of(const Question& question, const End& end);

/// Simulations between the two, over all else that the bank varies: a third as many as without a candidate, half as many as with one.
std::vector<BankPoint> plan_beyond(const Question& question, const End& end);

/// The question with that end moved there.
Question widened(Question question, const End& end);

}  // namespace millscope::diagnose
