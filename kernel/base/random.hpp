// The SDK's generator in streams, and vectors of its numbers.
#pragma once

#include <Eigen/Core>

#include "millscope/random.hpp"

namespace millscope::base {

class RandomStream : public Random {
 public:
  /// Streams of one seed do not overlap in practice: the seed is hashed with the stream's number.
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0) : Random(Random(seed).bits() ^ Random(~stream).bits()) {}

  Eigen::VectorXd normals(Eigen::Index n) {
    return Eigen::VectorXd::NullaryExpr(n, [this] { return normal(); });
  }
  Eigen::VectorXd uniforms(Eigen::Index n, double low, double high) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return low + (high - low) * uniform(); });
  }
};

}  // namespace millscope::base
