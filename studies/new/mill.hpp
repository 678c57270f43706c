// A mill as its owner would describe it, and what follows for its simulation. SI throughout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"

namespace millscope::new_mill {

/// A number with the text that its owner wrote, which the case repeats.
struct Value {
  double si = 0;
  std::string text;
};

/// One material of the library, or of a file of the user's.
struct Material {
  std::string name;
  std::filesystem::path file;
  double density = 0, young = 0, poisson = 0;
};

struct Lifters {
  int number = 0;
  Value height, width, face_angle;
};

/// A mesh that was looked at and can be used.
struct Liner {
  std::filesystem::path file;
  std::string kind, unit;  ///< the plugin that reads it; "" where the file says its unit
  bool turned = false;     ///< its axis is not z through the origin: the case brings it there
  double radius = 0;       ///< of the bare shell, m
  double low = 0, high = 0;
  bool wall_low = false, wall_high = false;  ///< an end wall at z = low, high
};

struct Mill {
  Value diameter, length, filling, bead, speed, seconds;
  double omega = 0;           ///< rad/s, without sign
  double critical_omega = 0;  ///< rad/s
  bool clockwise = false, closed = false;
  std::optional<Liner> liner;
  Lifters lifters;  ///< without a liner
  Material bead_material, liner_material;

  double low() const { return liner ? liner->low : 0; }
  double high() const { return liner ? liner->high : length.si; }
};

/// What is chosen for the user; each choice is told in the case.
struct Choices {
  std::uint64_t beads = 0;
  double fastest = 0;           ///< m/s: a bead that falls across the mill onto the rising shell
  double stiffness_factor = 1;  ///< the softest at which that bead sinks in by a tenth of its radius at most
  double overlap = 0;           ///< how far it then sinks in, part of the effective radius
  double settle = 0.3;          ///< s
  double analyze_from = 0;      ///< s
  double series_every = 0.01, frames_every = 0.01, pictures_every = 0.02;  ///< s
};

inline constexpr double kPorosity = 0.37;

/// 42.3/√(D − d) rpm, in rad/s.
double critical_speed(double diameter, double bead);
/// Seconds for four turns and a half, rounded up to half a second.
double usual_seconds(double omega);
Choices choose(const Mill& mill);
/// What will go wrong, or be of little use: a sentence each.
std::vector<std::string> warnings(const Mill& mill, const Choices& choices);

/// Text of the nearest number of so many digits, "7.5 mm".
std::string millimetres(double metres, int digits = 2);

}  // namespace millscope::new_mill
