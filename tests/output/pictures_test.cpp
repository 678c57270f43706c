#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <sstream>

#include "kernel/base/text.hpp"
#include "kernel/output/stl.hpp"
#include "kernel/output/vtk.hpp"
#include "output/support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

std::string attribute(const std::string& text, std::size_t from, const std::string& name) {
  const std::size_t at = text.find(name + "=\"", from) + name.size() + 2;
  return text.substr(at, text.find('"', at) - at);
}

struct Array {
  std::string type, bytes;
  std::size_t components;
};

// Checks that the arrays lie one behind the other to the end of the appended data, as VTK's reader expects; returns them by name.
std::map<std::string, Array> parse_vtp(const std::string& file) {
  const std::string open = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t data = file.find(open) + open.size();
  REQUIRE(data > open.size());
  std::map<std::string, Array> arrays;
  std::size_t expected = 0;
  for (std::size_t at = file.find("<DataArray"); at < data; at = file.find("<DataArray", at + 1)) {
    const std::size_t offset = std::stoull(attribute(file, at, "offset"));
    CHECK(offset == expected);
    std::uint64_t bytes = 0;
    REQUIRE(data + offset + 8 <= file.size());
    std::memcpy(&bytes, file.data() + data + offset, 8);
    arrays[attribute(file, at, "Name")] = {attribute(file, at, "type"), file.substr(data + offset + 8, bytes),
                                           std::stoull(attribute(file, at, "NumberOfComponents"))};
    expected = offset + 8 + bytes;
  }
  CHECK(file.substr(data + expected) == "\n</AppendedData>\n</VTKFile>\n");
  return arrays;
}

template <class T>
T value(const Array& array, std::size_t k) {
  T result;
  REQUIRE((k + 1) * sizeof(T) <= array.bytes.size());
  std::memcpy(&result, array.bytes.data() + k * sizeof(T), sizeof(T));
  return result;
}

// A square of two triangles in slot 1 and one triangle in slot 0.
const std::vector<double> kVertices{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.1, 0.2, 1e-7};
const std::vector<std::uint32_t> kTriangles{0, 1, 2, 0, 2, 3, 0, 1, 4};
const std::vector<std::uint32_t> kSlots{1, 1, 0};
const millscope::Surface kSurface{5, kVertices.data(), 3, kTriangles.data(), kSlots.data()};

}  // namespace

TEST_CASE("a picture of beads") {
  const Scratch scratch;
  const std::vector<std::uint32_t> id{5, 6}, material{0, 1};
  const std::vector<double> radius{0.005, 0.006}, position{1, 2, 3, 4, 5, 6}, velocity{3, 4, 0, 0, 0, 0}, spin{0, 0, 1, 0, 0, 2};
  write_beads_vtp(scratch / "beads.vtp", {id, material, radius, position, velocity, spin});
  const auto arrays = parse_vtp(text_of(scratch / "beads.vtp"));
  CHECK(arrays.size() == 9);
  CHECK(value<float>(arrays.at("speed"), 0) == 5);
  CHECK(value<float>(arrays.at("position"), 5) == 6);
  CHECK(arrays.at("position").bytes.size() == 24);
  CHECK(value<std::uint32_t>(arrays.at("id"), 1) == 6);
  CHECK(value<std::int64_t>(arrays.at("connectivity"), 1) == 1);
  CHECK(value<std::int64_t>(arrays.at("offsets"), 1) == 2);
  CHECK(arrays.at("spin").components == 3);
  write_beads_vtp(scratch / "none.vtp", {});
  CHECK(parse_vtp(text_of(scratch / "none.vtp")).size() == 9);
}

TEST_CASE("a picture of a mesh") {
  const Scratch scratch;
  const std::vector<double> impact{1, 2, 3}, shear{4, 5, 6};
  write_mesh_vtp(scratch / "mesh.vtp", {kVertices, kTriangles, kSlots, impact, shear});
  const auto arrays = parse_vtp(text_of(scratch / "mesh.vtp"));
  CHECK(value<double>(arrays.at("impact_work"), 2) == 3);
  CHECK(value<double>(arrays.at("shear_work_per_area"), 0) == 8);
  CHECK(value<std::int64_t>(arrays.at("connectivity"), 8) == 4);
  CHECK(value<std::int64_t>(arrays.at("offsets"), 2) == 9);
  write_mesh_vtp(scratch / "plain.vtp", {kVertices, kTriangles, kSlots, {}, {}});
  CHECK(parse_vtp(text_of(scratch / "plain.vtp")).count("impact_work") == 0);
}

TEST_CASE("a series of pictures, resumed") {
  const Scratch scratch;
  PictureSeries series = PictureSeries::create(scratch / "beads.pvd");
  CHECK_FALSE(std::filesystem::exists(scratch / "beads.pvd"));
  for (int k = 0; k < 5; ++k) series.add(0.1 * k, "a&b<\"" + std::to_string(k) + ".vtp", k % 2);
  const std::string whole = text_of(scratch / "beads.pvd");
  PictureSeries resumed = PictureSeries::resume(scratch / "beads.pvd", 0.1 * 2);
  CHECK(resumed.size() == 3);
  for (int k = 3; k < 5; ++k) resumed.add(0.1 * k, "a&b<\"" + std::to_string(k) + ".vtp", k % 2);
  CHECK(text_of(scratch / "beads.pvd") == whole);
  CHECK_THAT(whole, Contains("file=\"a&amp;b&lt;&quot;4.vtp\""));
  CHECK(PictureSeries::resume(scratch / "none.pvd", 1).size() == 0);
  CHECK_THAT(refusal([&] { PictureSeries::create(scratch / "beads.pvd"); }), Contains("exists already"));
}

TEST_CASE("ASCII STL keeps the slots' names and the coordinates' bits") {
  const Scratch scratch;
  const std::vector<std::string> slots{"end face", "lifter", "unused"};
  write_stl(scratch / "a.stl", kSurface, slots);
  std::istringstream in(text_of(scratch / "a.stl"));
  std::vector<std::string> solids;
  std::vector<double> corners;
  for (std::string word; in >> word;) {
    if (word == "solid") in >> word, solids.push_back(word);
    if (word != "vertex") continue;
    for (int k = 0; k < 3; ++k) in >> word, corners.push_back(std::stod(word));
  }
  CHECK(solids == std::vector<std::string>{"end_face", "lifter"});
  std::vector<double> expected;
  for (const std::size_t corner : {0, 1, 4, 0, 1, 2, 0, 2, 3}) {
    for (std::size_t k = 0; k < 3; ++k) expected.push_back(kVertices[3 * corner + k]);
  }
  CHECK(corners == expected);
  const std::vector<std::string> one{"all"};
  CHECK_THROWS_AS(write_stl(scratch / "b.stl", kSurface, one), std::logic_error);
}

TEST_CASE("binary STL has the size that its count says") {
  const Scratch scratch;
  const std::vector<std::string> slots{"end", "lifter"};
  write_stl(scratch / "b.stl", kSurface, slots, StlFormat::binary);
  const std::string file = text_of(scratch / "b.stl");
  REQUIRE(file.size() == 84 + 3 * 50);
  CHECK(file[80] == 3);
  CHECK(file.rfind("solid", 0) != 0);
  float z = 0;
  std::memcpy(&z, file.data() + 84 + 8, 4);
  CHECK(z == 1);              // normal of the first triangle
  CHECK(file[84 + 48] == 1);  // its slot
}
