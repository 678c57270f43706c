#include "geometry/shapes/mill_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

int cuts(double length, double facet) { return std::max(1, static_cast<int>(std::ceil(length / facet - 1e-9))); }

}  // namespace

MillSurface::MillSurface(const MillProfile& profile, const MillSlots& slots, double facet, int rows) : profile_(profile), rows_(rows) {
  const MillShape& shape = profile.shape();
  const double full = 2 * std::numbers::pi;
  if (shape.lifters > 0) {
    face_cuts_ = cuts(profile.face_length(), facet);
    top_cuts_ = cuts(2 * profile.top_half_width(), facet);
    shell_cuts_ = cuts((full / shape.lifters - 2 * profile.foot_angle()) * shape.radius, facet);
  } else {
    shell_cuts_ = std::max(8, cuts(full * shape.radius, facet));
  }
  build_outline();
  add_walls(slots);
  if (slots.end) {
    add_end_face(*slots.end, false);
    add_end_face(*slots.end, true);
  }
}

void MillSurface::add_point(double x, double y, Piece piece) {
  outline_.push_back(x);
  outline_.push_back(y);
  pieces_.push_back(piece);
}

/// Points from `from` up to, not including, `to`: the next piece brings that one.
void MillSurface::add_piece(const double (&from)[2], const double (&to)[2], Piece piece) {
  const int n = piece == Piece::top ? top_cuts_ : face_cuts_;
  for (int i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / n;
    add_point(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), piece);
  }
}

void MillSurface::add_arc(double from, double to) {
  const double r = profile_.shape().radius;
  for (int i = 0; i < shell_cuts_; ++i) {
    const double angle = from + (to - from) * i / shell_cuts_;
    add_point(r * std::cos(angle), r * std::sin(angle), Piece::shell);
  }
}

void MillSurface::build_outline() {
  const MillShape& shape = profile_.shape();
  const double full = 2 * std::numbers::pi;
  if (shape.lifters == 0) return add_arc(shape.phase, shape.phase + full);
  const double top_u = profile_.free_radius(), top_v = profile_.top_half_width();
  for (int k = 0; k < shape.lifters; ++k) {
    const double middle = shape.phase + full * k / shape.lifters, c = std::cos(middle), s = std::sin(middle);
    const double corner[4][2] = {
        {profile_.foot_u(), -profile_.foot_v()}, {top_u, -top_v}, {top_u, top_v}, {profile_.foot_u(), profile_.foot_v()}};
    double turned[4][2];
    for (int i = 0; i < 4; ++i) {
      turned[i][0] = corner[i][0] * c - corner[i][1] * s;
      turned[i][1] = corner[i][0] * s + corner[i][1] * c;
    }
    add_piece(turned[0], turned[1], Piece::rear_face);
    add_piece(turned[1], turned[2], Piece::top);
    add_piece(turned[2], turned[3], Piece::front_face);
    add_arc(middle + profile_.foot_angle(), middle + full / shape.lifters - profile_.foot_angle());
  }
}

void MillSurface::add_walls(const MillSlots& slots) {
  const std::size_t n = pieces_.size();
  for (int row = 0; row <= rows_; ++row) {
    const double z = profile_.shape().length * row / rows_;
    for (std::size_t i = 0; i < n; ++i) triangles_.add_vertex({outline_[2 * i], outline_[2 * i + 1], z});
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t material = pieces_[i] == Piece::shell ? slots.shell : *slots.lifter;
    for (std::size_t row = 0; row < as_size(rows_); ++row) {
      const auto a = static_cast<std::uint32_t>(row * n + i), b = static_cast<std::uint32_t>(row * n + (i + 1) % n);
      const auto up = static_cast<std::uint32_t>(n);
      triangles_.add_triangle({a, b + up, b}, material);
      triangles_.add_triangle({a, a + up, b + up}, material);
    }
  }
}

/// Where on the line from the axis to the middle of a bay the fan of the bay starts: it must see both lifter faces from the front.
double MillSurface::fan_fraction() const {
  const MillShape& shape = profile_.shape();
  if (shape.lifters < 3) return 0;
  const double half = std::numbers::pi / shape.lifters, r = shape.radius, top_u = profile_.free_radius(), top_v = profile_.top_half_width();
  const double edge_u = (profile_.foot_u() - top_u) / profile_.face_length(), edge_v = (profile_.foot_v() - top_v) / profile_.face_length();
  for (const double fraction : {0.0, 0.5, 0.7, 0.9}) {
    const double u = fraction * r * std::cos(half), v = fraction * r * std::sin(half);
    if ((v - top_v) * edge_u - (u - top_u) * edge_v > 1e-3 * r) return fraction;
  }
  return 0.97;
}

/// Fans: from the axis over the tops of the lifters, and over each bay from a point that sees all of it.
void MillSurface::add_end_face(std::uint32_t material, bool at_top) {
  const auto n = static_cast<std::uint32_t>(pieces_.size());
  const MillShape& shape = profile_.shape();
  const std::uint32_t base = at_top ? n * static_cast<std::uint32_t>(rows_) : 0;
  const double z = at_top ? shape.length : 0;
  const std::uint32_t axis = triangles_.add_vertex({0, 0, z});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (at_top) std::swap(b, c);
    triangles_.add_triangle({a, b, c}, material);
  };
  const double fraction = fan_fraction();
  if (fraction == 0) {
    for (std::uint32_t i = 0; i < n; ++i) add(axis, base + i, base + (i + 1) % n);
    return;
  }
  const auto face = static_cast<std::uint32_t>(face_cuts_), top = static_cast<std::uint32_t>(top_cuts_);
  const std::uint32_t per_lifter = n / static_cast<std::uint32_t>(shape.lifters), bay = per_lifter - top;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(shape.lifters); ++k) {
    const double middle = shape.phase + 2 * std::numbers::pi * (k + 0.5) / shape.lifters;
    const std::uint32_t hub =
        triangles_.add_vertex({fraction * shape.radius * std::cos(middle), fraction * shape.radius * std::sin(middle), z});
    const std::uint32_t first = k * per_lifter + face;
    for (std::uint32_t i = 0; i < top; ++i) add(axis, base + (first + i) % n, base + (first + i + 1) % n);
    for (std::uint32_t i = top; i < top + bay; ++i) add(hub, base + (first + i) % n, base + (first + i + 1) % n);
    add(hub, axis, base + (first + top) % n);
    add(hub, base + (first + top + bay) % n, axis);
  }
}

std::uint32_t MillSurface::triangle_at(const ProfilePlace& at, double z) const {
  const int start[4] = {0, face_cuts_, face_cuts_ + top_cuts_, 2 * face_cuts_ + top_cuts_};
  const int count[4] = {face_cuts_, top_cuts_, face_cuts_, shell_cuts_};
  const auto piece = as_size(at.piece);
  const double place = at.fraction * count[piece], height = std::clamp(z / profile_.shape().length, 0.0, 1.0) * rows_;
  const int chord = std::min(static_cast<int>(place), count[piece] - 1), row = std::min(static_cast<int>(height), rows_ - 1);
  const int segment = at.sector * (start[3] + shell_cuts_) + start[piece] + chord;
  return static_cast<std::uint32_t>(2 * (segment * rows_ + row) + (place - chord >= height - row ? 0 : 1));
}

}  // namespace millscope::geometry
