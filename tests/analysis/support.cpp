#include "analysis/support.hpp"

#include <cmath>
#include <numbers>

#include "kernel/output/frames.hpp"
#include "kernel/output/tracks.hpp"

namespace analysis_test {

namespace {

constexpr double kPeriod = 0.05, kBead = 0.002, kDensity = 2500;

constexpr const char* kCase = R"(schema_version: 1
name: Drum
materials:
  glass: {density: 2500, young_modulus: 1e8, poisson_ratio: 0.23}
beads:
  glass4: {material: glass, diameter: 4 mm}
fill: {count: 6}
contact:
  law: {kind: hertz_mindlin}
pairs:
  glass~glass: {restitution: 0.8, static_friction: 0.3}
body_forces:
  gravity: {kind: gravity}
mill: {diameter: 200 mm, speed: 2 rad/s, direction: clockwise}
geometry:
  shell: {kind: cylinder, radius: 100 mm, length: 50 mm, end_faces: false, material: glass, motion: mill}
domain:
  periodic: {z: [0, 50 mm]}
time: {end_s: 5, analyze_from_s: 1}
)";

double wrapped(double z) { return z - kPeriod * std::floor(z / kPeriod); }

}  // namespace

void Drum::write_case(const fs::path& directory) const {
  fs::create_directories(directory);
  spill(directory / "case.resolved.yaml", kCase);
}

void Drum::write_frames(const fs::path& directory) const {
  std::vector<std::uint32_t> id, material(beads, 0);
  std::vector<double> radius_of(beads, kBead), mass(beads, kDensity * 4 / 3 * std::numbers::pi * kBead * kBead * kBead);
  for (std::size_t k = 0; k < beads; ++k) id.push_back(static_cast<std::uint32_t>(k));
  auto writer = output::FrameWriter::create(
      directory / "frames.h5",
      {id, radius_of, mass, material, {"glass"}, {"shell"}, {"glass~glass:damping"}, {"glass~glass"}, {1e-6, 1e-5, 1e-4}});
  for (std::size_t f = 0; f < frames; ++f) {
    const double time = start + step * static_cast<double>(f);
    std::vector<double> position, velocity, spin(3 * beads, omega);
    for (std::size_t k = 0; k < beads; ++k) {
      const double a = angle(k, time), r = radius(k);
      position.insert(position.end(), {r * std::cos(a), r * std::sin(a), wrapped(z(k, time))});
      velocity.insert(velocity.end(), {-omega * r * std::sin(a), omega * r * std::cos(a), 0.0});
    }
    const std::vector<double> work{power * time}, lost{0.5 * power * time};
    const std::vector<std::uint64_t> impacts{10 * f, 3 * f};
    writer.append({time, omega * time, at_rest_first && f == 0 ? 0.0 : omega, work, lost, impacts, position, velocity, spin});
  }
  writer.close();
}

void Drum::write_tracks(const fs::path& directory) const {
  const std::vector<output::TrackInfo> infos{{"bead_0", 0, 2 * kBead, kDensity, "simulation"},
                                             {"bead_3", 3, 2 * kBead, kDensity, "simulation"}};
  auto writer = output::TrackWriter::create(directory / "tracks.h5", infos);
  for (int i = 0; i <= static_cast<int>(track_seconds * 2000); ++i) {
    const double time = 0.0005 * i;
    std::vector<double> position;
    for (const std::size_t k : {0U, 3U}) {
      const double a = angle(k, time), r = radius(k);
      position.insert(position.end(), {r * std::cos(a), r * std::sin(a), wrapped(z(k, time))});
    }
    writer.append(time, position);
  }
  writer.close();
}

void Drum::write(const fs::path& directory) const {
  write_case(directory);
  write_frames(directory);
  write_tracks(directory);
}

}  // namespace analysis_test
