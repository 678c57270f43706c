#include "geometry/shapes/box.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace millscope::geometry {

namespace {

constexpr const char* kFaceNames[6] = {"-x", "+x", "-y", "+y", "-z", "+z"};
constexpr const char* kSlotNames[6] = {"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};

void read_open(const std::string& text, bool (&open)[6]) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto* found = std::find(std::begin(kFaceNames), std::end(kFaceNames), word);
    if (found == std::end(kFaceNames))
      throw Refusal("box: open names the face '" + word + "': write a list of -x +x -y +y -z +z, such as \"+y -z\"");
    open[found - std::begin(kFaceNames)] = true;
  }
}

}  // namespace

Box::Box(const Parameters& parameters) {
  std::copy_n(parameters.vector("low"), 3, low_);
  std::copy_n(parameters.vector("high"), 3, high_);
  for (int axis = 0; axis < 3; ++axis) {
    if (low_[axis] < high_[axis] && std::isfinite(high_[axis] - low_[axis])) continue;
    char text[200];
    std::snprintf(text, sizeof text, "box: low %g m is not below high %g m along %c: exchange them or make the box thicker", low_[axis],
                  high_[axis], "xyz"[axis]);
    throw Refusal(text);
  }
  read_open(parameters.text("open"), open_);
  std::uint32_t next = 0;
  for (int face = 0; face < 6; ++face) {
    if (open_[face]) continue;
    if (!slots_.empty()) slots_ += '|';
    slots_ += kSlotNames[face];
    slot_[face] = next++;
    first_triangle_[face] = static_cast<std::uint32_t>(triangles_.triangle_count());
    add_face(face);
  }
  if (next == 0) throw Refusal("box: open names all six faces, nothing is left: leave at least one closed, or remove the box");
  report_ = shape_report("box", surface(), "open faces: " + (parameters.text("open").empty() ? "none" : parameters.text("open")) + "\n");
}

/// Corners of a face, counter-clockwise seen from the inside.
void Box::add_face(int face) {
  const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double at = face % 2 ? high_[axis] : low_[axis];
  const bool along_u[4] = {false, true, true, false}, along_v[4] = {false, false, true, true};
  std::uint32_t corner[4];
  for (int c = 0; c < 4; ++c) {
    const int k = face % 2 ? 3 - c : c;  // a high face looks down its axis
    double x[3];
    x[axis] = at;
    x[u] = along_u[k] ? high_[u] : low_[u];
    x[v] = along_v[k] ? high_[v] : low_[v];
    corner[c] = triangles_.add_vertex({x[0], x[1], x[2]});
  }
  triangles_.add_triangle({corner[0], corner[1], corner[2]}, slot_[face]);
  triangles_.add_triangle({corner[0], corner[2], corner[3]}, slot_[face]);
}

Interior Box::interior() const {
  Interior in{0, 1, {0, 0, 0}, {0, 0, 1}, 0, {0, 0, 0}, {0, 0, 0}};
  std::copy_n(low_, 3, in.low);
  std::copy_n(high_, 3, in.high);
  return in;
}

void Box::candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) const {
  for (std::int64_t i = 0; i < beads.count; ++i) {
    const double reach = beads.radius[i] + margin;
    for (std::uint32_t face = 0; face < 6; ++face) {
      const double x = beads.position[face / 2][i];
      const double distance = face % 2 ? high_[face / 2] - x : x - low_[face / 2];
      if (!open_[face] && distance < reach) sink.add(sink.host, i, face);
    }
  }
}

void Box::touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const {
  const double x[3] = {bead.position.x, bead.position.y, bead.position.z};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t face = candidates[i];
    const std::uint32_t axis = face / 2;
    const double inwards = face % 2 ? -1 : 1, depth = inwards * (x[axis] - (face % 2 ? high_[axis] : low_[axis]));
    double offset[3] = {0, 0, 0}, beyond = 0;  // from the rectangle to the centre, within its plane
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (k == axis) continue;
      offset[k] = x[k] - std::clamp(x[k], low_[k], high_[k]);
      const bool past_open = offset[k] != 0 && open_[2 * k + (offset[k] > 0 ? 1 : 0)];
      if (!past_open) offset[k] = 0;  // past a closed face: that face pushes back, this one goes on
      beyond += offset[k] * offset[k];
    }
    offset[axis] = inwards * depth;
    double distance = beyond > 0 ? std::sqrt(beyond + depth * depth) : depth;
    Point normal{axis == 0 ? inwards : 0, axis == 1 ? inwards : 0, axis == 2 ? inwards : 0};
    if (beyond > 0 && distance > 0) normal = (1 / distance) * Point{offset[0], offset[1], offset[2]};
    bool counted = false;  // two walls meet in a corner of the rim: one place, one contact
    for (int k = 0; k < out.count(); ++k) counted |= beyond > 0 && length(out[k].normal - normal) < 1e-9;
    if (!counted) out.add({bead.radius - distance, normal, face, first_triangle_[face], slot_[face]});
  }
}

}  // namespace millscope::geometry
