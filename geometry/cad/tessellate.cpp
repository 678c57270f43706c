#include "geometry/cad/tessellate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <opencascade/BRepBuilderAPI_Sewing.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/BRepMesh_IncrementalMesh.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Face.hxx>

#include "millscope/parameters.hpp"

namespace millscope::cad {

namespace {

double area_of(const double* corners) {
  double u[3], v[3];
  for (int k = 0; k < 3; ++k) u[k] = corners[3 + k] - corners[k], v[k] = corners[6 + k] - corners[k];
  return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

/// Faces nearer to each other than this share their edges from then on, mm: what programs leave between the faces of one body.
constexpr double kSewing = 0.02;

/// The library's own bound of the distance is exceeded twofold on a sphere; of the angle it is not.
constexpr double kPartOfChord = 0.5;

class Tessellator {
 public:
  Tessellator(const Document& document, const Request& request) : document_(document), request_(request) {}

  void add_all(const Bodies& bodies) {
    hidden_ = bodies.hidden, without_faces_ = bodies.without_faces;
    BRepBuilderAPI_Sewing sewing(std::min(kSewing, 0.5 * request_.chord));
    for (const Body& body : bodies.all) {
      body.is_solid ? ++solids_ : ++surfaces_;
      if (body.is_solid) {
        cut(body.shape);
        for (TopExp_Explorer at(body.shape, TopAbs_FACE); at.More(); at.Next()) add_face(body, at.Current(), at.Current(), body.place);
      } else {
        for (TopExp_Explorer at(body.shape, TopAbs_FACE); at.More(); at.Next()) sewing.Add(at.Current().Moved(body.place));
      }
    }
    if (surfaces_ > 0) add_open(bodies, sewing);
  }

  geometry::Solids result() {
    if (faces_ == 0) throw Refusal("holds no faces: export the body, not a drawing or a wire frame");
    if (uncut_ > 0) {
      throw Refusal(std::to_string(uncut_) + " of " + std::to_string(faces_) +
                    " faces cannot be cut into triangles: heal the body in the CAD program, or export it from there as STL");
    }
    geometry::Solids out;
    out.single_precision = false;
    for (auto& [name, corners] : corners_) out.solids.push_back({name, std::move(corners)});
    char text[400];
    std::snprintf(text, sizeof text,
                  "cut from CAD faces with a chord of %.4g mm and an angle of %.3g rad; the file's unit: %s; %zu solids, %zu open parts, "
                  "%zu faces; area of the faces %.6g m², of their triangles %.6g m²",
                  request_.chord, request_.angle, document_.unit.c_str(), solids_, surfaces_, faces_, 1e-6 * exact_area_, 1e-6 * cut_area_);
    out.notes.emplace_back(text);
    if (hidden_ > 0) out.notes.push_back("bodies hidden in the drawing, used all the same: " + std::to_string(hidden_));
    if (without_faces_ > 0) out.notes.push_back("parts without faces, left out: " + std::to_string(without_faces_));
    out.notes.insert(out.notes.end(), document_.notes.begin(), document_.notes.end());
    return out;
  }

 private:
  void cut(const TopoDS_Shape& shape) const {
    BRepMesh_IncrementalMesh(shape, kPartOfChord * request_.chord, false, request_.angle, false);
  }

  /// Faces that belong to no solid, whichever part they are of: cut one by one they would have different points along their edges.
  void add_open(const Bodies& bodies, BRepBuilderAPI_Sewing& sewing) {
    sewing.Perform();
    cut(sewing.SewedShape());
    for (const Body& body : bodies.all) {
      if (body.is_solid) continue;
      for (TopExp_Explorer at(body.shape, TopAbs_FACE); at.More(); at.Next()) {
        const TopoDS_Shape face = at.Current().Moved(body.place);
        add_face(body, at.Current(), sewing.IsModifiedSubShape(face) ? sewing.ModifiedSubShape(face) : face, {});
      }
    }
  }

  std::string slot(const Body& body, const TopoDS_Shape& face) const {
    if (!request_.by_colour) return body.name;
    if (!body.use_colour.empty()) return body.use_colour;
    for (const TopoDS_Shape& shape : {face, body.shape}) {
      const std::string colour = colour_of(document_, shape);
      if (!colour.empty()) return colour;
    }
    return body.part_colour.empty() ? "no_colour" : body.part_colour;
  }

  void add_face(const Body& body, const TopoDS_Shape& original, const TopoDS_Shape& shape, const TopLoc_Location& where) {
    const TopoDS_Face face = TopoDS::Face(shape);
    ++faces_;
    GProp_GProps surface;
    BRepGProp::SurfaceProperties(face, surface);
    exact_area_ += std::fabs(surface.Mass());
    TopLoc_Location in_part;
    const Handle(Poly_Triangulation) cut = BRep_Tool::Triangulation(face, in_part);
    if (cut.IsNull()) {
      ++uncut_;
      return;
    }
    triangles_ += static_cast<std::size_t>(cut->NbTriangles());
    if (triangles_ > request_.max_triangles) {
      throw Refusal("more than " + std::to_string(request_.max_triangles) +
                    " triangles (max_triangles): raise chord and angle (half a millimetre of chord is plenty for 5 mm beads)");
    }
    std::vector<double>& out = corners_[slot(body, original)];
    const gp_Trsf place = (where * in_part).Transformation();
    const bool turned = (face.Orientation() == TopAbs_REVERSED) != place.IsNegative();
    for (int t = 1; t <= cut->NbTriangles(); ++t) {
      int corner[3];
      cut->Triangle(t).Get(corner[0], corner[1], corner[2]);
      if (turned) std::swap(corner[1], corner[2]);
      for (const int k : corner) {
        const gp_Pnt p = cut->Node(k).Transformed(place);
        out.insert(out.end(), {p.X(), p.Y(), p.Z()});
      }
      cut_area_ += area_of(out.data() + out.size() - 9);
    }
  }

  const Document& document_;
  const Request& request_;
  std::map<std::string, std::vector<double>> corners_;
  std::size_t faces_ = 0, uncut_ = 0, triangles_ = 0, solids_ = 0, surfaces_ = 0, hidden_ = 0, without_faces_ = 0;
  double exact_area_ = 0, cut_area_ = 0;  // mm²
};

}  // namespace

geometry::Solids tessellate(const Document& document, const Request& request) {
  Tessellator tessellator(document, request);
  tessellator.add_all(bodies_of(document));
  return tessellator.result();
}

}  // namespace millscope::cad
