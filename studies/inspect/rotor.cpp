#include "studies/inspect/rotor.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/circles.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/windows.hpp"

namespace millscope::inspect {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Two directions in the plane of rotation, its normal, and a point of it.
struct Plane {
  Vector3d middle, first, second, normal;
};

Vector3d point_of(const recording::Run& run, std::size_t i) { return {run.position[0][i], run.position[1][i], run.position[2][i]}; }

// At most about fifty thousand, evenly chosen.
std::vector<Vector3d> some_points(const recording::Recording& recording) {
  std::size_t count = 0;
  for (const recording::Run& run : recording.runs) count += run.size();
  const std::size_t stride = count / 50000 + 1;
  std::vector<Vector3d> points;
  for (const recording::Run& run : recording.runs) {
    for (std::size_t i = 0; i < run.size(); i += stride) points.push_back(point_of(run, i));
  }
  return points;
}

// Least and largest axes of the scatter of what lies near the middle.
Plane fit_plane(const std::vector<Vector3d>& points) {
  Plane plane;
  std::vector<double> values(points.size());
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][a];
    plane.middle[a] = base::quantile(values, 0.5);
  }
  for (std::size_t i = 0; i < points.size(); ++i) values[i] = (points[i] - plane.middle).norm();
  const double near = 3 * base::quantile(values, 0.5);
  Vector3d mean = Vector3d::Zero();
  double count = 0;
  for (const Vector3d& p : points) {
    if ((p - plane.middle).norm() > near) continue;
    mean += p;
    count += 1;
  }
  mean /= std::max(1.0, count);
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& p : points) {
    if ((p - plane.middle).norm() <= near) scatter += (p - mean) * (p - mean).transpose();
  }
  const Matrix3d axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors();
  plane.middle = mean;
  plane.normal = axes.col(0);
  plane.first = axes.col(2);
  plane.second = plane.normal.cross(plane.first);
  return plane;
}

PlanePoints project(const std::vector<Vector3d>& points, const Plane& plane) {
  PlanePoints result;
  for (const Vector3d& p : points) {
    result.x.push_back(plane.first.dot(p - plane.middle));
    result.y.push_back(plane.second.dot(p - plane.middle));
  }
  return result;
}

// The distances from the circle and the plane are small, and all directions occur.
bool is_circle(const std::vector<Vector3d>& points, const PlanePoints& flat, const Plane& plane, const Circle& circle) {
  std::vector<double> radial, normal;
  std::array<bool, 36> seen{};
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const double dx = flat.x[i] - circle.x, dy = flat.y[i] - circle.y;
    radial.push_back(std::fabs(std::hypot(dx, dy) - circle.radius));
    normal.push_back(std::fabs(plane.normal.dot(points[i] - plane.middle)));
    if (radial.back() < 0.1 * circle.radius) {
      seen[static_cast<std::size_t>(std::clamp((std::atan2(dy, dx) / kTurn + 0.5) * 36, 0.0, 35.0))] = true;
    }
  }
  return base::quantile(radial, 0.9) < 0.12 * circle.radius && base::quantile(normal, 0.9) < 0.25 * circle.radius &&
         std::count(seen.begin(), seen.end(), true) > 32;
}

/// Mean angular speed of a short span.
struct Pace {
  std::size_t run;
  double start, end;  // s
  double speed;       // rad/s
  double deviation;
};

class Phases {
 public:
  Phases(const Plane& plane, const Circle& circle) : plane_(plane), circle_(circle) {}
  double operator()(const recording::Run& run, std::size_t i) const {
    const Vector3d p = point_of(run, i) - plane_.middle;
    return std::atan2(plane_.second.dot(p) - circle_.y, plane_.first.dot(p) - circle_.x);
  }

 private:
  const Plane& plane_;
  const Circle& circle_;
};

// Slope of the unwrapped angle over spans of `length`, in unbroken stretches.
std::vector<Pace> measure_paces(const recording::Recording& recording, const Phases& phase, double length) {
  std::vector<Pace> paces;
  for (const UnbrokenStretch& stretch : unbroken_stretches(recording)) {
    const recording::Run& run = *stretch.run;
    std::size_t i = stretch.first;
    while (i < stretch.last && run.time[i] + length <= run.time[stretch.last - 1]) {
      const double start = run.time[i];
      double n = 0, t = 0, a = 0, tt = 0, ta = 0, aa = 0, angle = phase(run, i);
      const double origin = angle;
      for (; i < stretch.last && run.time[i] < start + length; ++i) {
        const double raw = phase(run, i);
        angle = raw + kTurn * std::round((angle - raw) / kTurn);
        const double s = run.time[i] - start - 0.5 * length, u = angle - origin;
        n += 1, t += s, a += u, tt += s * s, ta += s * u, aa += u * u;
      }
      if (n < 10) continue;
      const double stt = tt - t * t / n, sta = ta - t * a / n, saa = aa - a * a / n;
      paces.push_back(
          {stretch.run_number, start, start + length, sta / stt, std::sqrt(std::max(0.0, saa - sta * sta / stt) / (n - 2) / stt)});
    }
  }
  return paces;
}

Plateau make_plateau(const std::vector<Pace>& paces, std::size_t first, std::size_t last) {
  if (last - first > 6) ++first, --last;  // where the speed was still changing
  double mean = 0, squares = 0;
  const auto n = static_cast<double>(last - first);
  for (std::size_t i = first; i < last; ++i) mean += paces[i].speed / n;
  for (std::size_t i = first; i < last; ++i) squares += (paces[i].speed - mean) * (paces[i].speed - mean);
  return {paces[first].run, paces[first].start, paces[last - 1].end, interval(std::fabs(mean), std::sqrt(squares / (n - 1) / n), n - 1)};
}

std::vector<Plateau> find_plateaus(const std::vector<Pace>& paces) {
  constexpr std::size_t kFewest = 4;
  std::vector<Plateau> plateaus;
  for (std::size_t first = 0; first < paces.size();) {
    double mean = paces[first].speed;
    std::size_t last = first + 1;
    for (; last < paces.size() && paces[last].run == paces[first].run && paces[last].start - paces[last - 1].end < 3; ++last) {
      if (std::fabs(paces[last].speed - mean) > std::max(0.05 * std::fabs(mean), 4 * paces[last].deviation)) break;
      mean += (paces[last].speed - mean) / static_cast<double>(last - first + 1);
    }
    const bool steady = last - first >= kFewest && std::fabs(mean) > 0.05;
    if (steady) plateaus.push_back(make_plateau(paces, first, last));
    first = steady ? last : first + 1;
  }
  return plateaus;
}

// Interrupted plateaus of one speed are one.
std::vector<Plateau> merge(std::vector<Plateau> plateaus) {
  std::vector<Plateau> merged;
  for (const Plateau& p : plateaus) {
    if (!merged.empty() && merged.back().run == p.run && std::fabs(merged.back().speed.value / p.speed.value - 1) < 0.03 &&
        p.start - merged.back().end < 10) {
      Plateau& m = merged.back();
      const double before = m.end - m.start, now = p.end - p.start, all = before + now;
      m.end = p.end;
      m.speed = {(m.speed.value * before + p.speed.value * now) / all, (m.speed.low * before + p.speed.low * now) / all,
                 (m.speed.high * before + p.speed.high * now) / all};
      continue;
    }
    merged.push_back(p);
  }
  return merged;
}

// Ten blocks of points, in order of time.
base::Interval90 radius_interval(const PlanePoints& flat, const Circle& circle, double scale) {
  constexpr std::size_t kBlocks = 10;
  double sum = 0, squares = 0;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    PlanePoints block;
    for (std::size_t i = b * flat.size() / kBlocks; i < (b + 1) * flat.size() / kBlocks; ++i) {
      block.x.push_back(flat.x[i]);
      block.y.push_back(flat.y[i]);
    }
    const double r = ridge_circle(block, {}, circle, scale).radius - circle.radius;
    sum += r;
    squares += r * r;
  }
  return interval(circle.radius, std::sqrt(std::max(0.0, squares - sum * sum / kBlocks) / (kBlocks - 1) / kBlocks), kBlocks - 1);
}

}  // namespace

std::optional<Rotor> recognise_rotor(const recording::Recording& recording) {
  constexpr double kPaceLength = 4;  // s
  const std::vector<Vector3d> points = some_points(recording);
  if (points.size() < 100) return std::nullopt;
  Plane plane = fit_plane(points);
  const PlanePoints flat = project(points, plane);
  std::vector<double> radii;
  for (std::size_t i = 0; i < flat.size(); ++i) radii.push_back(std::hypot(flat.x[i], flat.y[i]));
  Circle circle{0, 0, base::quantile(radii, 0.5)};
  for (const double part : {0.5, 0.2, 0.05}) circle = ridge_circle(flat, {}, circle, part * circle.radius);
  if (!is_circle(points, flat, plane, circle)) return std::nullopt;

  Rotor rotor;
  std::vector<double> misses;
  for (std::size_t i = 0; i < flat.size(); ++i)
    misses.push_back(std::fabs(std::hypot(flat.x[i] - circle.x, flat.y[i] - circle.y) - circle.radius));
  rotor.share = static_cast<double>(std::count_if(misses.begin(), misses.end(), [&](double m) { return m < 0.1 * circle.radius; })) /
                static_cast<double>(misses.size());
  rotor.scatter = 1.4826 * base::quantile(misses, 0.5);
  rotor.radius = radius_interval(flat, circle, std::max(3 * rotor.scatter, 0.02 * circle.radius));
  const std::vector<Pace> paces = measure_paces(recording, Phases(plane, circle), kPaceLength);
  double turned = 0;
  for (const Pace& p : paces) turned += p.speed;
  const Vector3d centre = plane.middle + circle.x * plane.first + circle.y * plane.second,
                 axis = turned < 0 ? Vector3d(-plane.normal) : plane.normal;
  for (int a = 0; a < 3; ++a) {
    rotor.centre[a] = centre[a];
    rotor.axis[a] = axis[a];
  }
  rotor.plateaus = merge(find_plateaus(paces));
  return rotor;
}

}  // namespace millscope::inspect
