// Which beads of a simulation stand for the recorded one.
#include "studies/calibrate/bead_paths.hpp"

#include <fmt/format.h>

#include <numbers>

#include "kernel/output/frames.hpp"
#include "tests/calibrate/made_up_mill.hpp"
#include "tests/plugins.hpp"

using namespace millscope;
using calibrate::BeadPaths;
using Catch::WithinRel;
using testing::registry;

namespace {

constexpr double kRadius = 0.002, kHeavier = 2;
constexpr double kX[] = {0.02, 0.04, 0.06, 0.06};  // m; the last two are tracers

const std::string kCharge = "charge: {material: glass, diameter: 4 mm, share: 50 %}, ";
const std::string kHeavy = kCharge + "heavy: {material: glass, density: 5000, diameter: 4 mm, share: 50 %}";
const std::string kTracers = kCharge + "marked: {material: glass, density: 5000, diameter: 4 mm, share: 50 %, tracer: true}";
const std::string kAlike = kCharge +
                           "heavy: {material: glass, density: 5000, diameter: 4 mm, share: 25 %}, "
                           "marked: {material: glass, density: 5000, diameter: 4 mm, share: 25 %, tracer: true}";

/// Four beads at rest beside the axis of a drum, two of them heavy.
void write_run(const testing::Folder& folder, const std::string& beads) {
  folder.write("case.resolved.yaml", fmt::format(R"(schema_version: 1
materials: {{glass: {{density: 2500, young_modulus: 1e8, poisson_ratio: 0.23}}}}
beads: {{{}}}
fill: {{count: 4, shares_by: number}}
contact: {{law: {{kind: hertz_mindlin}}}}
pairs: {{glass~glass: {{restitution: 0.8, static_friction: 0.3}}}}
body_forces: {{gravity: {{kind: gravity}}}}
mill: {{diameter: 200 mm, speed: 2 rad/s}}
geometry: {{shell: {{kind: cylinder, radius: 100 mm, length: 50 mm, end_faces: false, material: glass, motion: mill}}}}
domain: {{periodic: {{z: [0, 50 mm]}}}}
time: {{end_s: 1, analyze_from_s: 0}}
)",
                                                 beads));
  const double light = 2500 * 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
  const std::vector<std::uint32_t> id{0, 1, 2, 3}, material(4, 0);
  const std::vector<double> radius(4, kRadius), mass{light, light, kHeavier * light, kHeavier * light};
  auto writer = output::FrameWriter::create(folder.path / "frames.h5", {id, radius, mass, material, {"glass"}, {"shell"}, {}});
  for (int f = 0; f < 6; ++f) {
    std::vector<double> position;
    for (const double x : kX) position.insert(position.end(), {x, 0.0, 0.025});
    const std::vector<double> rest(12, 0.0), work{0.0};
    writer.append({0.01 * f, 0, 2, work, {}, {}, position, rest, rest});
  }
  writer.close();
}

}  // namespace

TEST_CASE("where a class is set apart, its beads are followed and the power is that of the others") {
  const testing::Folder folder;
  write_run(folder, kTracers);
  const BeadPaths paths(folder.path, 100, {}, registry());
  REQUIRE(paths.size() == 2);
  CHECK_THAT(paths.path(0, 1e-3).position[0].front(), WithinRel(0.06, 1e-6));
  CHECK_THAT(paths.path(1, 1e-3).position[0].front(), WithinRel(0.06, 1e-6));
  // Four beads like the first two, 4 m 0.03, over the beads as they are, m (0.02 + 0.04) + 2 m (0.06 + 0.06).
  CHECK_THAT(paths.power_ratio(), WithinRel(0.12 / 0.30, 1e-6));
  CHECK_THAT(paths.mill().context.bead_density, WithinRel(2500.0, 1e-9));
  CHECK(BeadPaths(folder.path, 1, {}, registry()).size() == 1);
}

TEST_CASE("where none is, any bead is followed and the power is that of all") {
  const testing::Folder folder;
  write_run(folder, kHeavy);
  const BeadPaths paths(folder.path, 100, {}, registry());
  CHECK(paths.size() == 4);
  CHECK(paths.power_ratio() == 1);
  CHECK_THAT(paths.mill().context.bead_density, WithinRel(3750.0, 1e-9));
}

TEST_CASE("beads of the charge that are like the tracers count by their numbers") {
  const testing::Folder folder;
  write_run(folder, kAlike);
  const BeadPaths paths(folder.path, 100, {}, registry());
  CHECK(paths.size() == 2);
  // Every second heavy bead is of the charge: 4/3 (m 0.06 + ½ 2 m 0.12) over m 0.06 + 2 m 0.12.
  CHECK_THAT(paths.power_ratio(), WithinRel(0.24 / 0.30, 1e-6));
}
