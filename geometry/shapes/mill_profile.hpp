// Cross-section of a mill: a circular shell with trapezoid lifters, and the exact contact of a circle with it.
//
//   u, v       frame of one lifter: u from the axis through the middle of the lifter, v across it (counter-clockwise)
//   R          inner radius of the bare shell, m
//   h, w, a    lifter height, width at its base, angle between face and base (m, m, rad)
//   T = (R − h, w/2 − h/tan a)              top corner, convex: a bead may hang on it
//   F = T + s (1, cot a), |F| = R           foot, concave: a bead touches face and shell there, never the foot itself
//   e = (1, cot a)/|…|, n = (−e_v, e_u)     direction of a face (top to foot) and its normal, towards the beads
//
// A lifter is convex, so a bead touches each lifter once: at the place nearest to its centre. The shell is concave, one touch.
#pragma once

#include <cstdint>
#include <vector>

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

/// A place where a circle touches the outline.
struct ProfileContact {
  double overlap;
  double normal[2];  ///< unit, towards the centre of the circle
  int sector;        ///< lifter number; for the shell, the bay that follows this lifter
  Piece piece;
  double fraction;  ///< place along the piece, counter-clockwise, 0…1
};

inline constexpr int kMaxProfileContacts = 4;  // shell + own lifter + one on each side

class MillProfile {
 public:
  /// Refuses shapes that cannot be built (lifters that overlap or come to a point).
  explicit MillProfile(const MillShape& shape);

  /// Contacts of a circle with overlap > −reach; returns their number.
  int touch(const double (&centre)[2], double radius, double reach, ProfileContact (&out)[kMaxProfileContacts]) const;

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
  struct Folded {
    double u, v;
    int sector;
  };
  Folded fold(double x, double y) const;
  Folded in_sector(double x, double y, int sector) const;
  bool touch_lifter(const Folded& p, double radius, double reach, ProfileContact* out) const;
  bool touch_shell(const Folded& p, double radius, double reach, ProfileContact* out) const;
  double shell_fraction(const Folded& p) const;

  MillShape shape_;
  double pitch_ = 0;                    // angle from lifter to lifter, rad
  double top_u_ = 0, top_v_ = 0;        // T
  double foot_u_ = 0, foot_v_ = 0;      // F
  double edge_u_ = 1, edge_v_ = 0;      // e
  double face_length_ = 0;              // |F − T|
  double foot_angle_ = 0;               // of F from the middle of the lifter
  double middle_u_ = 0, bounding_ = 0;  // circle round the lifter, for the neighbours
  std::vector<double> cosine_, sine_;   // of each sector's middle
};

}  // namespace millscope::geometry
