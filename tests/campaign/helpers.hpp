// A folder with a tiny case, for tests of campaigns.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "kernel/base/text.hpp"
#include "studies/campaign/campaign.hpp"
#include "tests/scratch.hpp"

namespace millscope::campaign::test {

namespace fs = std::filesystem;

inline void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

/// 60 beads in a small drum, soft: a tenth of a second of computing.
inline constexpr const char* kCase = R"(schema_version: 1
name: Tiny drum
stiffness_factor: 0.0002
materials:
  glass: {density: 2500, shear_modulus: 26 GPa, poisson_ratio: 0.23}
beads:
  glass8: {material: glass, diameter: 8 mm}
fill: {count: 60, settle_s: 0}
contact:
  law: {kind: hertz_mindlin}
pairs:
  default: {restitution: 0.6, static_friction: 0.3}
body_forces:
  gravity: {kind: gravity}
mill: {diameter: 150 mm, speed: 75 %critical}
geometry:
  liner: {kind: mill, diameter: 150 mm, length: 26 mm, lifters: 6, lifter_height: 6 mm, lifter_width: 14 mm, lifter_face_angle: 60 deg, material: glass, motion: mill}
domain:
  periodic: {z: [0, 26 mm]}
time: {end_s: 0.05}
output:
  series: {every_s: 0.01}
)";

class Folder {
 public:
  Folder() {
    write(case_file(), kCase);
    REQUIRE(fs::is_regular_file(case_file()));
  }
  const fs::path& path() const { return scratch_.path; }
  fs::path case_file() const { return scratch_ / "case.yaml"; }

  Simulation simulation(std::vector<std::string> settings = {}) const { return {case_file(), std::move(settings), "tiny"}; }
  Options options() const {
    Options o;
    o.cache = scratch_ / "cache";
    o.program = fs::path(MILLSCOPE_BINARY_DIR) / "bin" / "millscope";
    o.quiet = true;
    return o;
  }

 private:
  testing::Scratch scratch_;
};

}  // namespace millscope::campaign::test
