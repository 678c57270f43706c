#include "studies/diagnose/naming/noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::naming {
namespace {

/// χ²/ν: the sum itself, of many degrees by variance_at().
double drawn_size(double degrees, base::RandomStream& random) {
  constexpr double kMany = 100;
  if (degrees > kMany) return variance_at(degrees, random.normals(1)[0]);
  const auto few = std::max<Index>(1, std::lround(degrees));
  return random.normals(few).squaredNorm() / static_cast<double>(few);
}

}  // namespace

double variance_at(double degrees, double normal) {
  const double v = 2 / (9 * degrees);
  return std::pow(std::max(0.0, 1 - v + normal * std::sqrt(v)), 3);
}

Noise::Noise(const MatrixXd& covariance, std::vector<CommonSize> sizes) : factor_(factor(covariance)), sizes_(std::move(sizes)) {}

VectorXd Noise::draw(base::RandomStream& random) const {
  VectorXd out = factor_ * random.normals(factor_.rows());
  for (const CommonSize& size : sizes_) out(size.observables) /= std::sqrt(drawn_size(size.degrees, random));
  return out;
}

}  // namespace millscope::naming
