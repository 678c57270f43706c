// Two measurements on recordings:
//   millscope_recording_bench --points 1000000          how long reading, splining and gridding take on one core
//   millscope_recording_bench --tracks OUT/tracks.h5    how well the stated uncertainty holds on simulated beads, whose motion is known
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <random>

#include "bench/program.hpp"
#include "kernel/base/error.hpp"
#include "kernel/output/track_reader.hpp"
#include "studies/trajectory/trajectory.hpp"

namespace millscope::bench {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

/// A bead that circulates in a mill of 0.3 m, seen 220 times a second, as an `.a` file.
void write_points(const fs::path& file, std::size_t count) {
  std::ofstream out(file);
  out << "\n\nSeparation=\n\nf(opt) :  0.500\n\n\nFixed slices:    250 events/slice,    1 locations/slice\n\n";
  std::mt19937_64 generator(1);
  std::exponential_distribution<double> pause(0.22);  // per ms
  std::normal_distribution<double> noise(0, 0.7);     // mm
  double t = 0;
  for (std::size_t k = 0; k < count; ++k) {
    t += 0.1 + pause(generator);
    const double angle = 6e-3 * t, radius = 90 + 40 * std::sin(angle / 3.1);
    out << fmt::format("{:10.1f}{:10.1f}{:10.1f}{:10.1f}       6.0       0.0      0.00  125\n", t,
                       radius * std::cos(angle) + noise(generator), radius * std::sin(angle) + noise(generator),
                       30 + 20 * std::sin(angle / 40) + noise(generator));
  }
}

/// Time and momentum on 50 × 50 cells of x and y, as a map of occupancy and velocity needs.
double grid(const trajectory::Trajectory& trajectory) {
  constexpr int kCells = 50;
  constexpr double kHalf = 0.15;  // m
  std::vector<std::array<double, 4>> cells(kCells * kCells);
  for (const trajectory::Piece& piece : trajectory.pieces) {
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const int i = static_cast<int>((piece.position[0][k] + kHalf) / (2 * kHalf) * kCells);
      const int j = static_cast<int>((piece.position[1][k] + kHalf) / (2 * kHalf) * kCells);
      if (i < 0 || j < 0 || i >= kCells || j >= kCells) continue;
      auto& cell = cells[j * kCells + i];
      cell[0] += piece.weight[k];
      for (std::size_t axis = 0; axis < 3; ++axis) cell[axis + 1] += piece.weight[k] * piece.velocity[axis][k];
    }
  }
  double sum = 0;
  for (const auto& cell : cells) sum += cell[0];
  return sum;
}

void time_points(std::size_t count) {
  const fs::path file = fs::temp_directory_path() / fmt::format("millscope_recording_bench_{}.a", ::getpid());
  write_points(file, count);
  std::cout << fmt::format("{} points, {} MB; CPU seconds on one core\n", count, fs::file_size(file) / 1000000);
  for (const trajectory::SplineKind kind : {trajectory::SplineKind::smoothing, trajectory::SplineKind::cubic}) {
    const double start = cpu_seconds();
    const recording::Recording recording = recording::read_recording(file);
    const double read = cpu_seconds();
    const trajectory::Trajectory trajectory =
        trajectory::fit_trajectory(recording.runs[0], {.kind = kind, .gap_limit = recording.gap_limit});
    const double fitted = cpu_seconds();
    const double covered = grid(trajectory);
    const double end = cpu_seconds();
    std::cout << fmt::format("{:9}: read {:.2f}, spline {:.2f}, grid {:.2f}, together {:.2f} ({:.0f} s in samples of 1 ms)\n",
                             kind == trajectory::SplineKind::cubic ? "cubic" : "smoothing", read - start, fitted - read, end - fitted,
                             end - start, covered);
  }
  fs::remove(file);
}

struct Camera {
  double rate, noise, correlation;
};

/// A simulated bead, unwrapped over the jumps of a periodic boundary.
struct Truth {
  output::TrackSamples samples;
  double step;

  explicit Truth(output::TrackSamples track) : samples(std::move(track)), step(samples.time[1] - samples.time[0]) {
    for (auto& x : samples.position) {
      double offset = 0, last = x[0];
      for (std::size_t i = 1; i < x.size(); ++i) {
        const double jump = x[i] - last;
        last = x[i];
        if (std::fabs(jump) > 0.01) offset -= jump;
        x[i] += offset;
      }
    }
  }
  double position(double t, std::size_t axis) const {
    const double u = (t - samples.time[0]) / step;
    const auto i = std::min(static_cast<std::size_t>(u), samples.size() - 2);
    return std::lerp(samples.position[axis][i], samples.position[axis][i + 1], u - static_cast<double>(i));
  }
  double velocity(double t, std::size_t axis) const { return (position(t + 5e-4, axis) - position(t - 5e-4, axis)) / 1e-3; }
};

recording::Run see(const Truth& truth, const Camera& camera, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::exponential_distribution<double> pause(camera.rate);
  std::normal_distribution<double> normal;
  recording::Run run;
  run.source = "simulated bead";
  std::array<double, 3> noise{normal(generator), normal(generator), normal(generator)};
  double t = truth.samples.time.front() + 2;  // the charge develops
  while ((t += pause(generator)) < truth.samples.time.back() - 0.01) {
    run.time.push_back(t);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      noise[axis] = camera.correlation * noise[axis] + std::sqrt(1 - camera.correlation * camera.correlation) * normal(generator);
      run.position[axis].push_back(truth.position(t, axis) + camera.noise * noise[axis]);
    }
  }
  return run;
}

struct Score {
  double count = 0, position = 0, velocity = 0, position_error = 0, velocity_error = 0, speed = 0, true_speed = 0;

  void add(const trajectory::Piece& piece, std::size_t k, const Truth& truth) {
    constexpr double kNinety = 1.6449 * 1.6449;
    const double t = piece.start + static_cast<double>(k) * piece.step;
    double squared = 0, true_squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double v = truth.velocity(t, axis), dx = piece.position[axis][k] - truth.position(t, axis), dv = piece.velocity[axis][k] - v;
      position += dx * dx <= kNinety * piece.position_variance[k];
      velocity += dv * dv <= kNinety * piece.velocity_variance[k];
      position_error += dx * dx;
      velocity_error += dv * dv;
      squared += piece.velocity[axis][k] * piece.velocity[axis][k];
      true_squared += v * v;
      ++count;
    }
    speed += std::sqrt(squared);
    true_speed += std::sqrt(true_squared);
  }
};

void score_tracks(const fs::path& file) {
  const output::TrackReader reader(file);
  constexpr Camera kCameras[] = {{220, 0.7e-3, 0}, {220, 0.7e-3, 0.2}, {220, 0.7e-3, 0.5}, {100, 0.5e-3, 0}, {800, 0.7e-3, 0}};
  std::cout << fmt::format(
      "{} beads of {}\nrate/s  noise/mm correlation | spline    | errors: mm   m/s    | 90 % hold: position velocity | speed\n",
      reader.tracks().size(), file.string());
  for (const Camera& camera : kCameras) {
    for (const trajectory::SplineKind kind : {trajectory::SplineKind::smoothing, trajectory::SplineKind::cubic}) {
      Score s;
      for (std::size_t k = 0; k < reader.tracks().size(); ++k) {
        const Truth truth(reader.read(k));
        const trajectory::Trajectory trajectory =
            trajectory::fit_trajectory(see(truth, camera, k + 1), {.kind = kind, .gap_limit = std::min(0.1, 10 / camera.rate)});
        for (const trajectory::Piece& piece : trajectory.pieces) {
          for (std::size_t i = 0; i < piece.size(); ++i) s.add(piece, i, truth);
        }
      }
      std::cout << fmt::format("{:6.0f} {:9.2f} {:11.1f} | {:9} | {:10.2f} {:8.3f} | {:18.3f} {:8.3f} | {:+.1f} %\n", camera.rate,
                               1e3 * camera.noise, camera.correlation, kind == trajectory::SplineKind::cubic ? "cubic" : "smoothing",
                               1e3 * std::sqrt(s.position_error / s.count), std::sqrt(s.velocity_error / s.count), s.position / s.count,
                               s.velocity / s.count, 100 * (s.speed / s.true_speed - 1));
    }
  }
}

int run(int count, char** words) {
  po::options_description description("millscope_recording_bench [options]");
  description.add_options()("help,h", "explain")("points", po::value<std::size_t>(), "time that many points")(
      "tracks", po::value<std::string>(), "judge the stated uncertainty on the beads of a tracks.h5");
  po::variables_map options;
  po::store(po::parse_command_line(count, words, description), options);
  if (options.count("points") != 0) time_points(options["points"].as<std::size_t>());
  if (options.count("tracks") != 0) score_tracks(options["tracks"].as<std::string>());
  if (options.count("points") + options.count("tracks") == 0) std::cout << description;
  return 0;
}

}  // namespace
}  // namespace millscope::bench

int main(int count, char** words) { return millscope::bench::run_as("millscope_recording_bench", count, words, millscope::bench::run); }
