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
  if (shape.lifters == 0) return;
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
  for (int k = 0; k < shape.lifters; ++k) {
    cosine_.push_back(std::cos(shape.phase + k * pitch_));
    sine_.push_back(std::sin(shape.phase + k * pitch_));
  }
}

MillProfile::Folded MillProfile::in_sector(double x, double y, int sector) const {
  const auto k = as_size(sector);
  return {x * cosine_[k] + y * sine_[k], y * cosine_[k] - x * sine_[k], sector};
}

MillProfile::Folded MillProfile::fold(double x, double y) const {
  const double turns = (std::atan2(y, x) - shape_.phase) / pitch_;
  const int n = shape_.lifters;
  const int sector = static_cast<int>(std::lround(turns)) % n;
  return in_sector(x, y, sector < 0 ? sector + n : sector);
}

double MillProfile::shell_fraction(const Folded& p) const {
  const double angle = std::atan2(p.v, p.u);  // from the middle of this lifter
  const double start = p.v >= 0 ? foot_angle_ : foot_angle_ - pitch_;
  return std::clamp((angle - start) / (pitch_ - 2 * foot_angle_), 0.0, 1.0);
}

bool MillProfile::touch_shell(const Folded& p, double radius, double reach, ProfileContact* out) const {
  const double distance = std::sqrt(p.u * p.u + p.v * p.v);
  const double overlap = radius + distance - shape_.radius;
  if (!(overlap > -reach)) return false;
  if (std::fabs(p.v) * foot_u_ < foot_v_ * p.u) return false;  // a lifter stands there; its foot is concave
  *out = {overlap, {0, 0}, p.sector, Piece::shell, shell_fraction(p)};
  out->normal[0] = distance > 0 ? -p.u / distance : -1;
  out->normal[1] = distance > 0 ? -p.v / distance : 0;
  if (p.v < 0) out->sector = (p.sector + shape_.lifters - 1) % shape_.lifters;
  return true;
}

/// Nearest place of one lifter, in its own frame mirrored to v ≥ 0.
bool MillProfile::touch_lifter(const Folded& p, double radius, double reach, ProfileContact* out) const {
  const double side = p.v < 0 ? -1 : 1, v = std::fabs(p.v);
  const double du = p.u - top_u_, dv = v - top_v_;
  const double along = du * edge_u_ + dv * edge_v_, height = dv * edge_u_ - du * edge_v_;
  const bool inside = du > 0 && height < 0;
  const Piece face = p.v < 0 ? Piece::rear_face : Piece::front_face;
  double distance = 0, fraction = 0;
  Piece piece = Piece::top;
  double normal[2] = {-1, 0};
  if ((du <= 0 && dv <= 0) || (inside && du < -height)) {
    distance = -du;
    fraction = 0.5 + 0.5 * std::clamp(p.v / top_v_, -1.0, 1.0);
  } else if (inside || (along > 0 && along < face_length_)) {
    distance = height;
    normal[0] = -edge_v_, normal[1] = side * edge_u_;
    piece = face;
    fraction = std::clamp(along / face_length_, 0.0, 1.0);
    if (face == Piece::rear_face) fraction = 1 - fraction;
  } else if (along <= 0) {
    distance = std::sqrt(du * du + dv * dv);
    if (distance > 0) normal[0] = du / distance, normal[1] = side * dv / distance;
    fraction = p.v < 0 ? 0 : 1;
  } else {
    return false;  // the foot: concave, never touched by itself
  }
  if (!(radius - distance > -reach)) return false;
  *out = {radius - distance, {normal[0], normal[1]}, p.sector, piece, fraction};
  return true;
}

int MillProfile::touch(const double (&centre)[2], double radius, double reach, ProfileContact (&out)[kMaxProfileContacts]) const {
  const double x = centre[0], y = centre[1];
  if (shape_.lifters == 0) {
    const double distance = std::sqrt(x * x + y * y);
    if (!(radius + distance - shape_.radius > -reach)) return 0;
    const double turn = distance > 0 ? (std::atan2(y, x) - shape_.phase) / (2 * std::numbers::pi) : 0;
    out[0] = {radius + distance - shape_.radius, {-1, 0}, 0, Piece::shell, turn - std::floor(turn)};
    if (distance > 0) out[0].normal[0] = -x / distance, out[0].normal[1] = -y / distance;
    return 1;
  }
  const double safe = top_u_ - radius - reach;
  if (safe > 0 && x * x + y * y < safe * safe) return 0;
  const Folded own = fold(x, y);
  int count = 0;
  const auto keep = [&](bool touched, int sector) {  // back from the lifter's frame to the mill's
    if (!touched) return;
    const auto k = as_size(sector);
    const double u = out[count].normal[0], v = out[count].normal[1];
    out[count].normal[0] = u * cosine_[k] - v * sine_[k];
    out[count].normal[1] = u * sine_[k] + v * cosine_[k];
    ++count;
  };
  keep(touch_shell(own, radius, reach, &out[count]), own.sector);
  keep(touch_lifter(own, radius, reach, &out[count]), own.sector);
  const int n = shape_.lifters;
  const int sides[2] = {(own.sector + 1) % n, (own.sector + n - 1) % n};
  for (int s = 0; s < std::min(2, n - 1); ++s) {
    const Folded p = in_sector(x, y, sides[s]);
    const double limit = radius + reach + bounding_, du = p.u - middle_u_;
    if (du * du + p.v * p.v < limit * limit) keep(touch_lifter(p, radius, reach, &out[count]), sides[s]);
  }
  return count;
}

double MillProfile::lifter_area() const {
  if (shape_.lifters == 0) return 0;
  const double r = shape_.radius;
  const double segment = r * r * (foot_angle_ - std::sin(foot_angle_) * std::cos(foot_angle_));  // between chord and shell
  const double trapezoid = (foot_v_ + top_v_) * (foot_u_ - top_u_);
  return shape_.lifters * (trapezoid + segment);
}

}  // namespace millscope::geometry
