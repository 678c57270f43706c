// Reads frames.h5 (docs/format.md), also of a run that is still going on or was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace millscope::output {

/// What does not change from frame to frame; arrays in the order of every frame, [N].
struct FrameBeads {
  std::vector<std::uint32_t> id;
  std::vector<double> radius;           ///< m
  std::vector<double> mass;             ///< kg
  std::vector<std::uint32_t> material;  ///< index into `material_names`
  std::vector<std::string> material_names;
  std::size_t size() const { return id.size(); }
};

/// All that a frame holds beside its beads, for every frame; [n, columns] row-major.
struct FrameScalars {
  std::vector<double> time;              ///< s, increasing
  std::vector<double> wall_angle;        ///< rad, about z, since the start
  std::vector<double> angular_velocity;  ///< Ω, rad/s
  std::vector<double> mass_there;        ///< kg of the beads that are there; empty: all beads are in every frame
  std::vector<std::string> wall_names;
  std::vector<double> wall_work;  ///< [n, walls] J since the start; empty where the file has none
  std::vector<std::string> dissipation_names;
  std::vector<double> dissipation;  ///< [n, names] J since the start; empty where the file has none
  std::vector<std::string> impact_pairs;
  std::vector<double> impact_edges;  ///< [bins + 1] J
  std::vector<double> impacts;       ///< [n, pairs, bins] collisions since the start; empty where the file has none
};

enum class BeadField { position, velocity, spin };

/// Opens the file and reads all but the bead arrays. Throws base::UserError when it is missing, no such file, of another schema version
/// or damaged.
class FrameReader {
 public:
  explicit FrameReader(std::filesystem::path path);
  ~FrameReader();
  FrameReader(FrameReader&&) noexcept;
  FrameReader& operator=(FrameReader&&) noexcept;

  const std::filesystem::path& path() const;
  const FrameBeads& beads() const;
  const FrameScalars& scalars() const;
  std::size_t frame_count() const;  ///< complete frames

  /// Frames first … first + count − 1 of one field into values [count, N, 3]: x0 y0 z0 x1 …; m, m/s or rad/s. May be called from
  /// several threads; HDF5 takes them one after the other. NaN: not known (FrameView).
  void read(BeadField field, std::size_t first, std::size_t count, std::span<float> values) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace millscope::output
