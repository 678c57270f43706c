// Mesh files of other people's programs: read as they are meant.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <sstream>

#include "geometry/import/mesh_file.hpp"
#include "tests/geometry/helpers.hpp"
#include "tests/skip.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;

namespace {

constexpr int kSides = 24;

/// A drum of 24 sides with its end faces, radius 150, length 60 mm, all facing inwards, moved by `far`.
std::vector<Point> drum(double far = 0) {
  std::vector<Point> corners;
  const auto at = [far](int k, double z) {
    const double angle = 2 * M_PI * k / kSides;
    return Point{150 * std::cos(angle) + far, 150 * std::sin(angle) - far, z};
  };
  for (int k = 0; k < kSides; ++k) {
    const Point a = at(k, 0), b = at(k + 1, 0), c = at(k + 1, 60), d = at(k, 60), low{far, -far, 0}, high{far, -far, 60};
    for (const Point& p : {a, d, c, a, c, b, low, a, b, high, c, d}) corners.push_back(p);
  }
  return corners;
}

struct Spelling {
  const char *solid = "solid", *facet = "facet normal 0 0 0", *outer = "outer loop", *vertex = "vertex", *endloop = "endloop",
             *endfacet = "endfacet", *endsolid = "endsolid";
};

/// The drum in as many solids as there are names, in turn.
std::string text(const std::vector<std::string>& names, const Spelling& w = {}, double far = 0) {
  const std::vector<Point> corners = drum(far);
  const std::size_t each = corners.size() / names.size() / 3 * 3;
  std::ostringstream out;
  out.precision(15);
  for (std::size_t n = 0; n < names.size(); ++n) {
    out << w.solid << " " << names[n] << "\n";
    for (std::size_t i = n * each; i < (n + 1) * each; i += 3) {
      out << w.facet << "\n" << w.outer << "\n";
      for (std::size_t k = i; k < i + 3; ++k) out << w.vertex << " " << corners[k].x << " " << corners[k].y << " " << corners[k].z << "\n";
      out << w.endloop << "\n" << w.endfacet << "\n";
    }
    out << w.endsolid << " " << names[n] << "\n";
  }
  return out.str();
}

std::string binary(double far = 0, std::size_t more = 0, char filler = 'x') {
  const std::vector<Point> corners = drum(far);
  std::string out(80, ' ');
  const auto put = [&out](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(corners.size() / 3));
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    out.append(12, '\0');
    for (std::size_t k = i; k < i + 3; ++k) {
      for (const double x : {corners[k].x, corners[k].y, corners[k].z}) put(static_cast<float>(x));
    }
    out.append(2, '\0');
  }
  return out + std::string(more, filler);
}

std::unique_ptr<Mesh> mesh_of(const std::string& path, bool centre = false) {
  MeshOptions options;
  options.label = path;
  options.placement.scale = 1e-3;
  options.placement.centre = centre;
  return make_mesh(import_mesh(path, {}), options);
}

std::string slots_of(const Folder& folder, const std::vector<std::string>& names) {
  return mesh_of(folder.write("names.stl", text(names)))->material_slots();
}

}  // namespace

TEST_CASE("Every solid of an STL is a slot, by its whole name") {
  const Folder folder;
  CHECK(slots_of(folder, {"liner plate", "liner lifter"}) == "liner plate|liner lifter");
  CHECK(slots_of(folder, {"", ""}) == "solid_1|solid_2");
  CHECK(slots_of(folder, {""}) == "all");
  CHECK(slots_of(folder, {"part (1)", "part (2)", "part"}) == "part (1)|part (2)|part");
  CHECK(slots_of(folder, {"Solid body of solid liner - endsolid facet vertex"}) == "Solid body of solid liner - endsolid facet vertex");
  CHECK(slots_of(folder, {"a", "b", "a", "b"}) == "a|b");
  CHECK(slots_of(folder, {"x|y"}) == "x_y");
  CHECK(slots_of(folder, {"x|y", "x_y"}) == "x_y|x_y_2");
  CHECK(slots_of(folder, std::vector<std::string>(96, "")) == "all");  // a solid of every face
}

TEST_CASE("Keywords of an STL are read in any case and spelling, and normals not at all") {
  const Folder folder;
  const Spelling upper{"SOLID", "FACET NORMAL 0 0 0", "OUTER LOOP", "VERTEX", "ENDLOOP", "ENDFACET", "ENDSOLID"};
  const Spelling apart{"Solid", "Facet Normal 0 0 0", "Outer Loop", "Vertex", "End Loop", "End Facet", "End Solid"};
  const Spelling odd{"solid", "facet normal -1.#IND00 nan(ind) 1,5", "outer loop", "  vertex", "endloop", "endfacet", "ENDSOLID"};
  for (const Spelling& words : {upper, apart, odd, Spelling{}}) {
    const auto mesh = mesh_of(folder.write("spelt.stl", text({"mill"}, words)));
    CHECK(mesh->mesh().own == 4 * kSides);
    CHECK(mesh->survey().closed);
    CHECK(mesh->material_slots() == "mill");
  }
  std::string one_line = text({"mill"});
  const std::size_t name = one_line.find('\n') + 1;
  for (std::size_t i = name; i < one_line.size(); ++i) {
    if (one_line.compare(i, 6, "\nouter") == 0 || one_line.compare(i, 7, "\nvertex") == 0 || one_line.compare(i, 4, "\nend") == 0)
      one_line[i] = ' ';
  }
  for (std::size_t at = 0; (at = one_line.find("normal 0 0 0 ", at)) != std::string::npos;) one_line.replace(at, 13, "normal 0 0 0\n");
  CHECK(mesh_of(folder.write("lines.stl", one_line))->mesh().own == 4 * kSides);
}

TEST_CASE("Bytes behind a binary STL are said, or refused where they may be triangles") {
  const Folder folder;
  CHECK_THAT(mesh_of(folder.write("tail.stl", binary(0, 37)))->report(), Contains("note: 37 bytes behind the last triangle"));
  CHECK_THAT(mesh_of(folder.write("block.stl", binary(0, 4000, '\0')))->report(), Contains("note: 4000 bytes"));
  CHECK(mesh_of(folder.write("plain.stl", binary()))->report().find("note:") == std::string::npos);
  CHECK_THROWS_WITH(mesh_of(folder.write("more.stl", binary(0, 500))), Contains("500 bytes too many") && Contains("96 triangles"));
}

TEST_CASE("Far from the origin text is as precise as written, and single precision is said") {
  const Folder folder;
  constexpr double kFar = 5.4e6;  // mm
  const auto near = mesh_of(folder.write("near.stl", text({"mill"}))),
             far = mesh_of(folder.write("far.stl", text({"mill"}, {}, kFar)), true);
  CHECK(far->survey().interior.radius == Approx(near->survey().interior.radius).epsilon(1e-6));
  CHECK(far->survey().axis.asymmetry < 1e-8);
  CHECK(far->report().find("note:") == std::string::npos);
  CHECK_THAT(mesh_of(folder.write("far_binary.stl", binary(kFar)), true)->report(),
             Contains("note: coordinates up to 5.4e+06") && Contains("0.32"));
}

TEST_CASE("Of a short mill that faces inwards all of the area does, its ends too") {
  const Folder folder;
  const auto closed = mesh_of(folder.write("closed.stl", text({"mill"})));
  CHECK(closed->survey().inward_share == 1);
  CHECK(closed->survey().facing == Facing::inwards);
  std::string one_end = text({"mill"});  // a pot: without the last facet, an end of six sevenths
  one_end.erase(one_end.rfind("facet normal"), one_end.rfind("endfacet") + 9 - one_end.rfind("facet normal"));
  const auto open = mesh_of(folder.write("open.stl", one_end));
  CHECK_FALSE(open->survey().closed);
  CHECK(open->survey().inward_share == 1);
  CHECK(open->survey().facing == Facing::inwards);
}

TEST_CASE("A binary PLY whose first byte is a line end is read") {
  const Folder folder;
  for (const char first : {'\n', '\r', '\0'}) {
    std::string out =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    const auto put = [&out](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
    const std::size_t body = out.size();
    for (const float x : {100.0F, 0.0F, 0.0F, 0.0F, 100.0F, 0.0F, 0.0F, 0.0F, 100.0F, 0.0F, 0.0F, 0.0F}) put(x);
    for (const auto& face : {std::array{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}) {
      put(std::uint8_t{3});
      for (const std::int32_t corner : face) put(corner);
    }
    out[body] = first;
    const auto mesh = mesh_of(folder.write("first.ply", out));
    CHECK(mesh->mesh().own == 4);
    CHECK(std::fabs(mesh->survey().volume) == Approx(1e-3 / 6).epsilon(1e-5));
  }
}

TEST_CASE("Meshes on which other people's tools failed") {
  const auto at = [](const std::string& name) { return testing::public_case("meshes/" + name); };
  if (testing::absent(at("00_plain.stl"))) return;
  for (const char* name : {"00_plain.stl", "02_upper_case.stl", "03_mixed_end.stl", "09_msvc_nan_normals.stl", "17_word_solid_in_name.stl",
                           "32_binary_trailing_bytes.stl", "43_binary_le_first_byte_newline.ply", "01_two_solids_same_first_word.stl"}) {
    CAPTURE(name);
    const auto mesh = mesh_of(at(name).string(), true);
    CHECK(mesh->mesh().own == 132);
    CHECK(mesh->survey().area == Approx(0.2091095996).epsilon(1e-6));
    CHECK(mesh->survey().inward_share == Approx(0.978).margin(1e-3));  // the lifters' tops, 4320 mm², look outwards
    CHECK(mesh->survey().axis.asymmetry < 1e-6);
  }
  const auto plant = mesh_of(at("20_plant_coordinates.stl").string(), true);  // written to a hundredth of a millimetre
  CHECK(plant->survey().interior.radius == Approx(0.15).epsilon(1e-4));
  CHECK(plant->survey().axis.asymmetry < 2e-5);
  CHECK(mesh_of(at("01_two_solids_same_first_word.stl").string())->material_slots() == "liner plate|liner lifter");
  CHECK(mesh_of(at("54_polygons_24_sides.obj").string())->survey().inward_share > 0.97);
}
