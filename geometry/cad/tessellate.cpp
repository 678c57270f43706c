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

class Tessellator {
 public:
  Tessellator(const Document& document, const Request& request) : document_(document), request_(request) {}

  void add(const Body& body) {
    body.is_solid ? ++solids_ : ++surfaces_;
    BRepBuilderAPI_Sewing sewing(0.5 * request_.chord);
    TopoDS_Shape shape = body.shape;
    if (!body.is_solid) {  // faces that share no edges would be cut at different points along them
      sewing.Add(body.shape);
      sewing.Perform();
      shape = sewing.SewedShape();
    }
    BRepMesh_IncrementalMesh(shape, request_.chord, false, request_.angle, false);
    for (TopExp_Explorer at(body.shape, TopAbs_FACE); at.More(); at.Next()) {
      const bool sewn = !body.is_solid && sewing.IsModifiedSubShape(at.Current());
      add_face(body, at.Current(), TopoDS::Face(sewn ? sewing.ModifiedSubShape(at.Current()) : at.Current()));
    }
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
    return out;
  }

 private:
  std::string slot(const Body& body, const TopoDS_Shape& face) const {
    if (!request_.by_colour) return body.name;
    for (const std::string& colour : {colour_of(document_, face), colour_of(document_, body.shape), body.colour}) {
      if (!colour.empty()) return colour;
    }
    return "no_colour";
  }

  void add_face(const Body& body, const TopoDS_Shape& original, const TopoDS_Face& face) {
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
    const gp_Trsf place = (body.place * in_part).Transformation();
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
  std::size_t faces_ = 0, uncut_ = 0, triangles_ = 0, solids_ = 0, surfaces_ = 0;
  double exact_area_ = 0, cut_area_ = 0;  // mm²
};

}  // namespace

geometry::Solids tessellate(const Document& document, const Request& request) {
  Tessellator tessellator(document, request);
  for (const Body& body : bodies_of(document)) tessellator.add(body);
  return tessellator.result();
}

}  // namespace millscope::cad
