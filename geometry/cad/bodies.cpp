#include <algorithm>
#include <cctype>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/TDF_LabelSequence.hxx>
#include <opencascade/TDataStd_Name.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS_Compound.hxx>

#include "geometry/cad/document.hpp"

namespace millscope::cad {

namespace {

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  std::string text(static_cast<std::size_t>(name->Get().LengthOfCString()), '\0');
  char* at = text.data();
  name->Get().ToUTF8CString(at);
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Of a label or a shape; the colour of surfaces goes before that of all.
template <class Labelled>
std::string colour_text(const Document& document, const Labelled& of) {
  Quantity_Color colour;
  if (!document.colours->GetColor(of, XCAFDoc_ColorSurf, colour) && !document.colours->GetColor(of, XCAFDoc_ColorGen, colour)) return {};
  std::string text = Quantity_Color::ColorToHex(colour, false).ToCString();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return "colour_" + text;
}

/// What the assemblies above say of a part.
struct Use {
  TopLoc_Location place;
  std::string name, colour;
};

class Walk {
 public:
  explicit Walk(const Document& document) : document_(document) {
    TDF_LabelSequence roots;
    document.shapes->GetFreeShapes(roots);
    for (int i = 1; i <= roots.Length(); ++i) visit(roots.Value(i), {});
  }
  std::vector<Body> bodies;

 private:
  void visit(const TDF_Label& label, Use use) {
    if (use.colour.empty()) use.colour = colour_text(document_, label);
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      TDF_Label part;
      XCAFDoc_ShapeTool::GetReferredShape(label, part);
      use.place = use.place * XCAFDoc_ShapeTool::GetLocation(label);
      use.name = name_of(label);
      return visit(part, std::move(use));
    }
    if (!XCAFDoc_ShapeTool::IsAssembly(label)) return add_part(label, use);
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetComponents(label, parts);
    for (int i = 1; i <= parts.Length(); ++i) visit(parts.Value(i), use);
  }

  void add_part(const TDF_Label& label, const Use& use) {
    const TopoDS_Shape part = XCAFDoc_ShapeTool::GetShape(label);
    const std::string own = name_of(label), name = own.empty() ? use.name : own;
    const std::size_t first = bodies.size();
    for (TopExp_Explorer at(part, TopAbs_SOLID); at.More(); at.Next()) {
      TDF_Label solid;
      const bool known = document_.shapes->FindSubShape(label, at.Current(), solid);
      bodies.push_back({known ? name_of(solid) : "", use.colour, at.Current(), use.place, true});
    }
    const bool single = bodies.size() == first + 1;
    for (std::size_t i = first; i < bodies.size(); ++i) {
      if (bodies[i].name.empty()) bodies[i].name = name.empty() || single ? name : name + "_" + std::to_string(i - first + 1);
    }
    add_free_faces(part, name, use);
  }

  void add_free_faces(const TopoDS_Shape& part, const std::string& name, const Use& use) {
    TopoDS_Compound faces;
    BRep_Builder builder;
    builder.MakeCompound(faces);
    bool any = false;
    for (TopExp_Explorer at(part, TopAbs_FACE, TopAbs_SOLID); at.More(); at.Next()) builder.Add(faces, at.Current()), any = true;
    if (any) bodies.push_back({name, use.colour, faces, use.place, false});
  }

  const Document& document_;
};

}  // namespace

std::vector<Body> bodies_of(const Document& document) { return Walk(document).bodies; }

std::string colour_of(const Document& document, const TopoDS_Shape& face) { return colour_text(document, face); }

}  // namespace millscope::cad
