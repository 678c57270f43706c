#include "geometry/shapes/mill_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "millscope/element.hpp"
#include "millscope/parameters.hpp"

namespace millscope::geometry {

namespace {

[[noreturn]] void refuse(const char* format, double a, double b) {
  char text[512];
  std::snprintf(text, sizeof text, format, a, b);
  throw Refusal(text);
}

}  // namespace

MillProfile::MillProfile(const MillShape& shape) : shape_(shape) {
  const double r = shape.radius, h = shape.lifter_height;
  if (shape.lifters == 0) {
    bays_.push_back({std::cos(shape.phase + std::numbers::pi), std::sin(shape.phase + std::numbers::pi)});
    return;
  }
  if (!(h < r)) refuse("mill: lifter_height %g m reaches the axis of a shell of radius %g m: give less than the radius", h, r);
  if (!(shape.lifter_width < 2 * r)) {
    refuse("mill: lifter_width %g m is not below the diameter of %g m: give the width of one lifter at its base", shape.lifter_width,
           2 * r);
  }
  const double slope = std::cos(shape.face_angle) / std::sin(shape.face_angle);
  const double cotangent = std::fabs(slope) < 1e-12 ? 0.0 : slope;
  pitch_ = 2 * std::numbers::pi / shape.lifters;
  top_u_ = r - h;
  top_v_ = 0.5 * shape.lifter_width - h * cotangent;
  if (!(top_v_ > 0)) {
    refuse(
        "mill: with lifter_width %g m and lifter_height %g m the faces meet below the top: widen the base, lower the lifter or raise "
        "lifter_face_angle",
        shape.lifter_width, h);
  }
  const double norm = std::sqrt(1 + cotangent * cotangent);
  edge_u_ = 1 / norm;
  edge_v_ = cotangent / norm;
  // |T + s e| = R
  const double along = top_u_ * edge_u_ + top_v_ * edge_v_, excess = top_u_ * top_u_ + top_v_ * top_v_ - r * r;
  if (!(excess < 0)) {
    refuse("mill: the corners of a lifter %g m wide and %g m high lie outside the shell: give a narrower or higher lifter",
           shape.lifter_width, h);
  }
  face_length_ = -along + std::sqrt(along * along - excess);
  foot_u_ = top_u_ + face_length_ * edge_u_;
  foot_v_ = top_v_ + face_length_ * edge_v_;
  foot_angle_ = std::atan2(foot_v_, foot_u_);
  if (!(foot_angle_ < 0.5 * pitch_)) {
    refuse("mill: %g lifters of width %g m overlap each other on the shell: give fewer or narrower ones", shape.lifters,
           shape.lifter_width);
  }
  middle_u_ = 0.5 * (top_u_ + r);
  bounding_ = std::hypot(r - middle_u_, foot_v_) + 1e-12;
  bounding_ = std::max(bounding_, std::hypot(middle_u_ - top_u_, top_v_));
  bay_half_angle_ = 0.5 * pitch_ - foot_angle_;
  bay_cosine_ = std::cos(bay_half_angle_);
  bay_sine_ = std::sin(bay_half_angle_);
  for (int k = 0; k < shape.lifters; ++k) {
    const double middle = shape.phase + k * pitch_, between = middle + 0.5 * pitch_;
    lifters_.push_back({std::cos(middle), std::sin(middle)});
    bays_.push_back({std::cos(between), std::sin(between)});
  }
}

ProfilePlace MillProfile::place_on_shell(int k, double u, double v) const {
  const double half = shape_.lifters > 0 ? bay_half_angle_ : std::numbers::pi;
  return {k, Piece::shell, std::clamp(0.5 + 0.5 * std::atan2(v, u) / half, 0.0, 1.0)};
}

ProfilePlace MillProfile::place_on_lifter(int k, double u, double v, Piece piece) const {
  if (piece == Piece::top) return {k, piece, 0.5 + 0.5 * std::clamp(v / top_v_, -1.0, 1.0)};
  const double along = (u - top_u_) * edge_u_ + (std::fabs(v) - top_v_) * edge_v_, fraction = std::clamp(along / face_length_, 0.0, 1.0);
  return {k, piece, piece == Piece::rear_face ? 1 - fraction : fraction};
}

double MillProfile::lifter_area() const {
  if (shape_.lifters == 0) return 0;
  const double r = shape_.radius;
  const double segment = r * r * (foot_angle_ - std::sin(foot_angle_) * std::cos(foot_angle_));  // between chord and shell
  const double trapezoid = (foot_v_ + top_v_) * (foot_u_ - top_u_);
  return shape_.lifters * (trapezoid + segment);
}

}  // namespace millscope::geometry
