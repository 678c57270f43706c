// Pictures for ParaView: VTP files (raw appended data, little endian) and a PVD file that gives each its time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace millscope::output {

/// Beads at one instant; arrays in one order, [N] or [N,3] interleaved.
struct BeadPicture {
  std::span<const std::uint32_t> id;
  std::span<const std::uint32_t> material;
  std::span<const double> radius;    ///< m
  std::span<const double> position;  ///< [N,3] m
  std::span<const double> velocity;  ///< [N,3] m/s
  std::span<const double> spin;      ///< [N,3] rad/s
};

/// A body's surface where it is at one instant.
struct MeshPicture {
  std::span<const double> vertices;          ///< [V,3] m, already moved
  std::span<const std::uint32_t> triangles;  ///< [T,3]
  std::span<const std::uint32_t> materials;  ///< [T] slot of each triangle
  std::span<const double> impact_work;       ///< [T] J since the start, or empty
  std::span<const double> shear_work;        ///< [T] J since the start, or empty
  std::span<const double> worn_volume = {};  ///< [T] m³ since the analysis began, or empty
};

/// Points with radius, velocity, speed, spin, id, material; whole or not at all. UserError when it cannot be written.
void write_beads_vtp(const std::filesystem::path& path, const BeadPicture& picture);

/// Triangles with material, impact_work, shear_work (J), worn_volume (m³) and the same per area; whole or not at all.
void write_mesh_vtp(const std::filesystem::path& path, const MeshPicture& picture);

/// A PVD file: which picture shows which time. Replaced as a whole at each change, so that ParaView never sees half of it.
class PictureSeries {
 public:
  /// Starts empty; nothing is written before the first `add`.
  static PictureSeries create(const std::filesystem::path& path);
  /// Reads the file of an interrupted run (missing: empty) and drops the pictures later than `time` (s).
  static PictureSeries resume(const std::filesystem::path& path, double time);

  /// `file` is relative to the PVD's directory; several parts (bodies) may share a time.
  void add(double time, const std::string& file, int part = 0);
  /// Number of entries.
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    double time;
    std::string file;
    int part;
  };
  explicit PictureSeries(std::filesystem::path path) : path_(std::move(path)) {}
  void save() const;

  std::filesystem::path path_;
  std::vector<Entry> entries_;
};

}  // namespace millscope::output
