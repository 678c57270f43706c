#include "studies/diagnose/naming/noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/diagnose/naming/covariance.hpp"

namespace millscope::naming {

Noise::Noise(const MatrixXd& covariance, std::vector<CommonSize> sizes) : factor_(factor(covariance)), sizes_(std::move(sizes)) {}

VectorXd Noise::draw(base::RandomStream& random) const {
  VectorXd out = factor_ * random.normals(factor_.rows());
  for (const CommonSize& size : sizes_) {
    const auto degrees = std::max<Index>(1, std::lround(size.degrees));
    out(size.observables) *= std::sqrt(static_cast<double>(degrees) / random.normals(degrees).squaredNorm());
  }
  return out;
}

}  // namespace millscope::naming
