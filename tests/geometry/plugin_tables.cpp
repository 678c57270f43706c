// The libraries as the host sees them: one symbol, a table, plain data.
#include <dlfcn.h>
#include <catch2/catch.hpp>

#include <map>

#include "tests/geometry/helpers.hpp"

using namespace geometry_test;

namespace {

struct Library {
  explicit Library(const std::string& name)
      : handle(dlopen((std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins/" + name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!handle) throw std::runtime_error(dlerror());
    list = static_cast<const DescriptorList*>(dlsym(handle, "millscope_plugins"));
  }
  ~Library() { dlclose(handle); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  const Descriptor& find(const std::string& name) const {
    for (std::uint64_t i = 0; i < list->count; ++i) {
      if (name == list->items[i]->name) return *list->items[i];
    }
    throw std::runtime_error(name + " is missing");
  }
  void* handle;
  const DescriptorList* list;
};

/// Defaults of a plugin, with some values replaced.
std::vector<Value> values_of(const Descriptor& d, const std::map<std::string, double>& numbers) {
  std::vector<Value> values;
  for (std::uint64_t i = 0; i < d.parameter_count; ++i) {
    const Parameter& p = d.parameters[i];
    Value v{p.name, p.fallback_text ? p.fallback_text : "", {p.fallback, p.fallback, p.fallback}, 1, 0};
    if (const auto found = numbers.find(p.name); found != numbers.end()) v.number[0] = v.number[1] = v.number[2] = found->second;
    values.push_back(v);
  }
  return values;
}

}  // namespace

TEST_CASE("Every geometry library exports its descriptors") {
  for (const auto& [library, names] : std::map<std::string, std::vector<std::string>>{
           {"libmesh", {"mesh"}}, {"v2/libmill", {"mill"}}, {"libprimitives", {"cylinder", "plane", "box"}}}) {
    const Library loaded(library);
    REQUIRE(loaded.list != nullptr);
    CHECK(loaded.list->magic == kMagic);
    CHECK(loaded.list->count == names.size());
    for (const std::string& name : names) {
      const Descriptor& d = loaded.find(name);
      CHECK(d.layout == kGeometryLayout);
      CHECK(d.kind == static_cast<std::uint32_t>(Kind::geometry));
      CHECK(d.table_size == sizeof(GeometryTable));
      CHECK(std::string(d.doc).size() > 10);
      for (std::uint64_t i = 0; i < d.parameter_count; ++i) CHECK(std::string(d.parameters[i].doc).size() > 10);
    }
  }
}

TEST_CASE("A mill through its table") {
  const Library loaded("v2/libmill");
  const Descriptor& d = loaded.find("mill");
  const auto& table = *static_cast<const GeometryTable*>(d.table);
  const std::vector<Value> values =
      values_of(d, {{"diameter", 0.3}, {"length", 0.02}, {"lifters", 20}, {"lifter_height", 0.005}, {"lifter_width", 0.02}});
  const Values all{values.data(), values.size()};
  void* self = nullptr;
  Failure failure{};
  REQUIRE(table.create(&all, &self, &failure) == 0);
  CHECK(std::string(table.material_slots(self)) == "shell|lifter");
  const double x[2] = {0.1426, 0}, y[2] = {0, 0}, z[2] = {0.01, 0.01}, r[2] = {0.0025, 0.0025};
  const GeometryBeads beads{2, {x, y, z}, r};
  struct Near {
    std::vector<std::int64_t> first{0, 0, 0};
    std::vector<std::uint32_t> candidates;
  } near;
  const CandidateSink sink{&near, [](void* host, std::int64_t bead, std::uint32_t candidate) {
                             Near& n = *static_cast<Near*>(host);
                             for (std::size_t i = static_cast<std::size_t>(bead) + 1; i < n.first.size(); ++i) ++n.first[i];
                             n.candidates.push_back(candidate);
                           }};
  REQUIRE(table.candidates(self, &beads, 0.0005, &sink, &failure) == 0);
  CHECK(near.first == std::vector<std::int64_t>{0, 1, 1});  // the lifter; the second bead is on the axis
  const GeometryQuery query{beads, near.first.data(), near.candidates.data(), 0};
  std::int32_t bead[4];
  double overlap[4], normal[3][4];
  std::uint32_t feature[4], triangle[4], material[4];
  GeometryContacts contacts{4, 0, bead, overlap, {normal[0], normal[1], normal[2]}, feature, triangle, material};
  table.contacts(self, &query, &contacts);
  REQUIRE(contacts.count == 1);
  CHECK(std::fabs(overlap[0] - 1e-4) < 1e-12);
  CHECK(bead[0] == 0);
  CHECK(normal[0][0] == -1);
  CHECK(material[0] == 1);
  contacts.triangle = nullptr;  // nobody asks
  table.contacts(self, &query, &contacts);
  CHECK(contacts.count == 1);
  contacts.capacity = 0;
  table.contacts(self, &query, &contacts);
  CHECK(contacts.count == 0);
  table.destroy(self);
}

TEST_CASE("A refusal crosses the boundary as one line") {
  const Library loaded("v2/libmill");
  const Descriptor& d = loaded.find("mill");
  const auto& table = *static_cast<const GeometryTable*>(d.table);
  const std::vector<Value> values =
      values_of(d, {{"diameter", 0.3}, {"length", 0.02}, {"lifters", 200}, {"lifter_height", 0.005}, {"lifter_width", 0.02}});
  const Values all{values.data(), values.size()};
  void* self = nullptr;
  Failure failure{};
  CHECK(table.create(&all, &self, &failure) != 0);
  CHECK(self == nullptr);
  CHECK(std::string(failure.message).find("overlap each other") != std::string::npos);
}
