#include "studies/analysis/resampled_sums.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace millscope::analysis {
namespace {

std::size_t divided_up(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

}  // namespace

ResampledSums::ResampledSums(const std::vector<Row>& blocks, const SumLayout::Part& part, const std::vector<std::uint32_t>& counts,
                             std::size_t draws)
    : blocks_(blocks.size()),
      draws_(draws),
      size_(part.size),
      together_(std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(blocks.size())))))),
      counts_(counts.begin(), counts.end()) {
  for (std::size_t i = 0; i < part.size; ++i) {
    if (std::any_of(blocks.begin(), blocks.end(), [&](const Row& row) { return row[part.begin + i] != 0; })) columns_.push_back(i);
  }
  const std::size_t strips = divided_up(columns_.size(), kWidth), parts = divided_up(blocks_, together_);
  values_.assign(strips * blocks_ * kWidth, 0.0);
  parts_.assign(strips * parts * kWidth, 0.0);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    for (std::size_t b = 0; b < blocks_; ++b) {
      const double value = blocks[b][part.begin + columns_[c]];
      values_[(c / kWidth * blocks_ + b) * kWidth + c % kWidth] = value;
      parts_[(c / kWidth * parts + b / together_) * kWidth + c % kWidth] += value;
    }
  }
}

/// A block that was not drawn adds 0 times its sums, which changes no bit of what is finite.
void ResampledSums::draw_two(std::size_t first, double* sums) const {
  using Columns = Eigen::Array<double, kWidth, 1>;
  const bool both = first + 1 < draws_;
  const double *one = counts_.data() + first * blocks_, *other = both ? one + blocks_ : one;
  for (std::size_t c = 0; c < columns_.size(); c += kWidth) {
    const double* strip = values_.data() + c * blocks_;
    Columns a = Columns::Zero(), b = Columns::Zero();
    for (std::size_t k = 0; k < blocks_; ++k) {
      const Columns values = Eigen::Map<const Columns>(strip + k * kWidth);
      a += one[k] * values;
      b += other[k] * values;
    }
    for (std::size_t i = 0; i < std::min(kWidth, columns_.size() - c); ++i) {
      sums[columns_[c + i]] = a[static_cast<Eigen::Index>(i)];
      if (both) sums[size_ + columns_[c + i]] = b[static_cast<Eigen::Index>(i)];
    }
  }
}

/// A cell that only this block visited comes out as exactly 0, as it would not if the block were subtracted from the whole.
void ResampledSums::leave_out(std::size_t block, double* sums) const {
  using Columns = Eigen::Array<double, kWidth, 1>;
  const std::size_t own = block / together_, begin = own * together_, end = std::min(blocks_, begin + together_);
  const std::size_t parts = divided_up(blocks_, together_);
  for (std::size_t c = 0; c < columns_.size(); c += kWidth) {
    const double *strip = values_.data() + c * blocks_, *of_parts = parts_.data() + c * parts;
    Columns sum = Columns::Zero();
    for (std::size_t g = 0; g < parts; ++g) {
      if (g != own) sum += Eigen::Map<const Columns>(of_parts + g * kWidth);
    }
    for (std::size_t b = begin; b < end; ++b) {
      if (b != block) sum += Eigen::Map<const Columns>(strip + b * kWidth);
    }
    for (std::size_t i = 0; i < std::min(kWidth, columns_.size() - c); ++i) sums[columns_[c + i]] = sum[static_cast<Eigen::Index>(i)];
  }
}

void ResampledSums::fill(std::size_t group, double* sums) const {
  const std::size_t first = group * kGroup, last = std::min(first + kGroup, draws_ + blocks_);
  for (std::size_t item = first; item < std::min(last, draws_); item += 2) draw_two(item, sums + (item - first) * size_);
  for (std::size_t item = std::max(first, draws_); item < last; ++item) leave_out(item - draws_, sums + (item - first) * size_);
}

}  // namespace millscope::analysis
