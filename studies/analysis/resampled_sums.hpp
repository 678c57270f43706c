// Sums of resampled blocks of one analyzer: of each draw, and of all blocks but one. For the files of this room.
//
// Most cells of a map are never visited: only columns that some block fills are added up, several draws and columns at a time. Each sum is
// added in the order of the blocks, so that its bits do not depend on this.
#pragma once

#include <cstdint>
#include <vector>

#include "studies/analysis/sums.hpp"

namespace millscope::analysis {

class ResampledSums {
 public:
  static constexpr std::size_t kGroup = 8;  ///< items that are summed together

  /// `counts` as of `draw_counts`. Items: the draws, then each block left out.
  ResampledSums(const std::vector<Row>& blocks, const SumLayout::Part& part, const std::vector<std::uint32_t>& counts, std::size_t draws);

  std::size_t group_count() const { return (draws_ + blocks_ + kGroup - 1) / kGroup; }
  /// Sums of the items kGroup·group … into `sums`, [kGroup, size of the part], whose other places stay as they are: 0.
  void fill(std::size_t group, double* sums) const;

 private:
  static constexpr std::size_t kWidth = 8;  ///< columns that are summed at once

  void draw_two(std::size_t first, double* sums) const;
  void leave_out(std::size_t block, double* sums) const;

  std::size_t blocks_, draws_, size_;
  std::size_t together_;              ///< neighbouring blocks whose sum is kept: leaving out one block then costs 2 √blocks additions
  std::vector<std::size_t> columns_;  ///< places in the part
  std::vector<double> values_;        ///< [columns/kWidth, blocks, kWidth]: what is summed at once lies together
  std::vector<double> parts_;         ///< [columns/kWidth, blocks/together, kWidth]
  std::vector<double> counts_;        ///< [draws, blocks]
};

}  // namespace millscope::analysis
