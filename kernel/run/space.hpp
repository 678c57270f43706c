// The space that beads may fill: its bounds, and which spheres touch a wall or lie on its far side.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/vector3.hpp"
#include "kernel/run/assembly.hpp"

namespace millscope::run {

struct Region {
  config::Box box;
  bool cylinder = false;
  double radius = 0;
  base::Vector3 axis_point{};
};

/// Against gravity, m²/s²: what is lower is filled first.
double height(const Assembly& a, const base::Vector3& p);
/// The height below which the share `part` of the region's extent along gravity lies; all of it from 1 on, and without gravity.
double level(const Assembly& a, const Region& r, double part);
/// The share of the region that is filled first, for what takes `volume` of it, m³: 1 without gravity.
double first_part(const Assembly& a, const Region& r, double volume);

/// Where beads may be put: what the user says, else the intersection of what the geometries call their inside.
Region region_of(const Assembly& a);

/// 1 for each centre whose sphere of that radius touches a wall, or that a wall separates from the axis of its own interior.
std::vector<std::uint8_t> blocked(const Assembly& a, const std::vector<base::Vector3>& centres, const std::vector<double>& radii);
std::vector<std::uint8_t> blocked(const Assembly& a, const std::vector<base::Vector3>& centres, double radius);

}  // namespace millscope::run
