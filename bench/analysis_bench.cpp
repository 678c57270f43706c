// How fast a simulation of many frames is analysed: reading, all analyzers, resampling.
//   millscope_analysis_bench --beads 58000 --frames 1500 --threads 1
// The frames are made up: beads that circulate in a drum of 0.3 m. They are written once and removed at the end.
#include <fmt/format.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>

#include "bench/program.hpp"
#include "kernel/base/error.hpp"
#include "kernel/output/frames.hpp"
#include "millscope/observation_adapter.hpp"
#include "studies/analysis/analysis.hpp"

namespace millscope::bench {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr const char* kCase = R"(schema_version: 1
name: Drum
materials: {glass: {density: 2500, young_modulus: 1e8, poisson_ratio: 0.23}}
beads: {glass5: {material: glass, diameter: 5 mm}}
fill: {filling: 31 %, vessel: {diameter: 300 mm, length: 270 mm}}
contact: {law: {kind: hertz_mindlin}}
pairs: {glass~glass: {restitution: 0.8, static_friction: 0.3}}
body_forces: {gravity: {kind: gravity}}
mill: {diameter: 300 mm, speed: 6.1 rad/s}
geometry: {shell: {kind: cylinder, radius: 150 mm, length: 270 mm, material: glass, motion: mill}}
time: {end_s: 4}
)";

/// Loops of random size about the middle of a charge, each bead at a phase and a place along the axis of its own.
void write_frames(const fs::path& directory, std::size_t beads, std::size_t frames) {
  std::ofstream(directory / "case.resolved.yaml") << kCase;
  constexpr double kRadius = 0.0025, kOmega = 6.1, kStep = 0.001;
  std::vector<std::uint32_t> id, material(beads, 0);
  std::vector<double> radius(beads, kRadius), mass(beads, 2500 * 4.18879 * kRadius * kRadius * kRadius), loop, phase, z;
  Random random(1);
  for (std::size_t k = 0; k < beads; ++k) {
    id.push_back(static_cast<std::uint32_t>(k));
    loop.push_back(0.075 * std::sqrt(random.uniform()));
    phase.push_back(2 * std::numbers::pi * random.uniform());
    z.push_back(0.27 * random.uniform());
  }
  auto writer =
      output::FrameWriter::create(directory / "frames.h5", {id, radius, mass, material, {"glass"}, {"shell"}, {"glass~glass:damping"}});
  std::vector<double> position(3 * beads), velocity(3 * beads), spin(3 * beads, 1.0);
  for (std::size_t f = 0; f < frames; ++f) {
    const double time = kStep * static_cast<double>(f + 1);
    for (std::size_t k = 0; k < beads; ++k) {
      const double a = phase[k] + 8 * time, c = std::cos(a), s = std::sin(a);
      const double x[3] = {0.045 + loop[k] * c, -0.045 + loop[k] * s, z[k]}, v[3] = {-8 * loop[k] * s, 8 * loop[k] * c, 0};
      std::copy_n(x, 3, &position[3 * k]);
      std::copy_n(v, 3, &velocity[3 * k]);
    }
    const std::vector<double> work{30 * time}, lost{30 * time};
    writer.append({time, kOmega * time, kOmega, work, lost, {}, position, velocity, spin});
  }
  writer.close();
}

int measure(const po::variables_map& options) {
  const auto beads = options["beads"].as<std::size_t>(), frames = options["frames"].as<std::size_t>();
  const fs::path directory = fs::path(options["directory"].as<std::string>()) / fmt::format("millscope-analysis-bench-{}", ::getpid());
  fs::create_directories(directory);
  write_frames(directory, beads, frames);
  analysis::AnalysisRequest request;
  request.path = directory;
  request.threads = options["threads"].as<int>();
  const host::Registry registry;
  const double megabytes = 36e-6 * static_cast<double>(beads * frames);
  const double wall = wall_seconds(), cpu = cpu_seconds();
  const analysis::ResultSet results = analysis::analyze(request, registry);
  const double wall_used = wall_seconds() - wall, cpu_used = cpu_seconds() - cpu;
  fs::remove_all(directory);
  std::size_t analyzers = 0;
  for (std::size_t i = 0; i < results.arrays.size(); ++i)
    analyzers += i == 0 || results.arrays[i].analyzer != results.arrays[i - 1].analyzer ? 1 : 0;
  fmt::print("{} beads, {} frames, {:.0f} MB of frames, {} analyzers, {} blocks\n", beads, frames, megabytes, analyzers,
             results.meta.blocks.size());
  fmt::print("wall {:.1f} s: {:.0f} MB/s; processor {:.1f} s: {:.0f} MB/s of one core\n", wall_used, megabytes / wall_used, cpu_used,
             megabytes / cpu_used);
  return 0;
}

int run(int count, char** words) {
  po::options_description options("Options");
  options.add_options()("help", "show this page")("beads", po::value<std::size_t>()->default_value(58000), "beads in a frame")(
      "frames", po::value<std::size_t>()->default_value(1500), "frames")("threads", po::value<int>()->default_value(1), "threads")(
      "directory", po::value<std::string>()->default_value("."), "where the frames are written, 36 bytes a bead and frame");
  po::variables_map values;
  po::store(po::parse_command_line(count, words, options), values);
  if (values.count("help") > 0) {
    std::cout << options;
    return 0;
  }
  return measure(values);
}

}  // namespace
}  // namespace millscope::bench

int main(int count, char** words) { return millscope::bench::run_as("millscope_analysis_bench", count, words, millscope::bench::run); }
