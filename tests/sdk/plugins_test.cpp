// Every plugin that comes with millscope holds to the suite of its kind, with its options.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "millscope/conformance.hpp"
#include "scratch.hpp"

using namespace millscope;
using namespace millscope::conformance;
namespace fs = std::filesystem;

namespace {

/// The best build of every library of this build, and what they list.
const std::vector<const Descriptor*>& all_plugins() {
  static const std::vector<const Descriptor*> all = [] {
    const std::string directory = std::string(MILLSCOPE_BINARY_DIR) + "/lib/millscope/plugins";
    std::set<std::string> libraries;
    for (const char* folder : {"", "/v2"}) {
      for (const fs::directory_entry& entry : fs::directory_iterator(directory + folder)) {
        if (entry.path().extension() == ".so") libraries.insert(entry.path().stem().string().substr(3));
      }
    }
    std::vector<const Descriptor*> found;
    for (const std::string& library : libraries) {
      const DescriptorList& list = open_library(best_build(directory, library));
      found.insert(found.end(), list.items, list.items + list.count);
    }
    return found;
  }();
  return all;
}

/// What to try a plugin with: its defaults, and values for what has no default.
using Options = std::map<std::string, std::vector<std::string>>;

template <class Check>
void check_all(Kind kind, const Options& options, const Check& check) {
  std::size_t checked = 0;
  for (const Descriptor* descriptor : all_plugins()) {
    if (descriptor->kind != static_cast<std::uint32_t>(kind)) continue;
    const auto found = options.find(descriptor->name);
    for (const std::string& text : found == options.end() ? std::vector<std::string>{""} : found->second) {
      INFO(descriptor->name << ' ' << text);
      ValueSet values(*descriptor);
      values.read(text);
      for (const Violation& v : check(*descriptor, values.view())) FAIL_CHECK(v.check << ": " << v.message);
      ++checked;
    }
  }
  CHECK(checked >= 3);
}

/// The inside of a box of 0.2 m × 0.1 m × 0.1 m, drawn in mm.
void write_box(const std::string& path) {
  const double x[2] = {0, 200}, y[2] = {0, 100}, z[2] = {0, 100};
  const int faces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};  // corner = x + 2 y + 4 z
  std::ofstream file(path);
  file << "solid wall\n";
  for (const auto& face : faces) {
    for (const auto& corners : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      file << "facet normal 0 0 0\nouter loop\n";
      for (const int c : corners) file << "vertex " << x[face[c] & 1] << ' ' << y[face[c] >> 1 & 1] << ' ' << z[face[c] >> 2] << '\n';
      file << "endloop\nendfacet\n";
    }
  }
  file << "endsolid wall\n";
}

}  // namespace

TEST_CASE("every wear law holds to the suite of its kind") {
  check_all(Kind::wear_law,
            {{"archard", {"wear_coefficient=0.007 hardness=1.8e9", "wear_coefficient=0 hardness=1e6"}},
             {"finnie", {"cutting_share=0.1 hardness=1.8e9", "cutting_share=1 hardness=1e6"}}},
            [](const Descriptor& d, const Values& values) { return check_wear_law(d, values); });
}

TEST_CASE("every pair parameter holds to the suite of its kind") {
  check_all(Kind::pair_parameter,
            {{"restitution_by_speed",
              {"reference_restitution=0.8", "reference_restitution=0.5 form=plastic", "reference_restitution=0.8 strength=0"}},
             {"friction_by_speed", {"static_friction=0.4 kinetic_ratio=0.5", "static_friction=0.4 kinetic_ratio=1"}}},
            [](const Descriptor& d, const Values& values) { return check_pair_parameter(d, values); });
}

TEST_CASE("every body force holds to the suite of its kind") {
  check_all(Kind::body_force,
            {{"gravity", {"", "angle=0.5 magnitude=3"}},
             {"air_drag", {"", "flow=turning angular_velocity=-6", "strength=0"}},
             {"fluid_pool", {"", "flow=turning angular_velocity=-6 porosity=0.4", "fluid_density=0", "level=0.05"}}},
            [](const Descriptor& d, const Values& values) { return check_body_force(d, values); });
}

TEST_CASE("every observation holds to the suite of its kind") {
  const std::set<std::string> keep_times = {"error_cut", "gaps", "noise", "outliers", "location_blur"};
  check_all(Kind::observation,
            {{"sampling", {"", "rate=200", "rate=200 dead_time=0.002 shape=4"}},
             {"location_blur", {"", "window=0.02"}},
             {"noise", {"", "white=0.001 growth=2", "correlated=0.001 correlation_time=0.01"}},
             {"error_cut", {"", "cut=0.002 spread=0.001 per_distance=0.01 per_speed=0.001 scatter=0.0005"}},
             {"gaps", {"", "rate=2 mean_length=0.1"}},
             {"outliers", {"", "fraction=0.1 distance=0.05"}},
             {"frame_error", {"", "offset_x=0.01 tilt_z=0.1 scale=0.02 clock=0.01", "clock=-0.5"}}},
            [&](const Descriptor& d, const Values& values) {
              ObservationSetting setting;
              setting.keeps_times = keep_times.contains(d.name);
              return check_observation(d, values, setting);
            });
}

TEST_CASE("every geometry holds to the suite of its kind") {
  const testing::Scratch scratch;
  const std::string box = (scratch.path / "box.stl").string();
  write_box(box);
  check_all(Kind::geometry,
            {{"cylinder", {"radius=0.15 length=0.1", "radius=0.15 length=0.1 end_faces=1"}},
             {"plane", {"normal=1", "normal=1 point=0.2 size=0.5"}},
             {"box", {"low=-0.1 high=0.2"}},
             {"mill",
              {"diameter=0.3 length=0.1", "diameter=0.3 length=0.1 lifters=8 lifter_height=0.02 lifter_width=0.05",
               "diameter=0.3 length=0.1 lifters=8 lifter_height=0.02 lifter_width=0.05 end_faces=1 phase=0.3"}},
             {"mesh", {"unit=mm file=" + box}},
             {"step", {"file=" MILLSCOPE_SOURCE_DIR "/tests/sdk/shell.step"}}},
            [](const Descriptor& d, const Values& values) {
              GeometrySetting setting;
              setting.bead_radius = 5e-3;
              setting.surface_tolerance = 2e-5;
              return check_geometry(d, values, setting);
            });
}

TEST_CASE("every analyzer holds to the suite of its kind") {
  // A circulation that a block's end cuts counts as unfinished in both; cells that a bead has visited are counted block by block.
  const std::set<std::string> cut_by_blocks = {"circulation", "ergodicity"};
  check_all(Kind::analyzer, {}, [&](const Descriptor& d, const Values& values) {
    AnalyzerSetting setting;
    setting.blocks_join = !cut_by_blocks.contains(d.name);
    return check_analyzer(d, values, setting);
  });
}
