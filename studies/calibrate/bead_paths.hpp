// The whole charge of a simulation as tracers: paths of many beads from frames.h5, fine enough for the virtual camera.
//
// Between two frames a bead moves on the cubic that has the places and velocities of both: with frames every 5 ms it is off by at most
// Δv h/8 (Δv: jump of velocity in an impact between them), some 0.1 mm where a camera leaves 0.5 mm.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "kernel/host/registry.hpp"
#include "kernel/output/track_reader.hpp"
#include "millscope/observation.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/analysis/results.hpp"

namespace millscope::calibrate {

inline constexpr double kFrameStep = analysis::kCameraInterval;  ///< s, between the frames that a calibration asks for

/// Where a recorded bead was along the axis, and the rig's middle, m.
struct AxialPlace {
  double low = 0, high = 0, middle = 0;
  bool operator==(const AxialPlace&) const = default;
};

class BeadPaths {
 public:
  /// At most `beads` of the run, of those that the case lets be followed (`tracer: true`), evenly over their ids, from the time on at which
  /// the case begins its analysis. The beads of a periodic slice are spread over a longer `place`, so that the camera sees them as far away
  /// as it saw the recorded one. Throws base::UserError when the run has no frames or fewer than four.
  BeadPaths(const std::filesystem::path& run, int beads, const AxialPlace& place, const host::Registry& registry);

  std::size_t size() const { return ids_.size(); }
  std::uint32_t id(std::size_t i) const { return ids_[i]; }
  const analysis::MillOfCase& mill() const { return mill_; }
  const std::filesystem::path& case_file() const { return case_file_; }
  /// The power of the charge without unlike tracers, all N beads like the others, over that of the run: 1 where no class is set apart.
  double power_ratio() const { return lever_ratio_; }
  double seconds() const { return time_.back() - time_.front(); }  ///< of each path

  /// With points at most about `step` s apart: straight lines between them are off by at most a h²/8.
  output::TrackSamples path(std::size_t i, double step) const;
  TrackContext context(std::size_t i, std::uint64_t seed) const;

 private:
  std::filesystem::path case_file_;
  analysis::MillOfCase mill_;
  AxialPlace place_;
  double lever_ratio_ = 1;
  std::vector<std::uint32_t> ids_;
  std::vector<double> radius_, time_;
  std::vector<float> position_, velocity_;  ///< [beads, frames, 3]
};

}  // namespace millscope::calibrate
