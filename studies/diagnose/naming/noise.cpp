#include "studies/diagnose/naming/noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::naming {
namespace {

/// χ²/ν: the sum itself, of many degrees by Wilson & Hilferty (1931).
double drawn_size(double degrees, base::RandomStream& random) {
  constexpr double kMany = 100;
  if (degrees > kMany) {
    const double v = 2 / (9 * degrees);
    return std::pow(1 - v + std::sqrt(v) * random.normals(1)[0], 3);
  }
  const auto few = std::max<Index>(1, std::lround(degrees));
  return random.normals(few).squaredNorm() / static_cast<double>(few);
}

}  // namespace

Noise::Noise(const MatrixXd& covariance, std::vector<CommonSize> sizes) : factor_(factor(covariance)), sizes_(std::move(sizes)) {}

VectorXd Noise::draw(base::RandomStream& random) const {
  VectorXd out = factor_ * random.normals(factor_.rows());
  for (const CommonSize& size : sizes_) out(size.observables) /= std::sqrt(drawn_size(size.degrees, random));
  return out;
}

}  // namespace millscope::naming
