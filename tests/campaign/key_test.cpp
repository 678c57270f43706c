// A key stands for what a result depends on, and for nothing else.
#include "studies/campaign/identity.hpp"
#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {
namespace {

std::string key_of(const Folder& folder, const std::vector<std::string>& settings) {
  return key(folder.simulation(settings), folder.options());
}

/// A triangle at a height, as STL: only read, never run.
std::string triangle(const std::string& z) {
  return "solid plate\nfacet normal 0 0 1\nouter loop\nvertex 0 0 " + z + "\nvertex 1 0 " + z + "\nvertex 1 1 " + z +
         "\nendloop\nendfacet\nendsolid plate\n";
}

}  // namespace

TEST_CASE("the key is 32 hexadecimal digits for the case, 16 for the program, and the same each time") {
  const Folder folder;
  const std::string first = key_of(folder, {});
  CHECK(first.size() == 32 + 1 + 16);
  CHECK(first.find_first_not_of("0123456789abcdef-") == std::string::npos);
  CHECK(case_of(first) == first.substr(0, 32));
  CHECK(key_of(folder, {}) == first);
}

TEST_CASE("a value of the case changes the key, its spelling does not") {
  const Folder folder;
  const std::string first = key_of(folder, {});
  CHECK(key_of(folder, {"pairs.default.restitution=0.61"}) != first);
  CHECK(key_of(folder, {"time.end_s=0.06"}) != first);
  CHECK(key_of(folder, {"seed=2"}) != first);
  CHECK(key_of(folder, {"run.partitions=9"}) != first);
  CHECK(key_of(folder, {"output.series.every_s=0.02"}) != first);  // the files of the run differ
  CHECK(key_of(folder, {"beads.glass8.diameter=0.008"}) == first);
  CHECK(key_of(folder, {"pairs.default.restitution=0.60"}) == first);
}

TEST_CASE("threads, name, checkpoints, the cache's place and the case's place leave the key") {
  const Folder folder, other;
  const std::string first = key_of(folder, {});
  CHECK(key_of(folder, {"run.threads=2"}) == first);
  CHECK(key_of(folder, {"name=Another"}) == first);
  CHECK(key_of(folder, {"output.checkpoint.every_wall_s=1"}) == first);
  CHECK(key_of(other, {}) == first);
}

TEST_CASE("an included file's values count") {
  const Folder folder;
  write(folder.path() / "more.yaml", "seed: 7\n");
  write(folder.case_file(), "include: [more.yaml]\n" + std::string(kCase));
  const std::string first = key_of(folder, {});
  CHECK(key_of(folder, {"seed=7"}) == first);
  write(folder.path() / "more.yaml", "seed: 8\n");
  CHECK(key_of(folder, {}) != first);
}

TEST_CASE("a mesh counts by its content, not by its path") {
  const Folder folder;
  const fs::path mesh = folder.path() / "plate.stl", copy = folder.path() / "copy.stl";
  write(mesh, triangle("0.1"));
  write(copy, triangle("0.1"));
  const auto key_with = [&](const fs::path& file) {
    return key_of(folder, {"geometry.plate={kind: mesh, unit: mm, material: glass, file: " + file.string() + "}"});
  };
  const std::string first = key_with(mesh);
  CHECK(key_with(copy) == first);
  write(mesh, triangle("0.2"));
  CHECK(key_with(mesh) != first);
  CHECK(key_with(copy) == first);
  fs::remove(mesh);
  CHECK_THROWS_WITH(key_with(mesh), Catch::Contains("plate.stl"));
}

TEST_CASE("what a glTF file keeps beside itself counts with it") {
  const Folder folder;
  const fs::path mesh = folder.path() / "plate.gltf";
  write(mesh, R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "plate.bin", "byteLength": 4}]})");
  write(folder.path() / "plate.bin", "abcd");
  const std::vector<std::string> settings{"geometry.plate={kind: mesh, unit: mm, material: glass, file: " + mesh.string() + "}"};
  const std::string first = key_of(folder, settings);
  CHECK(key_of(folder, settings) == first);
  write(folder.path() / "plate.bin", "abce");
  CHECK(key_of(folder, settings) != first);
}

TEST_CASE("a case that cannot be read has no key") {
  const Folder folder;
  CHECK_THROWS_WITH(key_of(folder, {"time.ends=2"}), Catch::Contains("did you mean"));
  CHECK_THROWS_WITH(key_of(folder, {"contact.law.kind=hertz_mindlim"}), Catch::Contains("hertz_mindlin"));
}

}  // namespace millscope::campaign::test
