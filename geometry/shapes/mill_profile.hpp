// Cross-section of a mill: a circular shell with trapezoid lifters, and the exact contact of a circle with it.
//
//   u, v       frame of one lifter: u from the axis through the middle of the lifter, v across it (counter-clockwise)
//   R          inner radius of the bare shell, m
//   h, w, a    lifter height, width at its base, angle between face and base (m, m, rad)
//   T = (R − h, w/2 − h/tan a)              top corner, convex: a bead may hang on it
//   F = T + s (1, cot a), |F| = R           foot, concave: a bead touches face and shell there, never the foot itself
//   e = (1, cot a)/|…|, n = (−e_v, e_u)     direction of a face (top to foot) and its normal, towards the beads
//
// A lifter is convex, so a bead touches each lifter once: at the place nearest to its centre. The shell is concave: one touch in a bay, the
// stretch of shell between two lifters, whose frame points to its middle.
#pragma once

#include <cstdint>
#include <vector>

#include "millscope/element.hpp"
#include "millscope/pack.hpp"

namespace millscope::geometry {

struct MillShape {
  double radius = 0, length = 0;                               ///< of the bare shell, m
  int lifters = 0;                                             ///< evenly spaced
  double lifter_height = 0, lifter_width = 0, face_angle = 0;  ///< m, m, rad
  double phase = 0;                                            ///< angle of the middle of lifter 0 from x, rad
  bool end_faces = false;
};

/// Which part of the outline a contact lies on; in this order they follow each other counter-clockwise.
enum class Piece : std::uint8_t { rear_face, top, front_face, shell };

/// A place on the outline.
struct ProfilePlace {
  int sector;  ///< lifter number; for the shell, the bay that follows this lifter
  Piece piece;
  double fraction;  ///< place along the piece, counter-clockwise, 0…1
};

/// Direction of the middle of a lifter or of a bay; what lies there is calculated in its frame.
struct ProfileFrame {
  double cosine, sine;
};

/// What a circle finds on one lifter or in one bay, in the frame of that. R: one circle (double) or a pack of them.
template <class R>
struct ProfileContact {
  R overlap;  ///< m; kUntouched where there is no place that could be touched
  R normal_u, normal_v;
  R piece;  ///< of a lifter: the number of its `Piece`
};

inline constexpr double kUntouched = -1e300;

class MillProfile {
 public:
  /// Refuses shapes that cannot be built (lifters that overlap or come to a point).
  explicit MillProfile(const MillShape& shape);

  /// Bays, which a smooth shell has one of. The bay k follows lifter k.
  int bays() const { return shape_.lifters > 0 ? shape_.lifters : 1; }
  const ProfileFrame& bay(int k) const { return bays_[as_size(k)]; }
  const ProfileFrame& lifter(int k) const { return lifters_[as_size(k)]; }

  /// The circle of this radius at (u, v) of a bay or of a lifter.
  template <class R>
  ProfileContact<R> touch_shell(R u, R v, R radius) const;
  template <class R>
  ProfileContact<R> touch_lifter(R u, R v, R radius) const;

  /// visit(k) for the bays, and for the lifters, that come within `reach` of a place when neither has moved farther than `reach`.
  template <class Visit>
  void near_bays(double x, double y, double reach, const Visit& visit) const;
  template <class Visit>
  void near_lifters(double x, double y, double reach, const Visit& visit) const;

  /// Under the point (u, v) of bay or lifter k.
  ProfilePlace place_on_shell(int k, double u, double v) const;
  ProfilePlace place_on_lifter(int k, double u, double v, Piece piece) const;

  /// Everything nearer to the axis than this is free.
  double free_radius() const { return shape_.lifters > 0 ? top_u_ : shape_.radius; }
  const MillShape& shape() const { return shape_; }
  double top_half_width() const { return top_v_; }
  double foot_angle() const { return foot_angle_; }
  double foot_u() const { return foot_u_; }
  double foot_v() const { return foot_v_; }
  double face_length() const { return face_length_; }
  /// Area between shell and lifter outline, all lifters, m².
  double lifter_area() const;

 private:
  MillShape shape_;
  double pitch_ = 0;                       // angle from lifter to lifter, rad
  double top_u_ = 0, top_v_ = 0;           // T
  double foot_u_ = 0, foot_v_ = 0;         // F
  double edge_u_ = 1, edge_v_ = 0;         // e
  double face_length_ = 0;                 // |F − T|
  double foot_angle_ = 0;                  // of F from the middle of the lifter
  double bay_half_angle_ = 0;              // of a foot from the middle of the bay
  double bay_cosine_ = -1, bay_sine_ = 0;  // of that; a smooth shell's bay is the whole turn
  double middle_u_ = 0, bounding_ = 0;     // circle round the lifter
  std::vector<ProfileFrame> lifters_, bays_;
};

template <class R>
ProfileContact<R> MillProfile::touch_shell(R u, R v, R radius) const {
  const R distance = square_root(u * u + v * v), nowhere(kUntouched);
  const auto has_direction = distance > R(0.0);
  // Outside of the bay a lifter stands between; its foot is concave. The sine of the angle beyond the foot, times the distance.
  const auto beyond = absolute(v) * R(bay_cosine_) - u * R(bay_sine_) > R(0.0);
  return {select(beyond, nowhere, radius + distance - R(shape_.radius)), select(has_direction, -u / distance, R(-1.0)),
          select(has_direction, -v / distance, R(0.0)), R(static_cast<double>(Piece::shell))};
}

/// Nearest place of one lifter, mirrored to v ≥ 0.
template <class R>
ProfileContact<R> MillProfile::touch_lifter(R u, R v, R radius) const {
  const R none(0.0);
  const auto is_rear = v < none;
  const R du = u - R(top_u_), dv = absolute(v) - R(top_v_);
  const R along = du * R(edge_u_) + dv * R(edge_v_), height = dv * R(edge_u_) - du * R(edge_v_);
  const auto inside = du > none && height < none;
  const auto on_top = (du <= none && dv <= none) || (inside && du < -height);
  const auto on_face = !on_top && (inside || (along > none && along < R(face_length_)));
  const auto at_foot = !on_top && !on_face && along > none;  // concave, never touched by itself
  const R to_corner = square_root(du * du + dv * dv);
  const auto has_direction = to_corner > none;
  const R corner_u = select(has_direction, du / to_corner, R(-1.0)), corner_v = select(has_direction, dv / to_corner, none);
  const R distance = select(on_top, -du, select(on_face, height, to_corner));
  const R normal_v = select(on_top, none, select(on_face, R(edge_u_), corner_v));
  const R face = select(is_rear, R(static_cast<double>(Piece::rear_face)), R(static_cast<double>(Piece::front_face)));
  return {select(at_foot, R(kUntouched), radius - distance), select(on_top, R(-1.0), select(on_face, R(-edge_v_), corner_u)),
          select(is_rear, -normal_v, normal_v), select(on_face, face, R(static_cast<double>(Piece::top)))};
}

template <class Visit>
void MillProfile::near_bays(double x, double y, double reach, const Visit& visit) const {
  const double distance = square_root(x * x + y * y);
  if (distance + reach < shape_.radius) return;
  for (int k = 0; k < bays(); ++k) {
    const ProfileFrame& f = bay(k);
    const double u = x * f.cosine + y * f.sine, v = y * f.cosine - x * f.sine;
    const bool before_it = bay_cosine_ < 0 || u > -reach;  // not beyond the axis, where the lines of its feet meet
    if (before_it && absolute(v) * bay_cosine_ - u * bay_sine_ <= reach) visit(k);
  }
}

template <class Visit>
void MillProfile::near_lifters(double x, double y, double reach, const Visit& visit) const {
  const double limit = reach + bounding_;
  for (int k = 0; k < shape_.lifters; ++k) {
    const ProfileFrame& f = lifter(k);
    const double u = x * f.cosine + y * f.sine, v = y * f.cosine - x * f.sine, du = u - middle_u_;
    if (du * du + v * v >= limit * limit) continue;
    // Beyond the foot the nearest place is on the line of the face or farther.
    const double along_u = u - top_u_, along_v = absolute(v) - top_v_, height = along_v * edge_u_ - along_u * edge_v_;
    if (along_u > -reach && height < reach) visit(k);
  }
}

}  // namespace millscope::geometry
