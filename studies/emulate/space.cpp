#include "studies/emulate/space.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/base/random.hpp"
#include "studies/emulate/prior.hpp"

namespace millscope::emulate {

bool Box::contains(const Eigen::VectorXd& point) const {
  return (point.array() >= lower.array()).all() && (point.array() <= upper.array()).all() && (!allowed || allowed(point));
}

Eigen::VectorXd Box::coded(const Eigen::VectorXd& point) const { return (2 * point - lower - upper).cwiseQuotient(upper - lower); }

Eigen::VectorXd Box::natural(const Eigen::VectorXd& coded) const {
  // Rounding must not carry the end of a range across it.
  return (0.5 * (lower + upper) + 0.5 * coded.cwiseProduct(upper - lower)).cwiseMax(lower).cwiseMin(upper);
}

std::string Box::name_of(Eigen::Index parameter) const {
  return parameter < std::ssize(name) ? name[parameter] : fmt::format("parameter {}", parameter + 1);
}

void Box::check() const {
  if (lower.size() == 0) throw base::UserError("no parameter to vary: give at least one range");
  if (upper.size() != lower.size()) throw std::invalid_argument("Box: lower and upper differ in length");
  for (Eigen::Index k = 0; k < size(); ++k) {
    if (!(std::isfinite(lower[k]) && std::isfinite(upper[k]) && lower[k] < upper[k])) {
      throw base::UserError(fmt::format("range of {}: {} to {} is empty; the first must be smaller", name_of(k), lower[k], upper[k]));
    }
  }
}

Eigen::MatrixXd prior_points(const Box& box, int count, std::uint64_t seed) {
  constexpr int kTriesPerPoint = 2000;
  box.check();
  base::RandomStream random(seed, 0x9e1);
  Eigen::MatrixXd points(box.size(), count);
  long tries = 0;
  for (int i = 0; i < count;) {
    if (tries++ > kTriesPerPoint * static_cast<long>(i + 1)) {
      throw base::UserError(
          fmt::format("the constraints leave next to nothing of the ranges: {} of {} points are allowed; contradict each "
                      "other ranges and constraints?",
                      i, tries - 1));
    }
    const Eigen::VectorXd point = box.natural(random.uniforms(box.size(), -1, 1));
    if (box.contains(point)) points.col(i++) = point;
  }
  return points;
}

}  // namespace millscope::emulate
