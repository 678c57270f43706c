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
  if (first == std::string::npos) return {};
  text = text.substr(first, text.find_last_not_of(' ') - first + 1);
  return text == "NONE" ? std::string() : text;  // what some programs write for no name
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
  bool hidden = false;
};

class Walk {
 public:
  explicit Walk(const Document& document) : document_(document) {
    TDF_LabelSequence roots;
    document.shapes->GetFreeShapes(roots);
    for (int i = 1; i <= roots.Length(); ++i) visit(roots.Value(i), {});
  }
  Bodies found;

 private:
  void visit(const TDF_Label& label, Use use) {
    use.hidden = use.hidden || !document_.colours->IsVisible(label);
    const bool is_part = !XCAFDoc_ShapeTool::IsReference(label) && !XCAFDoc_ShapeTool::IsAssembly(label);
    if (is_part) return add_part(label, use);
    if (use.colour.empty()) use.colour = colour_text(document_, label);  // the outermost assembly has the last word
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      TDF_Label part;
      XCAFDoc_ShapeTool::GetReferredShape(label, part);
      use.place = use.place * XCAFDoc_ShapeTool::GetLocation(label);
      use.name = name_of(label);
      return visit(part, std::move(use));
    }
    TDF_LabelSequence parts;
    XCAFDoc_ShapeTool::GetComponents(label, parts);
    for (int i = 1; i <= parts.Length(); ++i) visit(parts.Value(i), use);
  }

  void add_part(const TDF_Label& label, const Use& use) {
    const TopoDS_Shape part = XCAFDoc_ShapeTool::GetShape(label);
    const std::string own = name_of(label), name = own.empty() ? use.name : own, colour = colour_text(document_, label);
    std::vector<Body>& all = found.all;
    const std::size_t first = all.size();
    for (TopExp_Explorer at(part, TopAbs_SOLID); at.More(); at.Next()) {
      TDF_Label solid;
      const bool known = document_.shapes->FindSubShape(label, at.Current(), solid);
      all.push_back({known ? name_of(solid) : "", use.colour, colour, at.Current(), use.place, true});
    }
    const bool single = all.size() == first + 1;
    for (std::size_t i = first; i < all.size(); ++i) {
      if (all[i].name.empty()) all[i].name = name.empty() || single ? name : name + "_" + std::to_string(i - first + 1);
    }
    TopoDS_Compound free;
    if (free_faces(part, free)) all.push_back({name, use.colour, colour, free, use.place, false});
    if (all.size() == first) ++found.without_faces;
    if (use.hidden) found.hidden += all.size() - first;
  }

  static bool free_faces(const TopoDS_Shape& part, TopoDS_Compound& faces) {
    BRep_Builder builder;
    builder.MakeCompound(faces);
    bool any = false;
    for (TopExp_Explorer at(part, TopAbs_FACE, TopAbs_SOLID); at.More(); at.Next()) builder.Add(faces, at.Current()), any = true;
    return any;
  }

  const Document& document_;
};

}  // namespace

Bodies bodies_of(const Document& document) { return Walk(document).found; }

std::string colour_of(const Document& document, const TopoDS_Shape& shape) { return colour_text(document, shape); }

}  // namespace millscope::cad
