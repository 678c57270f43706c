// The virtual camera: a chain of observation plugins laid over the true path of one bead. What comes out is a Run, the same as a real
// recording's, so that everything after it is identical for simulated and real beads.
//
//   # camera.yaml
//   schema_version: 1
//   observations:
//     blur:   {kind: location_blur, window: 5 ms}
//     rate:   {kind: sampling, rate: 220 Hz}
//     noise:  {kind: noise, white: [0.4, 0.4, 0.4, mm]}
//
// The links are applied in the order of the file. Each draws from a stream of its own, made from the seed and the link's name: adding or
// removing one link leaves the random numbers of the others as they were.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kernel/config/document.hpp"
#include "kernel/host/objects.hpp"
#include "kernel/output/track_reader.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::camera {

/// A named link of the chain.
struct CameraLink {
  std::string name;
  host::ObservationObject plugin;
  double span = 0;  ///< s, of one location: the window of location_blur, the mean interval of sampling; 0: of neither
};

/// A chain of observations; copies share the plugins' objects. May be used by many threads at once.
class Camera {
 public:
  Camera() = default;  ///< sees everything exactly
  explicit Camera(std::vector<CameraLink> links) : links_(std::move(links)) {}
  const std::vector<CameraLink>& links() const { return links_; }
  /// This chain with another one behind it.
  Camera before(const Camera& other) const {
    std::vector<CameraLink> links = links_;
    links.insert(links.end(), other.links_.begin(), other.links_.end());
    return Camera(std::move(links));
  }

 private:
  std::vector<CameraLink> links_;
};

/// Reads a camera file. Throws UserError with file:line for unknown plugins and keys, wrong units and values.
Camera read_camera(const std::filesystem::path& file, const host::Registry& registry, const std::vector<std::string>& overrides = {});
/// The same from text; `name` stands for the file in messages.
Camera parse_camera(const std::string& text, const std::string& name, const host::Registry& registry,
                    const std::vector<std::string>& overrides = {});

/// What the camera makes of a bead's true path (s, m, in the mill's frame). `spread` is filled where a link lowered the confidence of
/// locations: 1 mm divided by the confidence. Throws UserError when a plugin refuses, or makes times that do not increase.
recording::Run observe(const output::TrackSamples& track, const Camera& camera, const TrackContext& context);

/// A seed for bead `id` of a run, as different as can be from those of its neighbours.
std::uint64_t bead_seed(std::uint64_t seed, std::int64_t id);

}  // namespace millscope::camera
