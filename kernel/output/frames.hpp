// frames.h5: all beads, every few milliseconds. Readable while the run goes on (h5py: swmr=True), after it, and after kill -9.
//
// Resume rule: every file that grows is `flush`ed before a checkpoint is committed; a resumed run drops what is later than the
// checkpoint's time and appends again, so that its content equals that of a run that was never interrupted.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace millscope::output {

inline constexpr std::uint32_t kFramesSchema = 1;

/// What does not change during a run: written once. Arrays are ordered by id, [N].
struct BeadTable {
  std::span<const std::uint32_t> id;
  std::span<const double> radius;           ///< m
  std::span<const double> mass;             ///< kg
  std::span<const std::uint32_t> material;  ///< index into `material_names`
  std::vector<std::string> material_names;
  std::vector<std::string> wall_names;         ///< columns of FrameView::wall_work
  std::vector<std::string> dissipation_names;  ///< columns of FrameView::dissipation, e.g. "glass~liner.normal"
  std::vector<std::string> impact_pairs{};     ///< rows of FrameView::impacts; empty: not written
  std::vector<double> impact_edges{};          ///< J, [bins + 1]
  bool beads_vary = false;                     ///< not all beads are there in every frame (only in frames that were imported)
};

/// One instant. Bead arrays are ordered as BeadTable::id; [N,3] is x0 y0 z0 x1 y1 z1 … NaN is what is not known, which happens in frames
/// that were imported: of a bead that is not there its place, of frames without velocities or spins those.
struct FrameView {
  double time = 0;                           ///< s
  double wall_angle = 0;                     ///< rad, about z, since the start
  double angular_velocity = 0;               ///< Ω, rad/s
  std::span<const double> wall_work;         ///< [walls] J given to the charge since the start
  std::span<const double> dissipation;       ///< [dissipation_names] J since the start
  std::span<const std::uint64_t> impacts{};  ///< [impact_pairs, bins] first touches since the start
  std::span<const double> position;          ///< [N,3] m
  std::span<const double> velocity;          ///< [N,3] m/s
  std::span<const double> spin;              ///< [N,3] rad/s
  double mass = 0;                           ///< kg of the beads that are there; written where `beads_vary`
};

/// Writes frames.h5 (docs/format.md). The number of beads is fixed by the table. Throws base::UserError when the disk is full or
/// the file cannot be written; what was written before stays readable.
class FrameWriter {
 public:
  /// A new file; an existing one is a UserError.
  static FrameWriter create(const std::filesystem::path& path, const BeadTable& table);
  /// Opens the file of an interrupted or finished run and drops the frames later than `time` (s). UserError when its beads are not
  /// `bead_count`, or when it is damaged.
  static FrameWriter resume(const std::filesystem::path& path, std::size_t bead_count, double time);
  ~FrameWriter();
  FrameWriter(FrameWriter&&) noexcept;
  FrameWriter& operator=(FrameWriter&&) noexcept;

  /// Adds one frame; times must increase. The first is with the operating system on return. Later ones wait for each other, until one
  /// comes a quarter of a second after the last that did not, or until they are 256 KiB: kill -9 loses what waits.
  void append(const FrameView& frame);
  std::size_t frame_count() const;  ///< with those that wait
  /// All frames, onto the disk.
  void flush();
  /// Flushes and closes. The destructor closes too, but cannot report.
  void close();

 private:
  struct Impl;
  explicit FrameWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Bytes of one frame on disk, for estimates.
std::uint64_t frame_bytes(std::size_t bead_count);

}  // namespace millscope::output
