#include "geometry/cad/document.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <opencascade/IGESCAFControl_Reader.hxx>
#include <opencascade/IGESData_IGESModel.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/STEPCAFControl_Reader.hxx>
#include <opencascade/TColStd_SequenceOfAsciiString.hxx>
#include <opencascade/XCAFApp_Application.hxx>
#include <opencascade/XCAFDoc_DocumentTool.hxx>
#include <opencascade/XSControl_WorkSession.hxx>
#include <set>

#include "millscope/parameters.hpp"

namespace millscope::cad {

namespace {

bool is_iges(const std::string& path) { return std::tolower(static_cast<unsigned char>(path.at(path.find_last_of('.') + 1))) == 'i'; }

void check_iges(const std::string& text) {
  const std::size_t line = text.find_first_of("\r\n");
  if (line == std::string::npos || line < 73 || text[72] != 'S')
    throw Refusal("its first line has no S in column 73, as IGES must have: it is something else, or compressed; export it again");
  const std::size_t last = text.find_last_not_of("\r\n \t");
  const std::size_t begin = text.find_last_of("\r\n", last) + 1;
  if (text.size() < begin + 73 || text[begin + 72] != 'T') throw Refusal("has no last line (T): the file is cut short, export it again");
}

void check_step(const std::string& text) {
  if (text.substr(0, 2000).find("ISO-10303-21") == std::string::npos)
    throw Refusal("does not begin with ISO-10303-21, as STEP must: it is something else, or compressed (.stpz); export it again as STEP");
  if (text.find("END-ISO-10303-21", text.size() - std::min<std::size_t>(text.size(), 4000)) == std::string::npos)
    throw Refusal("has no END-ISO-10303-21: the file is cut short, export it again");
}

/// The library takes a file that is cut short for a short one.
void check_ends(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Refusal("cannot be read: check its permissions");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  is_iges(path) ? check_iges(text) : check_step(text);
}

template <class Reader>
void read_into(Reader& reader, const std::string& path, const char* format, Handle(TDocStd_Document) & document) {
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  if (reader.ReadFile(path.c_str()) == IFSelect_RetDone && reader.Transfer(document)) return;
  throw Refusal(std::string("cannot be read as ") + format + ": it is damaged, or holds no bodies; export it again");
}

std::string read_step(const std::string& path, Handle(TDocStd_Document) & document) {
  Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
  STEPCAFControl_Reader reader;
  read_into(reader, path, "STEP", document);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  std::set<std::string> units;
  for (int i = 1; i <= lengths.Length(); ++i) units.insert(lengths.Value(i).ToCString());
  std::string all;
  for (const std::string& unit : units) all += (all.empty() ? "" : ", ") + unit;
  return all;
}

/// The names that IGES 5.3 gives its flags, section 2.2.4.3.14.
std::string read_iges(const std::string& path, Handle(TDocStd_Document) & document) {
  IGESCAFControl_Reader reader;
  read_into(reader, path, "IGES", document);
  const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.WS()->Model());
  if (model.IsNull()) return {};
  const char* const names[] = {"inch",      "millimetre", "",           "foot",       "mile",     "metre",
                               "kilometre", "mil",        "micrometre", "centimetre", "microinch"};
  const int flag = model->GlobalSection().UnitFlag();
  if (flag >= 1 && flag <= 11 && flag != 3) return names[flag - 1];
  const Handle(TCollection_HAsciiString) name = model->GlobalSection().UnitName();
  return name.IsNull() ? std::string() : name->ToCString();
}

}  // namespace

Document read_document(const std::string& path) {
  check_ends(path);
  Document document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document.data);
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  document.unit = is_iges(path) ? read_iges(path, document.data) : read_step(path, document.data);
  if (document.unit.empty())
    throw Refusal("states no unit of length: export it again with one, or export a mesh and write 'kind: mesh' with its unit");
  document.shapes = XCAFDoc_DocumentTool::ShapeTool(document.data->Main());
  document.colours = XCAFDoc_DocumentTool::ColorTool(document.data->Main());
  return document;
}

}  // namespace millscope::cad
