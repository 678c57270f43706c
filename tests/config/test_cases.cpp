// The cases that come with millscope.
#include <filesystem>

#include "tests/config/helpers.hpp"

using namespace millscope::config;
namespace fs = std::filesystem;

namespace {

const fs::path kConfigs = fs::path(MILLSCOPE_SOURCE_DIR) / "configs";

Case read(const std::string& name) { return read_case((kConfigs / name).string()); }

}  // namespace

TEST_CASE("every case in configs is read") {
  int cases = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kConfigs)) {
    const std::string name = entry.path().filename().string();
    const bool part =
        name.find("common") != std::string::npos || name == "study.yaml" || entry.path().parent_path().filename() == "materials";
    if (entry.path().extension() != ".yaml" || part || !load_document_with_paths(entry.path().string()).has("materials")) continue;
    INFO(entry.path());
    const Case c = read_case(entry.path().string());
    CHECK(bead_count(c) > 200);  // the story's small mill holds 241
    CHECK(!c.geometry.empty());
    ++cases;
  }
  CHECK(cases >= 9);
}

TEST_CASE("the cross-check case is that of the reference") {
  const Case c = read("crosscheck/slice.yaml");
  CHECK(bead_count(c) == 4259);
  CHECK(c.mill->speed == Approx(6.1168).epsilon(3e-5));
  for (const MaterialCase& m : c.materials) CHECK(c.softened_young(m) == Approx(63.96e6));
  CHECK(static_cast<double>(bead_count(c)) * c.mean_bead_mass() == Approx(0.69688).epsilon(1e-5));
  CHECK(c.time.analyze_from == 2.5);
}

TEST_CASE("the study's cases") {
  const Case full = read("chagas2015/full_75.yaml");
  CHECK(bead_count(full) == 57501);
  CHECK(full.mill->speed < 0);
  CHECK_FALSE(full.domain.periodic[2]);
  CHECK(full.geometry[0].material_of("end") == "hdpe");
  CHECK(full.geometry[0].material_of("lifter") == "nylon");
  const Case slice = read("chagas2015/slice_50.yaml");
  CHECK(bead_count(slice) == 4259);
  CHECK(slice.mill->speed / *slice.mill->critical_speed == Approx(-0.5));
}
