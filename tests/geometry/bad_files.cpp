// Every damaged or hostile file gets one line that names it, the reason and the remedy, within seconds, and leaves no child process.
#include <sys/wait.h>
#include <catch2/catch.hpp>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "geometry/import/mesh_file.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;

namespace {

std::string refusal(const std::string& path, const ImportLimits& limits = {}) {
  const auto start = std::chrono::steady_clock::now();
  std::string message = "accepted";
  try {
    MeshOptions options;
    options.label = path;
    make_mesh(import_mesh(path, limits), options);
  } catch (const Refusal& e) {
    message = e.what();
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK((::waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD));
  CHECK_THAT(message, Contains(path));
  CHECK(message.find('\n') == std::string::npos);
  return message;
}

std::string facet(const std::string& third) {
  return "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex " + third + "\nendloop\nendfacet\n";
}
std::string stl(const std::string& third) { return "solid a\n" + facet("0 1 0") + facet(third) + "endsolid a\n"; }

std::string binary_stl(std::uint32_t claimed, std::size_t bytes, float value) {
  std::string s(84 + bytes, '\0');
  std::memcpy(&s[80], &claimed, 4);
  for (std::size_t i = 0; i + 50 <= bytes; i += 50) {
    for (std::size_t k = 3; k < 12; ++k) {
      const float x = k == 6 ? value : static_cast<float>(k % 4);
      std::memcpy(&s[84 + i + 4 * k], &x, 4);
    }
  }
  return s;
}

}  // namespace

TEST_CASE("Files that are not there or not meshes") {
  const Folder folder;
  CHECK_THAT(refusal(folder.path("missing.stl")), Contains("No such file") && Contains("check the path"));
  CHECK_THAT(refusal(folder.write("empty.stl", "")), Contains("is empty"));
  CHECK_THAT(refusal(folder.path("")), Contains("is not a file"));
  CHECK_THAT(refusal(folder.write("part.step", "ISO-10303-21;")), Contains("CAD surfaces") && Contains("STL"));
  CHECK_THAT(refusal(folder.write("part.xyz", "hello")), Contains("stl, obj, ply"));
  CHECK_THAT(refusal(folder.write("part", "hello")), Contains("stl, obj, ply"));
}

TEST_CASE("STL") {
  const Folder folder;
  const std::string good = stl("0.5 1 0");
  CHECK(import_mesh(folder.write("ok.stl", good), {}).size() == 2);
  CHECK_THAT(refusal(folder.write("cut.stl", good.substr(0, good.size() - 12))), Contains("endsolid") && Contains("cut short"));
  CHECK_THAT(refusal(folder.write("cut2.stl", good.substr(0, 150))), Contains("cut short"));
  CHECK_THAT(refusal(folder.write("nan.stl", stl("nan 1 0"))), Contains("line 13") && Contains("not a finite number"));
  CHECK_THAT(refusal(folder.write("inf.stl", stl("1 inf 0"))), Contains("not a finite number"));
  CHECK_THAT(refusal(folder.write("comma.stl", stl("0,5 1 0"))), Contains("decimal comma"));
  CHECK_THAT(refusal(folder.write("far.stl", stl("1e300 1 0"))), Contains("largest extent"));
  CHECK_THAT(refusal(folder.write("km.stl", stl("1e5 1 0"))), Contains("largest extent") && Contains("unit"));
  CHECK_THAT(refusal(folder.write("none.stl", "solid a\nendsolid a\n")), Contains("no triangles"));
  CHECK_THAT(refusal(folder.write("flat.stl", "solid a\n" + facet("2 0 0") + "endsolid a\n")), Contains("without area"));
  CHECK_THAT(refusal(folder.write("short.stl", binary_stl(100, 500, 0))), Contains("100 triangles") && Contains("cut short"));
  CHECK_THAT(refusal(folder.write("zero.stl", binary_stl(0, 0, 0))), Contains("no triangles"));
  CHECK_THAT(refusal(folder.write("bnan.stl", binary_stl(2, 100, std::numeric_limits<float>::quiet_NaN()))), Contains("NaN or infinite"));
  CHECK_THAT(refusal(folder.write("noise.stl", std::string(1000, '\xfe'))), Contains("cut short or damaged"));
}

TEST_CASE("Size limits") {
  const Folder folder;
  ImportLimits limits;
  limits.max_triangles = 10;
  CHECK_THAT(refusal(folder.write("many.stl", binary_stl(20, 1000, 0)), limits), Contains("20 faces") && Contains("max_triangles = 10"));
  const std::string huge = folder.write("huge.stl", "solid");
  std::filesystem::resize_file(huge, std::uintmax_t{3} << 30);  // sparse
  CHECK_THAT(refusal(huge), Contains("MB is more than 5000000 triangles"));
}

TEST_CASE("OBJ") {
  const Folder folder;
  const std::string head = "v 0 0 0\nv 1 0 0\n";
  CHECK_THAT(refusal(folder.write("point.obj", head + "v .5 1 0\nf 1 2 3\n")), Contains("line 3") && Contains("0.5 for .5"));
  CHECK_THAT(refusal(folder.write("minus.obj", head + "v -.5 1 0\nf 1 2 3\n")), Contains("0.5 for .5"));
  CHECK_THAT(refusal(folder.write("comma.obj", head + "v 0,5 1 0\nf 1 2 3\n")), Contains("decimal comma"));
  CHECK_THAT(refusal(folder.write("nan.obj", head + "v nan 1 0\nf 1 2 3\n")), Contains("finite"));
  CHECK_THAT(refusal(folder.write("index.obj", head + "v 0 1 0\nf 1 2 9\n")), Contains("vertex 9 of 3"));
  CHECK_THAT(refusal(folder.write("negative.obj", head + "v 0 1 0\nf -1 -2 -9\n")), Contains("names no vertex"));
  CHECK_THAT(refusal(folder.write("cut.obj", head + "v 0 1 0\nf 1 2")), Contains("cut short"));
  CHECK_THAT(refusal(folder.write("points.obj", head)), Contains("no faces"));
}

TEST_CASE("OFF and PLY") {
  const Folder folder;
  CHECK_THAT(refusal(folder.write("claim.off", "OFF\n100000000 1 0\n0 0 0\n")), Contains("max_triangles"));
  CHECK_THAT(refusal(folder.write("cut.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1")), Contains("cut short"));
  CHECK_THAT(refusal(folder.write("no.off", "HELLO\n")), Contains("'OFF'"));
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\n";
  CHECK_THAT(refusal(folder.write("endless.ply", head)), Contains("end_header"));
  CHECK_THAT(refusal(folder.write("cut.ply", head + "end_header\n0 0 0\n1 0 0\n")), Contains("3 announced, 2 found"));
  CHECK_THAT(refusal(folder.write("nan.ply", head + "end_header\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n")), Contains("finite"));
  CHECK_THAT(refusal(folder.write("binary.ply",
                                  "ply\nformat binary_little_endian 1.0\nelement vertex 1000\nproperty float x\nproperty float y\n"
                                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\nabc")),
             Contains("cut short"));
  CHECK_THAT(refusal(folder.write("index.ply", head + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")), !Contains("accepted"));
}

TEST_CASE("glTF, GLB and 3MF") {
  const Folder folder;
  CHECK_THAT(refusal(folder.write("deep.gltf", "{\"a\":" + std::string(100000, '['))), Contains("nested"));
  CHECK_THAT(refusal(folder.write("cut.gltf", "{\"asset\":{\"version\":\"2.0\"")), Contains("cut short"));
  CHECK_THAT(refusal(folder.write("noise.glb", "glTF" + std::string(100, '\x7f'))), Contains("cut short"));
  CHECK_THAT(refusal(folder.write("empty.gltf", "{\"asset\":{\"version\":\"2.0\"}}")), !Contains("accepted"));
  CHECK_THAT(refusal(folder.write("bad.3mf", "PK\x03\x04" + std::string(200, 'x'))), Contains("directory is missing"));
  CHECK_THAT(refusal(folder.write("text.3mf", "hello")), Contains("ZIP"));
  std::string chain = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 1; i < 200000; ++i) chain += "{\"children\":[" + std::to_string(i) + "]},";
  CHECK_THAT(refusal(folder.write("chain.gltf", chain + "{}]}")), Contains("damaged or hostile") || Contains("holds no triangles"));
  CHECK_THAT(
      refusal(folder.write("loop.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[0]}]})")),
      !Contains("accepted"));
}

TEST_CASE("A reader that runs out of memory or time is stopped") {
  const Folder folder;
  std::string faces = "solid a\n";
  for (int i = 0; i < 20000; ++i) faces += facet("0 1 " + std::to_string(i));
  const std::string path = folder.write("large.stl", faces + "endsolid a\n");
  ImportLimits limits;
  SECTION("memory") {
    limits.base_bytes = 1 << 20, limits.bytes_per_byte = 0;
    CHECK_THAT(refusal(path, limits), Contains("memory") || Contains("crash") || Contains("stop half-way"));
  }
  SECTION("time") {
    limits.base_seconds = 0.001, limits.seconds_per_megabyte = 0;
    CHECK_THAT(refusal(path, limits), Contains("was not read within"));
  }
}

TEST_CASE("No descriptor is left open") {
  const Folder folder;
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator{});
  };
  const auto before = open_files();
  for (int i = 0; i < 5; ++i) refusal(folder.write("cut.stl", "solid a\n"));
  CHECK(open_files() == before);
}
