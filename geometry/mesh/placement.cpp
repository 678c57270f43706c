#include "geometry/mesh/placement.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

/// Moments that differ by less than this fraction are equal.
constexpr double kEqualMoments = 0.01;
/// A detected direction within half a degree of a coordinate axis is that axis.
constexpr double kSnapCosine = 0.99996192306417131;

Eigen::Vector3d eigen(const Point& p) { return {p.x, p.y, p.z}; }

void transform(Soup& soup, const Rotation& rotation) {
  for (Point& p : soup.corners) p = rotation(p);
}

void move(Soup& soup, const Point& step) {
  for (Point& p : soup.corners) p = p + step;
}

Point positive(const Point& d) {
  const double ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  const double largest = ax >= ay && ax >= az ? d.x : ay >= az ? d.y : d.z;
  return largest < 0 ? -1.0 * d : d;
}

Point snapped(const Point& d) {
  for (const Point& axis : {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}}) {
    if (dot(d, axis) > kSnapCosine) return axis;
  }
  return d;
}

void turn_axis_to_z(Soup& soup, const std::string& axis) {
  if (axis == "z") return;
  if (axis == "x") return transform(soup, rotation_to_z({1, 0, 0}));
  if (axis == "y") return transform(soup, rotation_to_z({0, 1, 0}));
  const Axis found = find_axis(soup);
  if (!found.found) throw Refusal("axis: auto finds no axis of rotation in this mesh: write axis: x, y or z");
  transform(soup, rotation_to_z(found.direction));
}

void repeat_round_z(Soup& soup, int times) {
  const std::size_t corners = soup.corners.size(), triangles = soup.size();
  soup.corners.reserve(corners * as_size(times));
  soup.slots.reserve(triangles * as_size(times));
  for (int k = 1; k < times; ++k) {
    const Rotation turn = rotation_about({0, 0, 1}, 2 * std::numbers::pi * k / times);
    for (std::size_t i = 0; i < corners; ++i) soup.corners.push_back(turn(soup.corners[i]));
    for (std::size_t i = 0; i < triangles; ++i) soup.slots.push_back(soup.slots[i]);
  }
}

}  // namespace

Rotation rotation_about(const Point& axis, double angle) {
  const Point k = (1 / length(axis)) * axis;
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  return {{{c + k.x * k.x * d, k.x * k.y * d - k.z * s, k.x * k.z * d + k.y * s},
           {k.y * k.x * d + k.z * s, c + k.y * k.y * d, k.y * k.z * d - k.x * s},
           {k.z * k.x * d - k.y * s, k.z * k.y * d + k.x * s, c + k.z * k.z * d}}};
}

Rotation rotation_to_z(const Point& direction) {
  if (direction.x == 1) return {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  if (direction.y == 1) return {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  const Point across = cross(direction, {0, 0, 1});
  const double sine = length(across);
  if (sine < 1e-15) return {};
  return rotation_about(across, std::atan2(sine, direction.z));
}

Axis find_axis(const Soup& soup) {
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < soup.size(); ++t) {
    const Eigen::Vector3d a = eigen(soup.corners[3 * t]), b = eigen(soup.corners[3 * t + 1]), c = eigen(soup.corners[3 * t + 2]);
    const double piece = 0.5 * (b - a).cross(c - a).norm();
    const Eigen::Vector3d sum = a + b + c;
    area += piece;
    first += piece / 3 * sum;
    second += piece / 12 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  Axis axis;
  if (!(area > 0)) return axis;
  const Eigen::Vector3d centre = first / area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second - area * centre * centre.transpose());
  const Eigen::Vector3d moment = solver.eigenvalues();  // ascending
  const double low = (moment[1] - moment[0]) / moment[2], high = (moment[2] - moment[1]) / moment[2];
  axis.asymmetry = std::min(low, high);
  axis.found = axis.asymmetry < kEqualMoments && std::max(low, high) >= kEqualMoments;  // all three equal: a cube, a ball
  axis.point = {centre[0], centre[1], centre[2]};
  const Eigen::Vector3d direction = solver.eigenvectors().col(low < high ? 2 : 0);
  axis.direction = snapped(positive({direction[0], direction[1], direction[2]}));
  return axis;
}

void place(Soup& soup, const Placement& placement) {
  for (Point& p : soup.corners) p = placement.scale * p;
  turn_axis_to_z(soup, placement.axis);
  if (placement.centre) {
    const Axis axis = find_axis(soup);
    if (!axis.found || axis.direction.z != 1) {
      throw Refusal("centre: true finds no axis along z to centre: write axis: auto, or centre: false and translate");
    }
    move(soup, {-axis.point.x, -axis.point.y, 0});
  }
  if (placement.rotate_angle != 0) {
    if (!(length(placement.rotate_axis) > 0)) throw Refusal("rotate_angle without rotate_axis: write for example rotate_axis: [0, 0, 1]");
    transform(soup, rotation_about(placement.rotate_axis, placement.rotate_angle));
  }
  move(soup, placement.translate);
  if (placement.repeat > 1) repeat_round_z(soup, placement.repeat);
}

}  // namespace millscope::geometry
