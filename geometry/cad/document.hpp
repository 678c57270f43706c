// What a STEP or IGES file holds, as OpenCASCADE has it, and its bodies with their names and colours.
#pragma once

#include <opencascade/TDocStd_Document.hxx>
#include <opencascade/TopLoc_Location.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <opencascade/XCAFDoc_ColorTool.hxx>
#include <opencascade/XCAFDoc_ShapeTool.hxx>
#include <string>
#include <vector>

namespace millscope::cad {

/// Lengths are mm, whatever the file has them in.
struct Document {
  Handle(TDocStd_Document) data;
  Handle(XCAFDoc_ShapeTool) shapes;
  Handle(XCAFDoc_ColorTool) colours;
  std::string unit;  ///< of the file: "inch"
};

/// Throws Refusal for a file that is cut short, damaged, or states no unit of length.
Document read_document(const std::string& path);

/// One solid, or the faces of a part that belong to no solid.
struct Body {
  std::string name;    ///< its own, or its part's; "" for none
  std::string colour;  ///< where the part is used, or the part's own: "colour_ff8000"; "" for none
  TopoDS_Shape shape;  ///< in the part's frame
  TopLoc_Location place;
  bool is_solid = true;
};

/// All bodies, a part that is used often as often.
std::vector<Body> bodies_of(const Document& document);

/// Of a face, as "colour_ff8000" (sRGB); "" for none.
std::string colour_of(const Document& document, const TopoDS_Shape& face);

}  // namespace millscope::cad
