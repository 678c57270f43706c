// Random numbers of this room: the kernel's generator, and normal deviates from it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "kernel/run/random.hpp"

namespace millscope::emulate {

class Random : public run::Random {
 public:
  /// Streams of one seed do not overlap in practice: the seed is hashed with the stream's number.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : run::Random(run::Random(seed).next() ^ run::Random(~stream).next()) {}

  /// Standard normal (Box & Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  Eigen::VectorXd normals(Eigen::Index n) {
    return Eigen::VectorXd::NullaryExpr(n, [this] { return normal(); });
  }
  Eigen::VectorXd uniforms(Eigen::Index n, double low, double high) {
    return Eigen::VectorXd::NullaryExpr(n, [&] { return low + (high - low) * uniform(); });
  }
};

}  // namespace millscope::emulate
