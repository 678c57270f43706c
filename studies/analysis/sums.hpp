// Additive sums of all analyzers: over chunks, merged into blocks, finished into values. For the files of this room.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "studies/analysis/instances.hpp"
#include "studies/analysis/results.hpp"
#include "studies/analysis/source.hpp"

namespace millscope::analysis {

using Row = std::vector<double>;

/// Where the arrays of each instance lie in a row.
struct SumLayout {
  struct Part {
    std::size_t begin = 0, size = 0;
    std::vector<std::size_t> arrays;  ///< offset of each array from `begin`
  };
  std::vector<Part> parts;
  std::size_t size = 0;

  explicit SumLayout(const std::vector<AnalyzerInstance>& instances);
};

/// Rows of sums with what they stand for: of chunks, then of blocks.
struct SumTable {
  std::vector<Row> rows;
  std::vector<ResultBlock> spans;
};

using Progress = std::function<void(const char* doing, double fraction)>;

/// Loads every chunk once. Independent of the number of threads.
SumTable sum_chunks(const FrameSource& source, const std::vector<AnalyzerInstance>& instances, const SumLayout& layout, std::size_t workers,
                    const Progress& progress);

/// Adds consecutive chunks of a stretch up to even blocks of at least `least` s; a shorter stretch is one block.
SumTable merge_blocks(SumTable&& chunks, double least);

/// What an analyzer makes of its part of a row.
std::vector<ResultArray> finish_arrays(const AnalyzerInstance& instance, const SumLayout::Part& part, const double* sums);
/// The same as plain values, one after the other, into `values`, which has room for all of `like`; NaN for results that these sums do not
/// give. Throws UserError when a shape differs.
void finish_values(const AnalyzerInstance& instance, const SumLayout::Part& part, const double* sums, const std::vector<ResultArray>& like,
                   std::span<double> values);

}  // namespace millscope::analysis
