// What differs between two results of `analyze`, and what can be said of it with one error rate for everything.
//
//   const Comparison c = compare(read_results("A"), read_results("B"), {});
//   puts(c.verdict.c_str());       // "3 of 41 observables differ at 5 % family-wise; strongest: pept_grid.speed, …"
#pragma once

#include <string>
#include <vector>

#include "studies/analysis/results.hpp"
#include "studies/compare/family_test.hpp"

namespace millscope::compare {

struct CompareOptions {
  std::vector<std::string> only = {};     ///< analyzers ("pept_grid") or results ("pept_grid.speed"); empty: all
  std::vector<std::string> without = {};  ///< the same, to be left out
  double level = 0.05;                    ///< family-wise
  double confidence = 0.9;                ///< of the intervals, each for itself
};

/// One judged place: a number, a bin, a cell, or the mean over a region of cells.
struct ComparedElement {
  std::string where;      ///< empty for single numbers
  std::size_t index = 0;  ///< into the values of the result; of a region: into regions_of its map
  double a = 0, b = 0;
  TestedElement test;
};

struct ComparedObservable {
  std::size_t array_a = 0, array_b = 0;  ///< in Comparison::a and b
  std::string name, unit;                ///< "pept_grid.speed", "pept_grid.speed by region"
  bool by_region = false;                ///< the elements are means over regions of a map
  std::vector<ComparedElement> elements;
  std::size_t strongest = 0;
  double p = 1, adjusted_p = 1;
  std::size_t too_few = 0;  ///< values that rest on too few blocks to be judged
};

enum class Verdict { no_difference, differ, cannot_tell };

struct Comparison {
  analysis::ResultSet a, b;  ///< b mirrored where that was needed
  CompareOptions options;
  Verdict verdict_kind = Verdict::cannot_tell;
  std::string verdict;                          ///< one line
  std::vector<ComparedObservable> observables;  ///< the most significant first
  /// Quantities without uncertainty that differ, e.g. the critical speed; then what says how much data there are (kBookkeeping).
  std::vector<std::string> given;
  std::vector<std::string> not_judged;  ///< "name: why"
  std::vector<std::string> notes;       ///< mirrored, other speed, other options, …
};

/// B less A. Throws base::UserError where grids or units differ, or nothing can be compared.
Comparison compare(const analysis::ResultSet& a, const analysis::ResultSet& b, const CompareOptions& options);

}  // namespace millscope::compare
