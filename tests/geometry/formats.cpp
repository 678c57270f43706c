// The same cube in every format that can be written by hand.
#include <zlib.h>

#include <catch2/catch.hpp>

#include <cstring>
#include <sstream>

#include "geometry/import/mesh_file.hpp"
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

std::string bytes_of(std::uint32_t value, int count = 4) {
  return {reinterpret_cast<const char*>(&value), static_cast<std::size_t>(count)};
}

/// Vertices, then triangles, as glTF's buffers hold them.
std::string gltf_data() {
  const Listed l = listed_cube();
  std::string data;
  const auto put = [&data](const auto& value) { data.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const Point& p : l.vertices) {
    for (const double x : {p.x, p.y, p.z}) put(static_cast<float>(x));
  }
  for (const Corners& t : l.triangles) {
    for (const std::uint32_t c : t) put(static_cast<std::uint16_t>(c));
  }
  return data;
}

/// A node that moves the cube by 1 m along x, so that transforms are seen to be applied. `source`: where the buffer is.
std::string gltf(const std::string& source) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
  "nodes":[{"name":"holder","translation":[1000,0,0],"children":[1]},{"mesh":0,"name":"block"}],
  "meshes":[{"name":"block","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
  "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[100,100,100]},
               {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],
  "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
  "buffers":[{)" +
         source + R"("byteLength":168}]})";
}

/// The binary container: a header of 12 bytes, then chunks of text and data (glTF 2.0 specification, 4.4).
std::string glb() {
  std::string text = gltf(""), data = gltf_data();
  text.append((4 - text.size() % 4) % 4, ' ');
  data.append((4 - data.size() % 4) % 4, '\0');
  const std::string chunks = bytes_of(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
                             bytes_of(static_cast<std::uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
  return "glTF" + bytes_of(2) + bytes_of(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

/// An archive whose members are stored as they are (PKWARE's APPNOTE 4.3).
std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string body, directory;
  for (const auto& [name, text] : members) {
    const auto size = static_cast<std::uint32_t>(text.size());
    const auto sum = static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(text.data()), size));
    const std::string common = bytes_of(20, 2) + bytes_of(0, 2) + bytes_of(0, 2) + bytes_of(0, 4) + bytes_of(sum) + bytes_of(size) +
                               bytes_of(size) + bytes_of(static_cast<std::uint32_t>(name.size()), 2) + bytes_of(0, 2);
    directory += "PK\1\2" + bytes_of(20, 2) + common + bytes_of(0, 2) + bytes_of(0, 2) + bytes_of(0, 2) + bytes_of(0) +
                 bytes_of(static_cast<std::uint32_t>(body.size())) + name;
    body += "PK\3\4" + common + name + text;
  }
  const auto count = static_cast<std::uint32_t>(members.size());
  return body + directory + "PK\5\6" + bytes_of(0) + bytes_of(count, 2) + bytes_of(count, 2) +
         bytes_of(static_cast<std::uint32_t>(directory.size())) + bytes_of(static_cast<std::uint32_t>(body.size())) + bytes_of(0, 2);
}

/// In millimetres, as the format says.
std::string three_mf() {
  const Listed l = listed_cube();
  std::ostringstream model;
  model
      << R"(<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">)"
      << R"(<resources><object id="1" type="model" name="block"><mesh><vertices>)";
  for (const Point& p : l.vertices) model << "<vertex x=\"" << p.x << "\" y=\"" << p.y << "\" z=\"" << p.z << "\"/>";
  model << "</vertices><triangles>";
  for (const Corners& t : l.triangles) model << "<triangle v1=\"" << t[0] << "\" v2=\"" << t[1] << "\" v3=\"" << t[2] << "\"/>";
  model << R"(</triangles></mesh></object></resources><build><item objectid="1"/></build></model>)";
  return stored_zip(
      {{"[Content_Types].xml",
        R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
        R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
        R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)"},
       {"_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
        R"(<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
        R"(</Relationships>)"},
       {"3D/3dmodel.model", model.str()}});
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
  folder.write("cube.bin", gltf_data());
  check_cube(folder.write("g.gltf", gltf(R"("uri":"cube.bin",)")), "block", 1.0);
  check_cube(folder.write("h.glb", glb()), "block", 1.0);
  check_cube(folder.write("i.3mf", three_mf()), "Object_1");  // assimp 5.2 names objects by their id
}

TEST_CASE("Names of OBJ objects become material slots") {
  const Folder folder;
  std::string text = indexed("v ", "f ", 1);
  text.insert(text.find("f "), "o shell\n");
  text.insert(text.rfind("f "), "o lifter\n");
  check_cube(folder.write("named.obj", text), "shell|lifter");
}
