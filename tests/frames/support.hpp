// A made-up charge, written in the layouts of other programs.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scratch.hpp"
#include "studies/frames/frame.hpp"

namespace frames_test {

namespace fs = std::filesystem;
using testing::refusal;
using testing::Scratch;

/// Beads that turn as one about z, from x < 0 through the lowest point to x > 0: in a shell of 100 mm that turns at `omega`.
struct Charge {
  std::vector<long long> id, type;
  std::vector<std::array<double, 3>> place, velocity, spin;  ///< m, m/s, rad/s
  std::vector<double> radius;
  std::size_t size() const { return id.size(); }
};

inline constexpr double kShell = 0.1;  // m
inline constexpr double kLength = 0.05;

/// `count` beads of 5 mm radius (every third 4 mm), turned by `angle` beyond where they begin; numbers from 1 on.
Charge charge(std::size_t count = 60, double omega = 2, double angle = 0);

std::string write(const fs::path& file, const std::string& text);
/// The same bytes, gzipped.
std::string write_gzip(const fs::path& file, const std::string& text);

std::string dump(const Charge& c, long long step, const std::string& columns = "id type x y z vx vy vz omegax omegay omegaz radius");
/// EDEM's export, a particle a line, under the time where there is one.
std::string table(const Charge& c, const std::string& time = "", char separator = ',');
/// EDEM's export, a query a line or one below the other.
std::string queries(const Charge& c, double time, bool below);

std::string legacy_vtk(const Charge& c, bool binary, bool grid, bool little = false);

enum class Coding { ascii, base64, raw, appended_base64 };
/// `wide`: lengths of 8 bytes.
std::string xml_vtk(const Charge& c, Coding coding, bool packed, bool grid, bool wide = true, bool big = false,
                    const std::string& time = "");

/// All frames of files.
std::vector<millscope::frames::Frame> frames_of(const std::vector<fs::path>& files, double length = 1);

/// mill.yaml of this charge: `files` and what else, in lines.
std::string mill(const std::string& files, const std::string& more = "",
                 const std::string& of_mill = "speed: 2 rad/s, direction: counter_clockwise");

}  // namespace frames_test
