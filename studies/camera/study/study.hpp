// What a camera and the processing behind it do to figures that are known exactly, because the bead is simulated.
//
//   millscope_camera_study fields RUN CAMERA.yaml CELLS BEADS [GAP_LIMIT_S]   coverage of the stated intervals, bias of occupancy and speed
//   millscope_camera_study power RUN CAMERA.yaml                             bias of Bbosa's power against noise and cell size
//
// Each bead goes the whole way of a recording: `.a` file, reading and cleaning, trajectory, analyzer. JSON on standard output.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"
#include "studies/analysis/results.hpp"
#include "studies/camera/camera.hpp"
#include "studies/camera/simulated_beads.hpp"

namespace millscope::camera {

/// A directory of its own that goes away with the object.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A source of blocks and the analyzers of `settings` (YAML: the map `analyzers`, and `trajectory`) run over it.
analysis::ResultSet analyze_path(const std::filesystem::path& path, const std::vector<std::string>& tracers, double from,
                                 const std::string& settings, const host::Registry& registry);

/// The beads seen by the camera as recording.yaml in `folder`, with the mill's true axis, which this camera must not move.
std::filesystem::path record(const SimulatedBeads& beads, const Camera& camera, const std::vector<std::int64_t>& ids,
                             const std::filesystem::path& folder, std::uint64_t seed);

struct FieldStudy {
  int cells = 30;  ///< along x and along y
  std::size_t most_beads = 1000;
  double gap_limit = 0;  ///< s; 0: what the recording says
};
nlohmann::json study_fields(const std::filesystem::path& run, const Camera& camera, const FieldStudy& study,
                            const host::Registry& registry);
nlohmann::json study_power(const std::filesystem::path& run, const std::string& camera_file, const host::Registry& registry);

}  // namespace millscope::camera
