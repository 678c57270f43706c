// A picture of the bed, or the angle of its surface, in the place of a recording.
#include "studies/calibrate/silhouette.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "millscope/silhouette.hpp"
#include "studies/calibrate/observe.hpp"
#include "studies/calibrate/validate.hpp"
#include "tests/calibrate/figure_drum.hpp"

using namespace millscope;
using calibrate::RecordedCondition;
using Catch::WithinAbs;
using testing::kDrumRadius;
using testing::registry;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A bed with a flat surface that slopes by `angle` and lies `depth` (in radii) beneath the axis; it rises to the right.
struct Bed {
  double angle = 35, depth = 0.1;
  bool covers(double x, double y) const { return x * std::sin(angle * kDegree) - y * std::cos(angle * kDegree) > depth; }
};

/// A PGM of `size` pixels with the drum in its middle, `margin` pixels from its sides.
void write_picture(const std::filesystem::path& file, const Bed& bed, int size, int margin, bool mirrored, int covered = 30, int free = 240,
                   int noise = 0) {
  std::ofstream out(file, std::ios::binary);
  out << "P5\n" << size << ' ' << size << "\n255\n";
  const double radius = 0.5 * size - margin;
  for (int j = 0; j < size; ++j) {
    for (int i = 0; i < size; ++i) {
      const double x = (mirrored ? -1 : 1) * (i + 0.5 - 0.5 * size) / radius, y = -(j + 0.5 - 0.5 * size) / radius;
      const int grey = std::hypot(x, y) > 1 ? 255 : bed.covers(x, y) ? covered : free;
      out.put(static_cast<char>(std::clamp(grey + noise * ((i * 7 + j * 13) % 5 - 2) / 2, 0, 255)));
    }
  }
}

struct Drum : testing::FigureDrum {
  explicit Drum(const std::string& recording = "silhouette: {file: bed.pgm}\n", const std::string& more = "")
      : FigureDrum(recording, more) {
    write_picture(folder.path / "bed.pgm", Bed(), 400, 0, false);
  }
};

/// Small beads all over the bed, seen `frames` times.
void write_run(const testing::Folder& folder, const Bed& bed, double omega, int frames = 6) {
  testing::FrozenBeads beads{{}, {}, 0.0005, omega, frames};
  for (double x = -kDrumRadius; x <= kDrumRadius; x += 0.0005) {
    for (double y = -kDrumRadius; y <= kDrumRadius; y += 0.0005) {
      if (std::hypot(x, y) <= kDrumRadius && bed.covers((omega < 0 ? -1 : 1) * x / kDrumRadius, y / kDrumRadius))
        beads.position.insert(beads.position.end(), {x, y, 0.025});
    }
  }
  beads.velocity.assign(beads.position.size(), 0.0);
  testing::write_run(folder, beads);
}

}  // namespace

TEST_CASE("the rings of a flat bed are what geometry says") {
  constexpr int n = 400;
  const Bed bed;
  std::vector<double> covered;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) covered.push_back(bed.covers((i + 0.5) * 2 / n - 1, (j + 0.5) * 2 / n - 1) ? 1 : 0);
  }
  const SilhouetteShape shape = silhouette_shape(covered.data(), n);
  CHECK_THAT(std::atan(shape.slope) / kDegree, WithinAbs(bed.angle, 0.1));
  CHECK_THAT(shape.area, WithinAbs((std::acos(0.1) - 0.1 * std::sqrt(1 - 0.01)) / std::numbers::pi, 1e-3));
  REQUIRE(shape.rings.size() == kSilhouetteRings);
  for (const SilhouetteRing& ring : shape.rings) {
    const double r = 0.5 * (ring.inner + ring.outer);
    CHECK_THAT(ring.share, WithinAbs(std::acos(bed.depth / r) / std::numbers::pi, 0.006));  // the ring is 0.1 wide
    CHECK_THAT(ring.direction / kDegree, WithinAbs(bed.angle, 0.5));
    CHECK(ring.edge == 0);
  }
}

TEST_CASE("a blurred edge is as wide as it is") {
  constexpr int n = 400;
  constexpr double kWidth = 0.06;  // from wholly covered to free, linearly: 4 P (1 − P) has a mean of 2/3
  std::vector<double> covered;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) covered.push_back(std::clamp(0.5 - ((j + 0.5) * 2 / n - 1) / kWidth, 0.0, 1.0));
  }
  const SilhouetteShape shape = silhouette_shape(covered.data(), n);
  CHECK_THAT(shape.rings.back().edge, WithinAbs(2.0 / 3 * kWidth, 0.002));
}

TEST_CASE("a picture and simulated beads of the same bed are measured alike, whichever way they lean") {
  for (const double omega : {2.0, -2.0}) {
    for (const bool mirrored : {false, true}) {
      const Drum drum("silhouette: {file: p.pgm, drum: {centre: [230, 230], diameter: 440}}\n");
      write_picture(drum.folder.path / "p.pgm", Bed(), 460, 10, mirrored);
      write_run(drum.folder, Bed(), omega);
      const RecordedCondition r = drum.look();
      REQUIRE(r.observation.value.size() == 2 * kSilhouetteRings);
      const calibrate::Observation simulated = drum.seen(r);
      for (Eigen::Index i = 0; i < r.observation.value.size(); ++i) {
        INFO(r.observation.observables[i].name);
        CHECK_THAT(simulated.value[i], WithinAbs(r.observation.value[i], 0.5));
      }
    }
  }
}

TEST_CASE("a shallow bed leans to its side, though its inner rings are free") {
  for (const bool mirrored : {false, true}) {
    const Drum drum("silhouette: {file: p.pgm}\n");
    write_picture(drum.folder.path / "p.pgm", {30, 0.45}, 400, 0, mirrored);
    const RecordedCondition r = drum.look();
    REQUIRE(r.observation.value.size() < 2 * kSilhouetteRings);  // free rings have no direction
    CHECK(r.observation.observables.back().name == "direction of the ring 0.85–0.95 R");
    CHECK_THAT(r.observation.value[r.observation.value.size() - 1], WithinAbs(30, 0.5));
    CHECK(r.observation.covariance.ldlt().vectorD().minCoeff() > 0);  // nothing is known without error
  }
}

TEST_CASE("noise of a picture makes no edge") {
  const Drum drum("silhouette: {file: p.pgm}\n");
  write_picture(drum.folder.path / "p.pgm", Bed(), 400, 0, false, 30, 240, 15);
  const RecordedCondition noisy = drum.look(), clear = Drum().look();
  CHECK((noisy.observation.value - clear.observation.value).cwiseAbs().maxCoeff() < 0.5);
}

TEST_CASE("light beads on a dark ground are covered where they are light") {
  const Drum drum("silhouette: {file: p.pgm}\n");
  write_picture(drum.folder.path / "p.pgm", Bed(), 400, 0, false, 220, 40);
  const RecordedCondition light = drum.look(), dark = Drum().look();
  CHECK((light.observation.value - dark.observation.value).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("the camera's stand is one error of all directions, the outline's place one of all shares") {
  const RecordedCondition r = Drum("silhouette: {file: bed.pgm, angle_error: 2 deg, edge_error: 1 mm}\n").look();
  const Eigen::MatrixXd& c = r.observation.covariance;
  CHECK_THAT(c(1, 3), WithinAbs(4, 1e-9));
  CHECK_THAT(std::sqrt(c(1, 1)), WithinAbs(2, 0.1));  // the edge is sharp but for the cells: little is its own
  CHECK_THAT(std::sqrt(c(0, 2)), WithinAbs(100 * 2 * 0.001 / (2 * std::numbers::pi * kDrumRadius * std::sqrt(0.2 * 0.3)), 0.02));
  CHECK(c(0, 1) == 0);
}

TEST_CASE("a slice that repeats is noted, a mill that stands is refused") {
  const Drum drum;
  REQUIRE(drum.look().observation.notes.size() == 2);
  CHECK(drum.look().observation.notes[0].find("periodic along z") != std::string::npos);
  std::string still = testing::drum_case(10, 1);
  still.replace(still.find("speed: 2 rad/s"), 14, "speed: 0 rad/s");
  drum.folder.write("drum.yaml", still);
  CHECK(testing::message_of([&] { drum.look(); }).find("speed") != std::string::npos);
}

TEST_CASE("the angle of the surface alone may be compared") {
  const Drum drum("surface_angle: {value: 35 deg, error: 0.5 deg}\n");
  write_run(drum.folder, Bed(), 2);
  const RecordedCondition r = drum.look();
  REQUIRE(r.observation.value.size() == 1);
  CHECK_THAT(r.observation.value[0], WithinAbs(35, 1e-9));
  CHECK_THAT(r.observation.covariance(0, 0), WithinAbs(0.25, 1e-9));
  CHECK_THAT(drum.seen(r).value[0], WithinAbs(35, 0.3));
}

TEST_CASE("a run that is one block long has no uncertainty, and is refused") {
  const Drum drum;
  write_run(drum.folder, Bed(), 2, 1);
  CHECK_THAT(testing::message_of([&] { drum.seen(drum.look()); }), Catch::Contains("too short for an uncertainty"));
}

TEST_CASE("what is wrong with a silhouette is said with its place") {
  const auto said = [](const std::string& text) {
    const Drum drum(text);
    drum.folder.write("notes.txt", "no picture\n");
    write_picture(drum.folder.path / "pale.pgm", Bed(), 400, 0, false, 120, 130);
    write_picture(drum.folder.path / "small.pgm", Bed(), 60, 0, false);
    return testing::message_of([&] { drum.figure(); });
  };
  CHECK(said("silhouette: {file: gone.png}\n").find("r.yaml:1") != std::string::npos);
  CHECK_THAT(said("silhouette: {file: notes.txt}\n"), Catch::Contains("r.yaml:1") && Catch::Contains("is no picture that can be read"));
  CHECK(said("silhouette: {file: pale.pgm}\n").find("as grey where the drum is covered (120) as where it is free (130)") !=
        std::string::npos);
  CHECK(said("silhouette: {file: small.pgm}\n").find("60 pixels wide") != std::string::npos);
  CHECK(said("silhouette: {file: bed.pgm, drum: {centre: [10, 10], diameter: 300}}\n").find("partly outside") != std::string::npos);
  CHECK(said("silhouette: {file: bed.pgm, drum: {centre: [10], diameter: 300}}\n").find("wants two numbers") != std::string::npos);
  CHECK(said("silhouette: {file: bed.pgm, angle_error: 0 deg}\n").find("standard error") != std::string::npos);
  CHECK_THAT(said("silhouette: {file: bed.pgm, greys: {covered: 100, free: 110}}\n"),
             Catch::Contains("greys") && Catch::Contains("is as grey"));
  CHECK(said("silhouette: {file: bed.pgm, greys: {covered: -5, free: 110}}\n").find("it is a grey") != std::string::npos);
  CHECK(said("silhouette: {file: bed.pgm, blur: 1}\n").find("unknown key 'blur'") != std::string::npos);
  CHECK(said("surface_angle: {value: 100 deg, error: 1 deg}\n").find("r.yaml:1") != std::string::npos);
  CHECK(said("surface_angle: {value: 30 deg}\n").find("error") != std::string::npos);
  const Drum tracks("silhouette: {file: bed.pgm}\n", "objective: chagas2015\n");
  CHECK(testing::message_of([&] {
          calibrate::check_recordings(tracks.study, calibrate::read_recordings(tracks.study), registry());
        }).find("is a silhouette, and chagas2015 compares tracks") != std::string::npos);
}
