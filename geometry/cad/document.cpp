#include "geometry/cad/document.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <opencascade/IGESCAFControl_Reader.hxx>
#include <opencascade/IGESData_IGESModel.hxx>
#include <opencascade/Interface_Check.hxx>
#include <opencascade/Interface_CheckIterator.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/STEPCAFControl_ExternFile.hxx>
#include <opencascade/STEPCAFControl_Reader.hxx>
#include <opencascade/TColStd_SequenceOfAsciiString.hxx>
#include <opencascade/Transfer_TransientProcess.hxx>
#include <opencascade/XCAFApp_Application.hxx>
#include <opencascade/XCAFDoc_DocumentTool.hxx>
#include <opencascade/XSControl_TransferReader.hxx>
#include <opencascade/XSControl_WorkSession.hxx>
#include <set>
#include <utility>

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

/// What the library complains of, of damaged entities and of faces that it passed over. It then goes on with what is left, which is no
/// longer the body that was drawn.
void check_reading(const Interface_CheckIterator& all, bool strict, std::vector<std::string>& notes) {
  std::size_t complaints = 0;
  std::string first;
  for (Interface_CheckIterator at = all; at.More(); at.Next()) {
    const Handle(Interface_Check) check = at.Value();
    if (check->NbFails() > 0 && strict)
      throw Refusal(std::string("has a part that is not understood ('") + check->CFail(1) + "'): heal it and export it again");
    for (int i = 1; i <= check->NbFails() + check->NbWarnings(); ++i) {
      const std::string text = i <= check->NbFails() ? check->CFail(i) : check->CWarning(i - check->NbFails());
      if (text.find("not mapped") != std::string::npos)
        throw Refusal("has a face that is not understood ('" + text + "'): heal the body and export it again");
      if (text.find("default unit") != std::string::npos)
        throw Refusal(
            "has bodies without a unit of length: export it again with one, or export a mesh and write 'kind: mesh' with its unit");
      if (complaints++ == 0) first = text;
    }
  }
  if (complaints > 0) notes.push_back("the reader complains of entities: " + std::to_string(complaints) + "; the first: " + first);
}

template <class Reader>
void read_file(Reader& reader, const std::string& path, const char* format) {
  reader.SetNameMode(true);
  reader.SetColorMode(true);
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    throw Refusal(std::string("cannot be read as ") + format + ": it is damaged; export it again");
}

/// Entities of IGES that are not understood are often notes and views, so they are told; what is lost of bodies shows in the transfer.
template <class Session>
void check_session(const Session& session, bool is_step, std::vector<std::string>& notes) {
  Interface_CheckIterator load = session->ModelCheckList(), transfer = session->TransferReader()->TransientProcess()->CheckList(false);
  load.Start(), transfer.Start();
  check_reading(load, is_step, notes);
  check_reading(transfer, true, notes);
}

constexpr const char* kNoBodies = "holds no bodies: export the body, not a drawing";

void read_step(const std::string& path, Document& document) {
  STEPCAFControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
  read_file(reader, path, "STEP");
  if (!reader.Transfer(document.data)) throw Refusal(kNoBodies);
  if (!reader.ExternFiles().IsEmpty()) {
    throw Refusal(
        std::string("refers to other files (") +
        NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator(reader.ExternFiles()).Key().ToCString() +
        "): export it as one file");
  }
  check_session(reader.ChangeReader().WS(), true, document.notes);
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
  std::set<std::string> units;
  for (int i = 1; i <= lengths.Length(); ++i) units.insert(lengths.Value(i).ToCString());
  for (const std::string& unit : units) document.unit += (document.unit.empty() ? "" : ", ") + unit;
}

/// Flags and names of units: IGES 5.3, section 2.2.4.3.14. A flag of 3 leaves the unit to its name.
std::string unit_of(const IGESData_GlobalSection& global) {
  constexpr std::pair<const char*, const char*> kUnits[] = {{"IN", "inch"},       {"MM", "millimetre"}, {"", ""},
                                                            {"FT", "foot"},       {"MI", "mile"},       {"M", "metre"},
                                                            {"KM", "kilometre"},  {"MIL", "mil"},       {"UM", "micrometre"},
                                                            {"CM", "centimetre"}, {"UIN", "microinch"}};
  const int flag = global.UnitFlag();
  if (flag >= 1 && flag <= 11 && flag != 3) return kUnits[flag - 1].second;
  const std::string name = global.UnitName().IsNull() ? "" : global.UnitName()->ToCString();
  for (const auto& [short_name, unit] : kUnits) {
    if (!name.empty() && (name == short_name || (name == "INCH" && unit == kUnits[0].second))) return unit;
  }
  return {};
}

void read_iges(const std::string& path, Document& document) {
  IGESCAFControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  read_file(reader, path, "IGES");
  if (!reader.Transfer(document.data)) throw Refusal(kNoBodies);
  check_session(reader.WS(), false, document.notes);
  const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.WS()->Model());
  if (model.IsNull()) return;
  const IGESData_GlobalSection& global = model->GlobalSection();
  document.unit = unit_of(global);
  if (std::fabs(global.Scale() - 1) > 1e-9)
    throw Refusal("is drawn at a scale of " + std::to_string(global.Scale()) + ": export it at 1, as the body is");
}

}  // namespace

Document read_document(const std::string& path) {
  check_ends(path);
  Document document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document.data);
  is_iges(path) ? read_iges(path, document) : read_step(path, document);
  if (document.unit.empty())
    throw Refusal("states no unit of length: export it again with one, or export a mesh and write 'kind: mesh' with its unit");
  document.shapes = XCAFDoc_DocumentTool::ShapeTool(document.data->Main());
  document.colours = XCAFDoc_DocumentTool::ColorTool(document.data->Main());
  return document;
}

}  // namespace millscope::cad
