// The natural cubic spline in terms of its slopes v at the knots. Continuity of the second derivative at knot i:
//   v[i−1]/h[i−1] + 2 (1/h[i−1] + 1/h[i]) v[i] + v[i+1]/h[i] = 3 (d[i−1]/h[i−1] + d[i]/h[i]),   d[i] = (y[i+1] − y[i])/h[i]
// and no second derivative at the ends. T v = C y; T is tridiagonal, so v = T⁻¹ C y in O(n), and the rows of T⁻¹, which fall off by a
// factor of about four per knot, give what noise does to the slopes.
#include <algorithm>
#include <cmath>

#include "studies/trajectory/pieces.hpp"

namespace millscope::trajectory {
namespace {

constexpr std::size_t kReach = 8;  // knots on either side; beyond them a point has no weight to speak of (4^-8 where they are even)

struct Slopes {
  std::vector<double> inverse_step;       // 1/h, per interval
  std::vector<double> diagonal;           // of T
  std::vector<double> forward, backward;  // pivots of the eliminations from the left and from the right
  std::size_t count() const { return diagonal.size(); }

  explicit Slopes(const double* time, std::size_t count);
  void solve(const double* value, std::size_t axis, std::vector<Knot>& knots) const;
  double right_side(const double* value, std::size_t i) const;
  /// T⁻¹ at (i, i).
  double inverse(std::size_t i) const { return 1 / (forward[i] + backward[i] - diagonal[i]); }
};

Slopes::Slopes(const double* time, std::size_t count) : inverse_step(count - 1), diagonal(count), forward(count), backward(count) {
  for (std::size_t i = 0; i + 1 < count; ++i) inverse_step[i] = 1 / (time[i + 1] - time[i]);
  for (std::size_t i = 0; i < count; ++i) diagonal[i] = 2 * ((i > 0 ? inverse_step[i - 1] : 0) + (i + 1 < count ? inverse_step[i] : 0));
  forward[0] = diagonal[0];
  for (std::size_t i = 1; i < count; ++i) forward[i] = diagonal[i] - inverse_step[i - 1] * inverse_step[i - 1] / forward[i - 1];
  backward[count - 1] = diagonal[count - 1];
  for (std::size_t i = count - 1; i-- > 0;) backward[i] = diagonal[i] - inverse_step[i] * inverse_step[i] / backward[i + 1];
}

double Slopes::right_side(const double* value, std::size_t i) const {
  double sum = 0;
  if (i > 0) sum += (value[i] - value[i - 1]) * inverse_step[i - 1] * inverse_step[i - 1];
  if (i + 1 < count()) sum += (value[i + 1] - value[i]) * inverse_step[i] * inverse_step[i];
  return 3 * sum;
}

void Slopes::solve(const double* value, std::size_t axis, std::vector<Knot>& knots) const {
  double v = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    v = (right_side(value, i) - (i > 0 ? inverse_step[i - 1] * v : 0)) / forward[i];
    knots[i].v[axis] = v;
  }
  for (std::size_t i = count() - 1; i-- > 0;) knots[i].v[axis] = v = knots[i].v[axis] - inverse_step[i] / forward[i] * v;
}

/// The weights of the points around knot i in its slope: row i of T⁻¹ C, points first … first + size − 1.
struct Row {
  std::size_t first = 0, size = 0;
  std::array<double, 2 * kReach + 3> weight{};
  double at(std::size_t j) const { return j >= first && j < first + size ? weight[j - first] : 0; }
};

Row row_of(const Slopes& slopes, std::size_t i) {
  const std::size_t n = slopes.count();
  const std::size_t low = i > kReach ? i - kReach : 0, high = std::min(i + kReach, n - 1);
  Row row;
  row.first = low > 0 ? low - 1 : 0;
  row.size = std::min(high + 1, n - 1) - row.first + 1;
  // Adds T⁻¹(i, j) times row j of C.
  const auto add = [&](std::size_t j, double inverse) {
    if (j > 0) {
      const double c = 3 * inverse * slopes.inverse_step[j - 1] * slopes.inverse_step[j - 1];
      row.weight[j - row.first] += c;
      row.weight[j - 1 - row.first] -= c;
    }
    if (j + 1 < n) {
      const double c = 3 * inverse * slopes.inverse_step[j] * slopes.inverse_step[j];
      row.weight[j + 1 - row.first] += c;
      row.weight[j - row.first] -= c;
    }
  };
  const double middle = slopes.inverse(i);
  add(i, middle);
  double inverse = middle;
  for (std::size_t j = i; j-- > low;) add(j, inverse *= -slopes.inverse_step[j] / slopes.forward[j]);
  inverse = middle;
  for (std::size_t j = i + 1; j <= high; ++j) add(j, inverse *= -slopes.inverse_step[j - 1] / slopes.backward[j]);
  return row;
}

double product(const Row& a, const Row& b, const std::vector<double>& variance) {
  const std::size_t first = std::max(a.first, b.first), last = std::min(a.first + a.size, b.first + b.size);
  double sum = 0;
  for (std::size_t j = first; j < last; ++j) sum += a.weight[j - a.first] * b.weight[j - b.first] * variance[j];
  return sum;
}

}  // namespace

Averaged average(const Points& points, double interval, double correlation) {
  Averaged averaged;
  for (std::size_t first = 0, last = 0; first < points.count; first = last) {
    while (last < points.count && points.time[last] - points.time[first] < interval) ++last;
    last = std::max(last, first + 1);
    const double count = static_cast<double>(last - first);
    const auto mean = [&](const double* values) {
      double sum = 0;
      for (std::size_t i = first; i < last; ++i) sum += values[i] - values[first];
      return values[first] + sum / count;
    };
    averaged.time.push_back(mean(points.time));
    for (std::size_t axis = 0; axis < 3; ++axis) averaged.position[axis].push_back(mean(points.position[axis]));
    double variance = 1, power = 1;  // of the mean of correlated values: 1/n + 2/n Σ (1 − k/n) φ^k
    for (double k = 1; k < count; ++k) variance += 2 * (1 - k / count) * (power *= correlation);
    averaged.variance.push_back(variance / count);
  }
  return averaged;
}

void interpolate(const Averaged& averaged, const Lanes& noise, Spline& spline) {
  const Points points = averaged.points();
  const std::size_t count = points.count;
  const Slopes slopes(points.time, count);
  spline.knots.assign(count, {});
  spline.between.assign(count - 1, {});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < count; ++i) spline.knots[i].x[axis] = points.position[axis][i];
    slopes.solve(points.position[axis], axis, spline.knots);
  }
  const std::vector<double>& variance = averaged.variance;
  const double sum = noise[0] * noise[0] + noise[1] * noise[1] + noise[2] * noise[2];
  Row here = row_of(slopes, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const double mixed = here.at(i) * variance[i], velocity = product(here, here, variance);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double squared = noise[axis] * noise[axis];
      spline.knots[i].xx[axis] = squared * variance[i];
      spline.knots[i].xv[axis] = squared * mixed;
      spline.knots[i].vv[axis] = squared * velocity;
    }
    if (i + 1 == count) break;
    const Row next = row_of(slopes, i + 1);
    spline.between[i] = {0, sum * next.at(i) * variance[i], sum * here.at(i + 1) * variance[i + 1], sum * product(here, next, variance), 0};
    here = next;
  }
}

}  // namespace millscope::trajectory
