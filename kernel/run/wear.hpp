// What a run leaves of wear: how much each triangle of a wall has lost since `time.analyze_from_s`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/run/assembly.hpp"

namespace millscope::run {

inline constexpr const char* kWearFile = "wear.h5";

/// Writes every body with a surface; whole or not at all. UserError where it cannot be written.
void write_wear(const Assembly& a, const std::filesystem::path& path);

/// One body as that file has it, in its own frame.
struct WornSurface {
  std::vector<double> vertices;                     ///< [V,3] m
  std::vector<std::uint32_t> triangles, materials;  ///< [T,3]; [T] slot
  std::vector<double> worn;                         ///< [T] m³
  double time = 0;                                  ///< that they were counted, s
};

/// UserError when the file is missing, damaged, or knows no such body.
WornSurface read_wear(const std::filesystem::path& path, const std::string& body);

}  // namespace millscope::run
