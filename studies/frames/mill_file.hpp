// mill.yaml: what frames of another program do not say of their mill (docs/import.md explains the keys).
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/vector3.hpp"
#include "kernel/config/document.hpp"

namespace millscope::frames {

/// From the axes of the files to ours: z along the mill's axis from its low end, y against gravity, the axis at x = y = 0.
struct Placement {
  std::array<base::Vector3, 3> rows{};  ///< our x, y, z in the axes of the files
  base::Vector3 centre{};               ///< a point of the axis, in the files, m
  double low = 0;                       ///< of the end face with the smaller coordinate along the axis, m

  base::Vector3 turned(const base::Vector3& v) const { return {base::dot(rows[0], v), base::dot(rows[1], v), base::dot(rows[2], v)}; }
  base::Vector3 place(const base::Vector3& v) const;
};

/// A value for all beads, or one for each type.
struct ByType {
  std::optional<double> all;
  std::map<std::string, double> of;
  /// `word`: of the type in the files; "": they number it. Throws base::UserError, at the key, for a type that it does not name.
  std::optional<double> value(long long type, const std::string& word) const;
  std::optional<config::Node> node;
};

struct MillFile {
  std::string file, name;
  std::vector<std::filesystem::path> files;
  double length_unit = 1;           ///< m
  double velocity_unit = 1;         ///< m/s
  std::optional<double> spin_unit;  ///< rad/s
  std::optional<double> time_step;  ///< s for each step of the program
  std::optional<double> interval;   ///< s between frames
  std::optional<double> analyze_from;
  Placement placement;
  double diameter = 0, length = 0;  ///< m
  bool periodic = false;
  std::optional<double> speed;        ///< rad/s, its size
  std::optional<double> of_critical;  ///< part of the critical speed, in the place of `speed`
  std::optional<int> sense;           ///< +1 counter-clockwise about our z, −1 clockwise
  double start = 0;                   ///< s: the mill stands before
  double gravity = 9.81;              ///< m/s²
  std::optional<double> porosity;
  ByType density, diameter_of_beads;
  std::string liner, liner_unit;  ///< mesh, absolute path, in the axes of the files; "": a smooth shell
  config::Node root;
};

/// Throws base::UserError.
MillFile read_mill_file(const std::filesystem::path& file);

}  // namespace millscope::frames
