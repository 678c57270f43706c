#include "studies/doe/stationary.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/doe/least_squares.hpp"
#include "studies/doe/sequences.hpp"
#include "studies/picture/scale.hpp"

namespace millscope::doe {
namespace {

using Index = Eigen::Index;
using picture::significant_text;

constexpr double kNoCurvature = 1e-10;  // of the largest: rounding
constexpr double kRidge = 0.02;         // of the largest: flat enough to be called a ridge, where it cannot be told from zero either
constexpr Index kRegionPoints = 4096, kFacePoints = 512;

/// Delta method: dλ = vᵀ dB v.
double standard_error_of_axis(const Surface& s, const Eigen::VectorXd& direction) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(static_cast<Index>(s.coefficients.size()));
  for (std::size_t c = 0; c < s.coefficients.size(); ++c) {
    const auto& f = s.coefficients[c].factors;
    if (f.size() == 2) weight[static_cast<Index>(c)] = direction[f[0]] * direction[f[1]];
  }
  return std::sqrt(weight.dot(s.covariance * weight));
}

std::vector<Axis> axes_of(const Surface& s, const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& eigen) {
  const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
  const double quantile = s.residual.df > 0 ? t_quantile(1 - s.confidence, s.residual.df) : 0;
  std::vector<Axis> axes;
  for (Index i = 0; i < eigen.eigenvalues().size(); ++i) {
    Axis axis{eigen.eigenvalues()[i], kUndefined, eigen.eigenvectors().col(i), false};
    Index leading = 0;
    axis.direction.cwiseAbs().maxCoeff(&leading);
    if (axis.direction[leading] < 0) axis.direction = -axis.direction;
    if (s.residual.df > 0) axis.standard_error = standard_error_of_axis(s, axis.direction);
    axis.flat = std::abs(axis.curvature) <= kNoCurvature * largest || std::abs(axis.curvature) < quantile * axis.standard_error;
    axes.push_back(std::move(axis));
  }
  std::sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return std::abs(a.curvature) < std::abs(b.curvature); });
  return axes;
}

StationaryKind kind_of(const std::vector<Axis>& axes) {
  const double largest = std::abs(axes.back().curvature);
  int up = 0, down = 0;
  for (const Axis& axis : axes) {
    if (axis.flat && std::abs(axis.curvature) <= kRidge * largest) return StationaryKind::ridge;
    ++(axis.curvature > 0 ? up : down);
  }
  return down == 0 ? StationaryKind::minimum : up == 0 ? StationaryKind::maximum : StationaryKind::saddle;
}

/// The point nearest to the centre where the gradient vanishes; directions without curvature are not followed.
Eigen::VectorXd point_of(const Quadratic& q, const std::vector<Axis>& axes) {
  Eigen::VectorXd point = Eigen::VectorXd::Zero(q.linear.size());
  for (const Axis& axis : axes) {
    if (std::abs(axis.curvature) <= kNoCurvature * std::abs(axes.back().curvature)) continue;
    point -= axis.direction * (axis.direction.dot(q.linear) / (2 * axis.curvature));
  }
  return point;
}

/// Whether the gradient g at a point can be told from zero: gᵀ V⁻¹ g ≤ k F(k, ν), V its covariance (Box, Hunter 1954).
class Membership {
 public:
  explicit Membership(const Surface& s) : surface_(s) {
    const int count = static_cast<int>(s.factors.size());
    limit_ = count * f_quantile(1 - s.confidence, count, s.residual.df);
    coefficient_.resize(static_cast<Index>(s.coefficients.size()));
    for (std::size_t c = 0; c < s.coefficients.size(); ++c) coefficient_[static_cast<Index>(c)] = s.coefficients[c].value;
  }
  bool operator()(const Eigen::VectorXd& coded) const {
    const Eigen::MatrixXd slopes = slopes_at(surface_.coefficients, coded);
    const Eigen::VectorXd gradient = slopes * coefficient_;
    const Eigen::MatrixXd variance = slopes * surface_.covariance * slopes.transpose();
    return gradient.dot(variance.ldlt().solve(gradient)) <= limit_;
  }

  double limit() const { return limit_; }

 private:
  const Surface& surface_;
  Eigen::VectorXd coefficient_;
  double limit_ = 0;
};

/// Members of the region among Sobol's points in a box and their shadows on its faces.
struct Members {
  Eigen::VectorXd low, high;                              ///< of the members; low > high: none
  Eigen::Array<bool, Eigen::Dynamic, 1> at_low, at_high;  ///< some lie on this face
  double share = 0;                                       ///< of the box
};

Members members_in(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, const Membership& belongs) {
  const Index count = lower.size();
  Members m{upper, lower, Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(count, false), {}, 0};
  m.at_high = m.at_low;
  const auto ask = [&](const Eigen::VectorXd& x) {
    const bool member = belongs(x);
    if (member) m.low = m.low.cwiseMin(x), m.high = m.high.cwiseMax(x);
    return member;
  };
  const Eigen::MatrixXd unit = sobol_points(kRegionPoints, count);
  for (Index p = 0; p < kRegionPoints; ++p) {
    Eigen::VectorXd x = lower + unit.row(p).transpose().cwiseProduct(upper - lower);
    if (ask(x)) m.share += 1.0 / static_cast<double>(kRegionPoints);
    for (Index i = 0; i < count && p < kFacePoints; ++i) {
      const double kept = std::exchange(x[i], lower[i]);
      m.at_low[i] = ask(x) || m.at_low[i];
      x[i] = upper[i];
      m.at_high[i] = ask(x) || m.at_high[i];
      x[i] = kept;
    }
  }
  return m;
}

/// The box about the stationary point that holds all members near it: begun by the linear error of the point, x − x₀ ≈ −(2B)⁻¹ δg, and
/// widened until no member lies on a face that is not an end of the runs' range.
Members members_near(const Surface& s, const StationaryPoint& point, const Membership& belongs, double& volume) {
  const Eigen::MatrixXd inverse = (2 * quadratic_of(s).form).inverse(), slopes = slopes_at(s.coefficients, point.coded);
  const Eigen::VectorXd half =
      1.5 * (belongs.limit() * (inverse * slopes * s.covariance * slopes.transpose() * inverse).diagonal()).cwiseSqrt();
  const Eigen::VectorXd span = s.upper - s.lower;
  Eigen::VectorXd below = half.array().isFinite().select(half, span), above = below;
  for (;;) {
    const Eigen::VectorXd lower = s.lower.cwiseMax(point.coded - below), upper = s.upper.cwiseMin(point.coded + above);
    const Members m = members_in(lower, upper, belongs);
    volume = (upper - lower).cwiseQuotient(span).prod();
    const auto widen_low = m.at_low && lower.array() > s.lower.array(), widen_high = m.at_high && upper.array() < s.upper.array();
    if (!widen_low.any() && !widen_high.any()) return m;
    below = widen_low.select(2 * below, below).eval();
    above = widen_high.select(2 * above, above).eval();
  }
}

/// Members in the whole range of the runs, where the region may have other parts, and near the point, where it may be small.
StationaryRegion region_of(const Surface& s, const StationaryPoint& point) {
  const Membership belongs(s);
  const Members all = members_in(s.lower, s.upper, belongs);
  StationaryRegion region{s.confidence, all.low, all.high, std::vector<bool>(s.factors.size(), true), all.share};
  for (std::size_t i = 0; i < s.factors.size(); ++i)
    region.bounded[i] = !all.at_low[static_cast<Index>(i)] && !all.at_high[static_cast<Index>(i)];
  if (point.inside) {
    double volume = 1;
    const Members near = members_near(s, point, belongs, volume);
    if ((all.low.array() >= near.low.array()).all() && (all.high.array() <= near.high.array()).all()) region.share = near.share * volume;
    region.low = region.low.cwiseMin(near.low).cwiseMin(point.coded);
    region.high = region.high.cwiseMax(near.high).cwiseMax(point.coded);
    for (std::size_t i = 0; i < s.factors.size(); ++i) {
      const Index at = static_cast<Index>(i);
      region.bounded[i] = region.bounded[i] && region.low[at] > s.lower[at] && region.high[at] < s.upper[at];
    }
  }
  if ((region.low.array() > region.high.array()).any()) {  // all of it lies outside the box
    region.low.setConstant(kUndefined);
    region.high.setConstant(kUndefined);
    region.bounded.assign(s.factors.size(), false);
  }
  return region;
}

/// "CRPG", or "0.71 CFPP - 0.70 CRPG" for an axis between the factors.
std::string text_of(const Axis& axis, const std::vector<Factor>& factors) {
  Index leading = 0;
  const double most = axis.direction.cwiseAbs().maxCoeff(&leading);
  if (most > 0.95) return factors[leading].name;
  std::string text;
  for (Index i = 0; i < axis.direction.size(); ++i) {
    if (std::abs(axis.direction[i]) < 0.1) continue;
    text += fmt::format("{}{:.2g} {}", text.empty() ? (axis.direction[i] < 0 ? "-" : "") : (axis.direction[i] < 0 ? " - " : " + "),
                        std::abs(axis.direction[i]), factors[i].name);
  }
  return text;
}

std::string sentence_of(const Surface& s, const StationaryPoint& point) {
  std::string text = fmt::format("a {} at", name_of(point.kind));
  for (std::size_t i = 0; i < s.factors.size(); ++i) {
    text += fmt::format("{} {} = {:.4g}", i > 0 ? "," : "", s.factors[i].name, point.natural[static_cast<Index>(i)]);
  }
  text += point.inside ? ", inside the range of the runs" : ", outside the range of the runs: an extrapolation";
  for (const Axis& axis : point.axes) {
    if (!axis.flat) continue;
    text += fmt::format("; along {} the curvature {}{} cannot be told from zero, so these runs do not determine the place along it",
                        text_of(axis, s.factors), significant_text(axis.curvature, 3),
                        std::isfinite(axis.standard_error) ? fmt::format(" ± {:.2g}", axis.standard_error) : "");
  }
  return text;
}

}  // namespace

const char* name_of(StationaryKind kind) {
  switch (kind) {
    case StationaryKind::minimum:
      return "minimum";
    case StationaryKind::maximum:
      return "maximum";
    case StationaryKind::saddle:
      return "saddle";
    case StationaryKind::ridge:
      break;
  }
  return "ridge";
}

Eigen::VectorXd terms_at(const std::vector<Coefficient>& coefficients, const Eigen::VectorXd& coded) {
  Eigen::VectorXd terms = Eigen::VectorXd::Ones(static_cast<Index>(coefficients.size()));
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    for (const int i : coefficients[c].factors) terms[static_cast<Index>(c)] *= coded[i];
  }
  return terms;
}

Eigen::MatrixXd slopes_at(const std::vector<Coefficient>& coefficients, const Eigen::VectorXd& coded) {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(coded.size(), static_cast<Index>(coefficients.size()));
  for (std::size_t c = 0; c < coefficients.size(); ++c) {
    const auto& f = coefficients[c].factors;
    const Index term = static_cast<Index>(c);
    if (f.size() == 1) slopes(f[0], term) = 1;
    if (f.size() != 2) continue;
    slopes(f[0], term) += coded[f[1]];
    slopes(f[1], term) += coded[f[0]];
  }
  return slopes;
}

Quadratic quadratic_of(const Surface& s) {
  const Index count = static_cast<Index>(s.factors.size());
  Quadratic q{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
  for (const Coefficient& c : s.coefficients) {
    if (c.factors.size() == 1) q.linear[c.factors[0]] = c.value;
    if (c.factors.size() != 2) continue;
    q.form(c.factors[0], c.factors[1]) += c.value / 2;
    q.form(c.factors[1], c.factors[0]) += c.value / 2;
  }
  return q;
}

bool gradient_may_vanish(const Surface& surface, const Eigen::VectorXd& coded) { return Membership(surface)(coded); }

std::optional<StationaryPoint> find_stationary(const Surface& surface) {
  const Quadratic q = quadratic_of(surface);
  if (q.form.cwiseAbs().maxCoeff() <= kNoCurvature * std::max(q.linear.cwiseAbs().maxCoeff(), std::sqrt(surface.total.value)))
    return std::nullopt;
  StationaryPoint point;
  point.axes = axes_of(surface, Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(q.form));
  point.kind = kind_of(point.axes);
  point.coded = point_of(q, point.axes);
  point.natural = natural(surface.factors, point.coded);
  point.value = value_at(surface, point.coded);
  point.inside = (point.coded.array() >= surface.lower.array()).all() && (point.coded.array() <= surface.upper.array()).all();
  if (surface.residual.df > 0 && surface.residual.value > 0) point.region = region_of(surface, point);
  point.sentence = sentence_of(surface, point);
  return point;
}

}  // namespace millscope::doe
