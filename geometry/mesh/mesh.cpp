#include "geometry/mesh/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "millscope/element.hpp"

namespace millscope::geometry {

namespace {

/// Sizes that a mill, a test rig or a part of one may have, m. Outside them the unit is wrong far more often than the mill is odd.
constexpr double kSmallest = 0.005, kLargest = 50;

void check_finite(const Soup& soup) {
  for (std::size_t i = 0; i < soup.corners.size(); ++i) {
    const Point& p = soup.corners[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    throw Refusal("triangle " + std::to_string(i / 3 + 1) +
                  " has a coordinate that is NaN or infinite: repair the mesh in the CAD program and export it again");
  }
}

void check_extent(const Soup& soup, const MeshOptions& options) {
  const double scale = options.placement.scale;
  const Point e = bounds_of(soup.corners).extent();
  const double in_file = std::max({e.x, e.y, e.z}), size = scale * in_file;
  if (size >= kSmallest && size <= kLargest) return;
  if (options.says_unit) {
    throw Refusal("its largest extent is " + std::to_string(size) +
                  " m in the unit that it states, but must be 0.005 m to 50 m: correct the " + "drawing's unit, or give a scale");
  }
  std::string better;
  for (const auto& [unit, metres] : {std::pair{"mm", 1e-3}, {"cm", 1e-2}, {"inch", 0.0254}, {"m", 1.0}}) {
    if (in_file * metres >= kSmallest && in_file * metres <= kLargest) better += std::string(better.empty() ? "" : ", ") + unit;
  }
  char text[400];
  std::snprintf(text, sizeof text,
                "its largest extent is %.4g m with this unit and scale, but must be %g m to %g m: check unit%s%s and scale", size,
                kSmallest, kLargest, better.empty() ? "" : " (it would fit in: ", better.empty() ? "" : (better + ")").c_str());
  throw Refusal(text);
}

void check_count(const Soup& soup, const MeshOptions& options) {
  const std::size_t total = soup.size() * as_size(options.placement.repeat) * (options.period > 0 ? 3 : 1);
  if (total <= options.max_triangles) return;
  throw Refusal(std::to_string(total) + " triangles after repeating exceed max_triangles = " + std::to_string(options.max_triangles) +
                ": export a coarser mesh or raise max_triangles");
}

void check_period(const IndexedMesh& mesh, double period) {
  if (!(period > 0)) return;
  std::vector<Point> own;
  for (std::size_t t = 0; t < mesh.own; ++t) {
    for (std::size_t k = 0; k < 3; ++k) own.push_back(mesh.vertex(t, k));
  }
  const double extent = bounds_of(own).extent().z;
  if (std::fabs(extent - period) < 0.01 * period) return;
  char text[240];
  std::snprintf(text, sizeof text,
                "period %.6g m is not the extent of the mesh along z, %.6g m: give the length of the slice, or leave period out", period,
                extent);
  throw Refusal(text);
}

Soup placed(Soup soup, const MeshOptions& options) {
  check_finite(soup);
  check_extent(soup, options);
  check_count(soup, options);
  place(soup, options.placement);
  return soup;
}

}  // namespace

Mesh::Mesh(Soup soup, const MeshOptions& options) {
  try {
    for (const std::string& name : soup.names) slots_ += slots_.empty() ? name : '|' + name;
    const std::vector<std::string> names = soup.names, notes = soup.notes;
    mesh_ = index_mesh(placed(std::move(soup), options), options.period);
    if (mesh_.own == 0) {
      throw Refusal("all " + std::to_string(mesh_.degenerate) +
                    " triangles are without area: export the body again, as a mesh in three dimensions");
    }
    check_period(mesh_, options.period);
    topology_ = find_topology(mesh_);
    survey_ = survey_mesh(mesh_, topology_);
    report_ = "file: " + options.label + "\n" + survey_text(survey_, mesh_, topology_, names);
    for (const std::string& note : notes) report_ += "note: " + note + "\n";
  } catch (const Refusal& e) {
    throw Refusal((options.says_unit ? "CAD file " : "mesh file ") + options.label + ": " + e.what());
  }
  Triangles triangles;
  triangles.planes.reserve(mesh_.triangles.size());
  triangles.records.reserve(mesh_.triangles.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) triangles.add(mesh_, t, topology_.patch[t]);
  contact_ = MeshContact(std::move(triangles), mesh_.weld);
  finder_ = std::make_unique<CandidateFinder>(contact_.triangles());
  face_the_beads();
}

/// The surface of an open shell that faces outwards is turned over: its beads are inside. Contact does not depend on it.
void Mesh::face_the_beads() {
  if (!survey_.interior.is_cylinder || survey_.closed || survey_.facing != Facing::outwards) return;
  for (Corners& c : mesh_.triangles) std::swap(c[1], c[2]);
}

Surface Mesh::surface() const {
  static_assert(sizeof(Point) == 3 * sizeof(double) && sizeof(Corners) == 3 * sizeof(std::uint32_t));
  return {mesh_.vertices.size(), &mesh_.vertices[0].x, mesh_.own, mesh_.triangles[0].data(), mesh_.slots.data()};
}

}  // namespace millscope::geometry
