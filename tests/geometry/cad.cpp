// STEP and IGES as the host reads them: through the plugin `step` and the program that it starts.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <opencascade/BRepBuilderAPI_Copy.hxx>
#include <opencascade/BRepBuilderAPI_MakeEdge.hxx>
#include <opencascade/BRepPrimAPI_MakeSphere.hxx>
#include <opencascade/IGESControl_Writer.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <random>
#include <sstream>

#include "kernel/base/error.hpp"
#include "kernel/config/document.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/geometry_file.hpp"
#include "tests/geometry/cad_files.hpp"
#include "tests/plugins.hpp"
#include "tests/scratch.hpp"

using namespace geometry_test;
using namespace millscope;
using Catch::Matchers::Contains;

namespace {

constexpr double kPi = std::numbers::pi;

host::GeometryObject open(const std::string& file, const std::string& more = "") {
  const host::Loaded& reader = testing::registry().find(Kind::geometry, "step");
  const config::Node node = config::parse_document("{file: \"" + file + "\"" + (more.empty() ? "" : ", " + more) + "}", "test");
  return host::GeometryObject::create(reader, config::resolve(*reader.descriptor, node, Scope::instance).view(), {"test", 1});
}

std::string refusal(const std::string& file, const std::string& more = "") {
  try {
    open(file, more);
  } catch (const base::UserError& e) {
    CHECK(std::string(e.what()).find('\n') == std::string::npos);
    CHECK_THAT(e.what(), Contains(file));
    return e.what();
  }
  return "accepted";
}

std::string slots(const host::GeometryObject& g) { return g.table().material_slots(g.self()); }
std::string report(const host::GeometryObject& g) { return g.table().report(g.self()); }

struct Measures {
  double area = 0, volume = 0;
  std::uint64_t triangles = 0;
};

Measures measure(const host::GeometryObject& g) {
  Surface s{};
  g.table().surface(g.self(), &s);
  Measures out{0, 0, s.triangle_count};
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    double p[3][3], n[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) p[k][i] = s.vertices[3 * std::size_t{s.triangles[3 * t + k]} + i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]);
    }
    out.area += 0.5 * std::hypot(n[0], n[1], n[2]);
    out.volume += (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6;
  }
  return out;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string write(const testing::Scratch& scratch, const std::string& name, const std::string& text) {
  const std::string path = (scratch.path / name).string();
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

}  // namespace

TEST_CASE("A STEP assembly has a slot per part, and the size that was drawn, in every unit") {
  const testing::Scratch scratch;
  for (const char* unit : {"MM", "M", "INCH"}) {
    CadFile file;
    add_liner(file, 4);
    const std::string path = (scratch.path / (std::string(unit) + ".step")).string();
    file.write_step(path, unit);
    const host::GeometryObject g = open(path);
    CHECK(slots(g) == "lifter|shell");
    const double shell = kPi * (0.155 * 0.155 - 0.15 * 0.15) * 0.06, lifters = 4 * 0.011 * 0.008 * 0.06;
    CHECK(measure(g).volume == Approx(shell + lifters).epsilon(2e-3));
    CHECK_THAT(report(g), Contains("5 solids") && Contains("cylinder of radius 0.15 m"));
  }
}

TEST_CASE("The area of a cut cylinder comes nearer to the exact one with the square of the angle") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(BRepPrimAPI_MakeCylinder(150, 60).Shape(), "drum");
  const std::string path = (scratch.path / "drum.step").string();
  file.write_step(path);
  const double exact = 2 * kPi * 0.15 * (0.15 + 0.06);
  double before = 0;
  for (const double chord : {2e-3, 5e-4, 1.25e-4}) {
    const Measures m = measure(open(path, "angle: 1, chord: " + std::to_string(chord)));
    const double error = exact - m.area;
    CHECK(error > 0);
    CHECK(m.volume < kPi * 0.15 * 0.15 * 0.06);
    CHECK(m.volume > 0);
    if (before > 0) CHECK(before / error == Approx(4).margin(1.5));  // half as wide facets: a quarter of the sagitta
    before = error;
  }
}

TEST_CASE("Colours are slots where they are asked for, a face's own before its body's") {
  const testing::Scratch scratch;
  CadFile file;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(100, 100, 100).Shape();
  const TDF_Label part = file.add(box, "plate");
  file.colour(part, 1, 0.5, 0);
  file.colour(part, TopExp_Explorer(box, TopAbs_FACE).Current(), 0, 0, 1);
  file.add(BRepPrimAPI_MakeBox(gp_Pnt(200, 0, 0), 50, 50, 50).Shape(), "bare");
  const std::string path = (scratch.path / "coloured.stp").string();
  file.write_step(path);
  CHECK(slots(open(path)) == "bare|plate");
  CHECK(slots(open(path, "slots: colour")) == "colour_0000ff|colour_ff8000|no_colour");
}

TEST_CASE("Bodies of one part have numbers, and names of any letters stay") {
  const testing::Scratch scratch;
  CadFile file;
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, BRepPrimAPI_MakeBox(50, 50, 50).Shape());
  builder.Add(two, BRepPrimAPI_MakeBox(gp_Pnt(100, 0, 0), 50, 50, 50).Shape());
  file.add(two, "Hubleiste größer");
  const std::string path = (scratch.path / "bodies.STEP").string();
  file.write_step(path);
  CHECK(slots(open(path)) == "Hubleiste größer_1|Hubleiste größer_2");
}

TEST_CASE("Faces of IGES, which share no edges, are joined to a closed body") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(tube(150, 155, 60), "shell");
  const std::string path = (scratch.path / "shell.igs").string();
  file.write_iges(path);
  const host::GeometryObject g = open(path);
  CHECK_THAT(report(g), Contains("surface: closed") && Contains("millimetre"));
  CHECK(measure(g).volume == Approx(kPi * (0.155 * 0.155 - 0.15 * 0.15) * 0.06).epsilon(2e-3));
}

TEST_CASE("What is no CAD body is refused in a line") {
  const testing::Scratch scratch;
  CadFile file;
  add_liner(file, 2);
  const std::string path = (scratch.path / "liner.step").string();
  file.write_step(path);
  const std::string text = text_of(path);
  CHECK_THAT(refusal((scratch.path / "missing.step").string()), Contains("No such file"));
  CHECK_THAT(refusal(write(scratch, "empty.step", "")), Contains("is empty"));
  CHECK_THAT(refusal(write(scratch, "zip.step", "PK\x03\x04 and more")), Contains("ISO-10303-21"));
  CHECK_THAT(refusal(write(scratch, "short.step", text.substr(0, text.size() / 2))), Contains("cut short"));
  CHECK_THAT(refusal(write(scratch, "short.igs", std::string(72, ' ') + "S      1\nabc\n")), Contains("cut short"));
  CHECK_THAT(refusal(write(scratch, "liner.stl", "solid a\nendsolid a\n")), Contains("kind: mesh"));
  CHECK_THAT(refusal(path, "max_triangles: 20"), Contains("max_triangles") && Contains("chord"));
  CHECK_THAT(refusal(write(scratch, "nothing.step",
                           "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                           "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n")),
             !Contains("accepted"));
}

TEST_CASE("A STEP file without a unit is refused, for nobody knows its size") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(BRepPrimAPI_MakeBox(100, 100, 100).Shape(), "box");
  const std::string path = (scratch.path / "box.step").string();
  file.write_step(path);
  std::string text = text_of(path);
  const std::size_t at = text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT");
  REQUIRE(at != std::string::npos);
  text.replace(at, std::string("GLOBAL_UNIT_ASSIGNED_CONTEXT((#").size() - 2, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEX");
  CHECK_THAT(refusal(write(scratch, "no_unit.step", text)), Contains("unit"));
}

TEST_CASE("A body or a face that is not understood is not left out in silence") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(BRepPrimAPI_MakeBox(100, 100, 100).Shape(), "seen");
  file.add(BRepPrimAPI_MakeBox(gp_Pnt(200, 0, 0), 50, 50, 50).Shape(), "spoiled");
  const std::string path = (scratch.path / "two.step").string();
  file.write_step(path);
  CHECK(slots(open(path)) == "seen|spoiled");
  for (const char* keyword : {"MANIFOLD_SOLID_BREP", "ADVANCED_FACE", "PLANE", "CLOSED_SHELL"}) {
    std::string text = text_of(path);
    text.replace(text.rfind(std::string(" = ") + keyword) + 3, std::string(keyword).size(), std::string(std::string(keyword).size(), 'X'));
    CHECK_THAT(refusal(write(scratch, "spoiled.step", text)), !Contains("accepted"));
  }
  file.write_several((scratch.path / "refers.step").string());
  CHECK_THAT(refusal((scratch.path / "refers.step").string()), Contains("refers to other files"));
}

TEST_CASE("What is hidden or has no faces is told") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(BRepPrimAPI_MakeBox(100, 100, 100).Shape(), "seen");
  file.hide(file.add(BRepPrimAPI_MakeBox(gp_Pnt(200, 0, 0), 50, 50, 50).Shape(), "hidden"));
  file.add(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(500, 0, 0)).Shape(), "axis");
  const std::string path = (scratch.path / "parts.step").string();
  file.write_step(path);
  const host::GeometryObject g = open(path);
  CHECK(slots(g) == "hidden|seen");
  CHECK_THAT(report(g), Contains("hidden in the drawing, used all the same: 1") && Contains("without faces, left out: 1"));
}

TEST_CASE("Assemblies in assemblies stand where they were put, and the colour of a use goes before its part's") {
  const testing::Scratch scratch;
  CadFile file;
  const TDF_Label part = file.add(BRepPrimAPI_MakeBox(10, 20, 30).Shape(), "brick"), inner = file.assembly("inner"),
                  outer = file.assembly("outer");
  file.colour(part, 1, 0, 0);
  file.use(inner, part, kPi / 2, 100);   // x 80 to 100, y 0 to 10
  file.use(outer, inner, kPi / 2, 500);  // x 490 to 500, y 80 to 100
  file.colour(file.use(outer, part, 0), 0, 1, 0);
  const std::string path = (scratch.path / "nested.step").string();
  file.write_step(path);
  CHECK_THAT(report(open(path)), Contains("box: [0, 0, 0] to [0.5, 0.1, 0.03] m"));
  CHECK(slots(open(path, "slots: colour")) == "colour_00ff00|colour_ff0000");
  CHECK(measure(open(path)).volume == Approx(2 * 6e-6));
}

TEST_CASE("The chord holds on a sphere, and in the case's metres whatever the scale") {
  const testing::Scratch scratch;
  CadFile file;
  file.add(BRepPrimAPI_MakeSphere(200).Shape(), "ball");
  const std::string path = (scratch.path / "ball.step").string();
  file.write_step(path);
  for (const double scale : {1.0, 0.1, 10.0}) {
    const host::GeometryObject g = open(path, "angle: 1, chord: 0.001, scale: " + std::to_string(scale));
    Surface s{};
    g.table().surface(g.self(), &s);
    double farthest = 0;
    for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
      double centre[3] = {0, 0, 0};
      for (std::size_t k = 0; k < 9; ++k) centre[k % 3] += s.vertices[3 * std::size_t{s.triangles[3 * t + k / 3]} + k % 3] / 3;
      farthest = std::max(farthest, 0.2 * scale - std::hypot(centre[0], centre[1], centre[2]));
    }
    CHECK(farthest < 0.001);
    CHECK(farthest > 0.0001);  // and no finer than it need be
  }
}

TEST_CASE("Faces that are parts of their own close the body, and sheets that lie near each other stay two") {
  const testing::Scratch scratch;
  IGESControl_Writer loose;
  for (TopExp_Explorer at(tube(150, 155, 60), TopAbs_FACE); at.More(); at.Next()) loose.AddShape(BRepBuilderAPI_Copy(at.Current()).Shape());
  loose.ComputeModel();
  const std::string faces = (scratch.path / "faces.igs").string();
  loose.Write(faces.c_str());
  CHECK_THAT(report(open(faces)), Contains("surface: closed"));

  CadFile file;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(100, 100, 100).Shape();
  const TopoDS_Shape sheet = TopExp_Explorer(box, TopAbs_FACE).Current();
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(2, 0, 0));
  TopoDS_Compound two;
  BRep_Builder builder;
  builder.MakeCompound(two);
  builder.Add(two, sheet);
  builder.Add(two, sheet.Moved(TopLoc_Location(shift)));
  file.add(two, "sheets");
  const std::string sheets = (scratch.path / "sheets.step").string();
  file.write_step(sheets);
  CHECK(measure(open(sheets, "chord: 0.01")).area == Approx(2 * 0.01));
}

TEST_CASE("Every application protocol of STEP is read") {
  const testing::Scratch scratch;
  for (const int schema : {3, 4, 5}) {  // AP203, AP214, AP242
    CadFile file;
    file.add(BRepPrimAPI_MakeBox(100, 100, 100).Shape(), "box");
    const std::string path = (scratch.path / (std::to_string(schema) + ".step")).string();
    file.write_step(path, "MM", schema);
    CHECK(slots(open(path)) == "box");
    CHECK(measure(open(path)).volume == Approx(1e-3));
  }
}

TEST_CASE("Damaged STEP files end in a line or in a body, never in a crash of the host") {
  const testing::Scratch scratch;
  CadFile file;
  add_liner(file, 1);
  const std::string path = (scratch.path / "liner.step").string();
  file.write_step(path);
  const std::string text = text_of(path);
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    std::string damaged = text;
    for (int k = 0; k < 20; ++k) damaged[random() % damaged.size()] = static_cast<char>(' ' + static_cast<int>(random() % 90));
    const std::string answer = refusal(write(scratch, "damaged.step", damaged));
    refused += answer != "accepted";
  }
  CHECK(refused > 0);
}
