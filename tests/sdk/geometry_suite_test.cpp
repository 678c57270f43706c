// The suite of geometries finds what is wrong with one.
#include "millscope/conformance/geometry.hpp"

#include <cmath>
#include <cstring>

#include "millscope/geometry_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault { none, short_normal, tilted_normal, deep, wrong_radius, misses, patches, slot, hides, upside_down, bad_vertex };

/// A trough: two planes that meet in the z axis at a right angle, each 0.2 m wide and 0.2 m long, wrong in one thing.
template <Fault fault>
class Trough {
 public:
  explicit Trough(const Parameters&) {
    for (const double x : {-0.2, 0.0, 0.2}) {
      for (const double z : {0.0, 0.2}) vertices_.insert(vertices_.end(), {x, std::fabs(x), z});
    }
    triangles_ = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};
    if (fault == Fault::upside_down) std::swap(triangles_[0], triangles_[1]), std::swap(triangles_[3], triangles_[4]);
    if (fault == Fault::bad_vertex) triangles_[5] = 77;
  }

  const std::string& material_slots() const { return slots_; }
  const std::string& report() const { return slots_; }
  Surface surface() const { return {6, vertices_.data(), 4, triangles_.data(), materials_}; }
  Interior interior() const { return {}; }

  void candidates(const GeometryBeads& beads, double margin, const CandidateSink& sink) {
    for (std::int64_t i = 0; i < beads.count; ++i) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        const double room = beads.radius[i] + (fault == Fault::misses ? 0.2 : 1.0) * margin;
        if (distance(side, {beads.position[0][i], beads.position[1][i], beads.position[2][i]}) < room) sink.add(sink.host, i, side);
      }
    }
  }

  void touch(const WallBead& bead, const std::uint32_t* candidates, std::size_t count, WallContacts& out) const {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t side = candidates[i];
      Vec<double> n = normal(side);
      double overlap = bead.radius - distance(side, bead.position);
      if (fault == Fault::short_normal) n = 0.9 * n;
      if (fault == Fault::tilted_normal) n = Vec<double>{n.x, std::sqrt(0.5 - 0.01), 0.1};
      if (fault == Fault::deep) overlap += 0.01;
      if (fault == Fault::wrong_radius) overlap = 1.5 * bead.radius - distance(side, bead.position) - 0.5 * 0.005;
      const auto stripe = static_cast<std::uint32_t>(std::floor(50.0 * bead.position.z + 100.0));
      const std::uint32_t feature = fault == Fault::patches ? side + 2 * stripe : side;
      if (fault == Fault::hides && ++calls_ % 7 == 0) continue;
      out.add({overlap, n, feature, 0xffffffffU, fault == Fault::slot ? 3U : 0U});
    }
  }

 private:
  static Vec<double> normal(std::uint32_t side) { return {side == 0 ? std::sqrt(0.5) : -std::sqrt(0.5), std::sqrt(0.5), 0.0}; }
  static double distance(std::uint32_t side, const Vec<double>& p) { return dot(normal(side), p); }

  std::string slots_ = "all";
  std::vector<double> vertices_;
  std::vector<std::uint32_t> triangles_;
  std::uint32_t materials_[4] = {};
  mutable int calls_ = 0;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Trough<fault>>({.name = "trough"});
  return check_geometry(descriptor, kNoValues);
}

/// The right trough behind a table of which `contacts` is another.
Violations violations_of_table(void (*contacts)(const void*, const GeometryQuery*, GeometryContacts*)) {
  static GeometryTable table;
  table = make_geometry_table<Trough<Fault::none>>();
  table.contacts = contacts;
  Descriptor descriptor = describe<Trough<Fault::none>>({.name = "trough"});
  descriptor.table = &table;
  return check_geometry(descriptor, kNoValues);
}

}  // namespace

TEST_CASE("a right geometry passes the suite") {
  CHECK_FALSE(names(violations_of<Fault::none>(), ""));
  CHECK(violations_of<Fault::none>().empty());
}

TEST_CASE("the suite finds what is wrong with a geometry") {
  CHECK(names(violations_of<Fault::short_normal>(), "unit normal"));
  CHECK(names(violations_of<Fault::tilted_normal>(), "normal"));
  CHECK(names(violations_of<Fault::deep>(), "contact where the distance says"));
  CHECK(names(violations_of<Fault::wrong_radius>(), "overlap = radius - distance"));
  CHECK(names(violations_of<Fault::misses>(), "candidates"));
  CHECK(names(violations_of<Fault::patches>(), "feature"));
  CHECK(names(violations_of<Fault::slot>(), "material slots"));
  CHECK(names(violations_of<Fault::hides>(), "determinism"));
  CHECK(names(violations_of<Fault::upside_down>(), "contact where the distance says"));
  CHECK(names(violations_of<Fault::bad_vertex>(), "surface"));
}

TEST_CASE("the suite finds what is wrong with a geometry's answers") {
  using Wall = Trough<Fault::none>;
  CHECK(names(violations_of_table([](const void* self, const GeometryQuery* query, GeometryContacts* out) {
                GeometryQuery far = *query;
                far.reach *= 2.0;
                find_contacts<Wall>(self, &far, out);
              }),
              "nothing beyond reach"));
  CHECK(names(violations_of_table([](const void* self, const GeometryQuery* query, GeometryContacts* out) {
                find_contacts<Wall>(self, query, out);
                for (std::int64_t i = 0; i < out->count; ++i)
                  out->bead[i] = static_cast<std::int32_t>(query->beads.count - 1) - out->bead[i];
              }),
              "order"));
  CHECK(names(violations_of_table([](const void* self, const GeometryQuery* query, GeometryContacts* out) {
                find_contacts<Wall>(self, query, out);
                if (out->count == out->capacity) out->count -= 1;
              }),
              "capacity"));
  CHECK(names(violations_of_table([](const void* self, const GeometryQuery* query, GeometryContacts* out) {
                find_contacts<Wall>(self, query, out);
                if (query->beads.count > 1) {
                  for (std::int64_t i = 0; i < out->count; ++i) out->feature[i] += 2;
                }
              }),
              "bead by bead"));
  CHECK(names(violations_of_table([](const void* self, const GeometryQuery* query, GeometryContacts* out) {
                find_contacts<Wall>(self, query, out);
                if (out->triangle == nullptr) out->count = std::min<std::int64_t>(out->count, 1);
              }),
              "triangles"));
}
