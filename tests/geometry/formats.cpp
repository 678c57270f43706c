// The same cube in every format that can be written by hand.
#include <catch2/catch.hpp>

#include <cstring>
#include <sstream>

#include "geometry/import/guarded_import.hpp"
#include "tests/geometry/helpers.hpp"

using namespace geometry_test;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

namespace {

struct Listed {
  std::vector<Point> vertices;
  std::vector<Corners> triangles;
};

Listed listed_cube() {
  const auto mesh = make_mesh(cube(0.1));
  Listed l{mesh->mesh().vertices, mesh->mesh().triangles};
  for (Point& p : l.vertices) p = 1000.0 * p;
  return l;
}

std::string text_stl(const std::vector<std::string>& names) {
  const Listed l = listed_cube();
  std::ostringstream out;
  const std::size_t per_solid = l.triangles.size() / names.size();
  for (std::size_t n = 0; n < names.size(); ++n) {
    out << "solid " << names[n] << "\n";
    for (std::size_t t = n * per_solid; t < (n + 1) * per_solid; ++t) {
      out << "  facet normal 0 0 0\n    outer loop\n";
      for (const std::uint32_t c : l.triangles[t])
        out << "      vertex " << l.vertices[c].x << " " << l.vertices[c].y << " " << l.vertices[c].z << "\n";
      out << "    endloop\n  endfacet\n";
    }
    out << "endsolid " << names[n] << "\n";
  }
  return out.str();
}

std::string binary_stl() {
  const Listed l = listed_cube();
  std::string out(80, ' ');
  const auto put = [&out](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(l.triangles.size()));
  for (const Corners& t : l.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0F);
    for (const std::uint32_t c : t) {
      for (const double x : {l.vertices[c].x, l.vertices[c].y, l.vertices[c].z}) put(static_cast<float>(x));
    }
    put(std::uint16_t{0});
  }
  return out;
}

std::string indexed(const char* vertex, const char* face, std::uint32_t first) {
  const Listed l = listed_cube();
  std::ostringstream out;
  for (const Point& p : l.vertices) out << vertex << p.x << " " << p.y << " " << p.z << "\n";
  for (const Corners& t : l.triangles) out << face << t[0] + first << " " << t[1] + first << " " << t[2] + first << "\n";
  return out.str();
}

std::string ply(const std::string& format) {
  std::string out = "ply\nformat " + format +
                    " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  if (format == "ascii") return out + indexed("", "3 ", 0);
  const Listed l = listed_cube();
  const auto put = [&out](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const Point& p : l.vertices) {
    for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
  }
  for (const Corners& t : l.triangles) {
    put(std::uint8_t{3});
    for (const std::uint32_t c : t) put(static_cast<std::int32_t>(c));
  }
  return out;
}

/// A node that moves the cube by 1 m along x, so that transforms are seen to be applied.
std::string gltf(const Folder& folder) {
  const Listed l = listed_cube();
  std::string data;
  const auto put = [&data](const auto& value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const Point& p : l.vertices) {
    for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
  }
  for (const Corners& t : l.triangles) {
    for (const std::uint32_t c : t) put(static_cast<std::uint16_t>(c));
  }
  folder.write("cube.bin", data);
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
  "nodes":[{"name":"holder","translation":[1000,0,0],"children":[1]},{"mesh":0,"name":"block"}],
  "meshes":[{"name":"block","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[100,100,100]},
               {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],
  "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
  "buffers":[{"uri":"cube.bin","byteLength":168}]})";
}

void check_cube(const std::string& path, const std::string& slots, double x = 0) {
  INFO(path);
  MeshOptions options;
  options.label = path;
  options.placement.scale = 1e-3;
  const auto mesh = make_mesh(import_mesh(path, {}), options);
  CHECK(mesh->mesh().own == 12);
  CHECK(mesh->mesh().vertices.size() == 8);
  CHECK(mesh->topology().open_edges == 0);
  CHECK_THAT(mesh->survey().volume, WithinRel(1e-3, 1e-6));
  CHECK(std::fabs(mesh->survey().box.low.x - x) < 1e-6);
  CHECK(mesh->material_slots() == slots);
}

}  // namespace

TEST_CASE("Every format gives the same cube") {
  const Folder folder;
  check_cube(folder.write("a.stl", text_stl({"block"})), "block");
  check_cube(folder.write("windows.STL",
                          [] {
                            std::string text = text_stl({"block"});
                            for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.insert(i, 1, '\r');
                            return text;
                          }()),
             "block");
  check_cube(folder.write("two.stl", text_stl({"shell", "lifter"})), "shell|lifter");
  check_cube(folder.write("b.stl", binary_stl()), "all");
  check_cube(folder.write("c.obj", indexed("v ", "f ", 1)), "all");
  check_cube(folder.write("d.off", "OFF\n8 12 0\n" + indexed("", "3 ", 0)), "all");
  check_cube(folder.write("e.ply", ply("ascii")), "all");
  check_cube(folder.write("f.ply", ply("binary_little_endian")), "all");
  check_cube(folder.write("g.gltf", gltf(folder)), "block", 1.0);
}

TEST_CASE("Names of OBJ objects become material slots") {
  const Folder folder;
  std::string text = indexed("v ", "f ", 1);
  text.insert(text.find("f "), "o shell\n");
  text.insert(text.rfind("f "), "o lifter\n");
  check_cube(folder.write("named.obj", text), "shell|lifter");
}
