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
  std::string unit;                ///< of the file: "inch"
  std::vector<std::string> notes;  ///< what the reader warns of
};

/// Throws Refusal for a file that is cut short, has a body or a face that is not understood, refers to other files, or states no unit.
Document read_document(const std::string& path);

/// One solid, or the faces of a part that belong to no solid.
struct Body {
  std::string name;         ///< its own, or its part's; "" for none
  std::string use_colour;   ///< that an assembly gives to this use of the part: "colour_ff8000"; "" for none
  std::string part_colour;  ///< of the part
  TopoDS_Shape shape;       ///< in the part's frame
  TopLoc_Location place;
  bool is_solid = true;
};

struct Bodies {
  std::vector<Body> all;          ///< a part that is used often as often
  std::size_t hidden = 0;         ///< of these, not shown by the program that drew them
  std::size_t without_faces = 0;  ///< parts of lines and points alone, which are not in `all`
};
Bodies bodies_of(const Document& document);

/// Of a face or a solid by itself, as "colour_ff8000" (sRGB); "" for none.
std::string colour_of(const Document& document, const TopoDS_Shape& shape);

}  // namespace millscope::cad
