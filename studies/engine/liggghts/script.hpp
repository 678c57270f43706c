// A case as an input script of LIGGGHTS and what it reads.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/engine/liggghts/physics.hpp"
#include "studies/engine/liggghts/walls.hpp"

namespace millscope::engine::liggghts {

/// Words of a line that tells how far it is: step, time, atoms, energy.
inline constexpr std::size_t kThermoWords = 4;

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
/// Where the case has tracks: steps between their instants.
std::int64_t track_every(const run::Assembly& a);

/// Where the case has pictures for ParaView: steps between them, from t = 0 on.
std::int64_t picture_every(const run::Assembly& a);

/// The step at which the case's own time begins: frames, pictures and tracks come at whole multiples of their steps.
std::int64_t zero_step(const run::Assembly& a);

/// The beads where they are now, at rest or not: file of `read_data`.
std::string data_of(const run::Assembly& a);

/// The script: settling with the walls at rest, then the case's own time. `meshes` lie in `meshes/`, results go to `post/`. `restart`: the
/// step of the file post/restart.STEP from which a run goes on; what it writes then is `name_of_session(…, restart)`.
std::string script_of(const run::Assembly& a, const Physics& physics, const std::vector<MeshFile>& meshes,
                      std::optional<std::int64_t> restart = {});

/// "series.txt", of a run that went on from a step "series.1000.txt".
std::string name_of_session(const std::string& what, std::optional<std::int64_t> restart);

/// A file of a run that was continued, and the steps that count in it.
struct Session {
  std::filesystem::path file;
  std::int64_t after, until;
};
/// In their order: the first, and one for each step from which the run went on.
std::vector<Session> sessions_of(const std::filesystem::path& post, const std::string& what);

/// Steps of the files that `what` stands before in a folder ("restart" → restart.1000), in order.
std::vector<std::int64_t> steps_of_files(const std::filesystem::path& folder, const std::string& what);

}  // namespace millscope::engine::liggghts
