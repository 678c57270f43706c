// A case as an input script of LIGGGHTS and what it reads.
#pragma once

#include <string>
#include <vector>

#include "studies/engine/liggghts/physics.hpp"

namespace millscope::engine::liggghts {

/// Where a run of LIGGGHTS lies in the folder of results.
inline constexpr const char* kFolder = "engine";
/// Words of a line that tells how far it is: step, time, atoms, energy.
inline constexpr std::size_t kThermoWords = 4;

/// What a geometry has of one material, an STL file.
struct MeshFile {
  std::string id;  ///< of the fix
  std::string file;
  std::size_t body = 0;
  int type = 0;  ///< of LIGGGHTS
  std::vector<std::uint32_t> slots;
};
std::vector<MeshFile> meshes_of(const run::Assembly& a);

/// What holds all beads on their way, m.
struct Bounds {
  double low, high;
};
Bounds bounds_of(const run::Assembly& a, std::size_t axis);

/// A row of series.txt is the mean of so many values, each so many steps after the one before; together about 10 ms.
inline constexpr std::int64_t kSeriesValues = 20;
std::int64_t series_every(const run::Assembly& a);

/// Where the case has frames: steps between them, and from which step after t = 0 on.
std::int64_t frame_every(const run::Assembly& a);
std::int64_t frames_from(const run::Assembly& a);

/// The step at which the case's own time begins: frames come at whole multiples of their steps.
std::int64_t zero_step(const run::Assembly& a);

/// The beads where they are now, at rest or not: file of `read_data`.
std::string data_of(const run::Assembly& a);

/// The script: settling with the walls at rest, then the case's own time. `meshes` lie in `meshes/`, results go to `post/`.
std::string script_of(const run::Assembly& a, const Physics& physics, const std::vector<MeshFile>& meshes);

}  // namespace millscope::engine::liggghts
