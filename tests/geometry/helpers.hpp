// Meshes to test with, and the way from a bead to its contacts.
#pragma once

#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "geometry/mesh/mesh.hpp"
#include "tests/scratch.hpp"

namespace geometry_test {

using namespace millscope;
using namespace millscope::geometry;

inline void add_triangle(Soup& soup, const Point& a, const Point& b, const Point& c, std::uint32_t slot = 0) {
  for (const Point& p : {a, b, c}) soup.corners.push_back(p);
  soup.slots.push_back(slot);
}
inline void add_quad(Soup& soup, const Point& a, const Point& b, const Point& c, const Point& d, std::uint32_t slot = 0) {
  add_triangle(soup, a, b, c, slot);
  add_triangle(soup, a, c, d, slot);
}
inline Soup empty_soup() {
  Soup s;
  s.names = {"all"};
  return s;
}

/// Cube of side s with its lowest corner at 0, facing outwards.
inline Soup cube(double s) {
  Soup m = empty_soup();
  add_quad(m, {0, 0, 0}, {0, s, 0}, {s, s, 0}, {s, 0, 0});
  add_quad(m, {0, 0, s}, {s, 0, s}, {s, s, s}, {0, s, s});
  add_quad(m, {0, 0, 0}, {s, 0, 0}, {s, 0, s}, {0, 0, s});
  add_quad(m, {0, s, 0}, {0, s, s}, {s, s, s}, {s, s, 0});
  add_quad(m, {0, 0, 0}, {0, 0, s}, {0, s, s}, {0, s, 0});
  add_quad(m, {s, 0, 0}, {s, s, 0}, {s, s, s}, {s, 0, s});
  return m;
}

/// Square [0, side]² at z = 0 in n × n quads.
inline Soup sheet(double side, int n) {
  Soup m = empty_soup();
  const double h = side / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = i * h, y = j * h;
      add_quad(m, {x, y, 0}, {x + h, y, 0}, {x + h, y + h, 0}, {x, y + h, 0});
    }
  }
  return m;
}

inline Soup soup_of(const Surface& s, const std::vector<std::string>& names) {
  Soup m;
  m.names = names;
  for (std::uint64_t i = 0; i < 3 * s.triangle_count; ++i) {
    const double* v = s.vertices + 3 * s.triangles[i];
    m.corners.push_back({v[0], v[1], v[2]});
  }
  m.slots.assign(s.triangle_materials, s.triangle_materials + s.triangle_count);
  return m;
}

inline std::unique_ptr<Mesh> make_mesh(const Soup& soup, MeshOptions options = {}) {
  if (options.label.empty()) options.label = "test";
  return std::make_unique<Mesh>(soup, options);
}

/// Candidates of each bead.
template <class Wall>
std::vector<std::vector<std::uint32_t>> candidates_of(Wall& wall, const std::vector<Point>& points, double radius, double margin) {
  std::vector<double> x, y, z, r(points.size(), radius);
  for (const Point& p : points) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
  std::vector<std::vector<std::uint32_t>> found(points.size());
  const CandidateSink sink{&found, [](void* host, std::int64_t bead, std::uint32_t feature) {
                             (*static_cast<std::vector<std::vector<std::uint32_t>>*>(host))[bead].push_back(feature);
                           }};
  wall.candidates({static_cast<std::int64_t>(points.size()), {x.data(), y.data(), z.data()}, r.data()}, margin, sink);
  return found;
}

/// As the host asks: one bead.
template <class Wall>
WallContacts contacts_of(const Wall& wall, const Point& p, double radius, const std::vector<std::uint32_t>& candidates, double reach = 0) {
  constexpr int kMost = 64;
  std::int32_t bead[kMost];
  double overlap[kMost], normal[3][kMost];
  std::uint32_t feature[kMost], triangle[kMost], material[kMost];
  GeometryContacts found{kMost, 0, bead, overlap, {normal[0], normal[1], normal[2]}, feature, triangle, material};
  const std::int64_t first[2] = {0, std::ssize(candidates)};
  const GeometryQuery query{{1, {&p.x, &p.y, &p.z}, &radius}, first, candidates.data(), reach};
  find_contacts<Wall>(&wall, &query, &found);
  WallContacts out(reach);
  for (int k = 0; k < found.count; ++k) {
    out.add({overlap[k], {normal[0][k], normal[1][k], normal[2][k]}, feature[k], triangle[k], material[k]});
  }
  return out;
}

/// Both in one.
template <class Wall>
WallContacts touch(Wall& wall, const Point& p, double radius, double reach = 0) {
  return contacts_of(wall, p, radius, candidates_of(wall, {p}, radius, reach + 0.1 * radius)[0], reach);
}

/// Values of one plugin object for a test, by hand.
class Given {
 public:
  Given& number(const char* name, double a, double b = 0, double c = 0) {
    items_.push_back({name, "", {a, b, c}, 1, 0});
    return *this;
  }
  Given& text(const char* name, const char* value) {
    items_.push_back({name, value, {0, 0, 0}, 1, 0});
    return *this;
  }
  Parameters parameters() const { return Parameters({items_.data(), items_.size()}); }

 private:
  std::vector<Value> items_;
};

/// A folder that goes away again.
class Folder {
 public:
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(scratch_ / name, std::ios::binary) << content;
    return path(name);
  }
  std::string path(const std::string& name) const { return (scratch_ / name).string(); }

 private:
  testing::Scratch scratch_;
};

}  // namespace geometry_test
