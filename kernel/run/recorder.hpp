// Everything that a run writes while it goes on; which step writes what follows from the step number alone, so that a resumed run
// writes the same.
#pragma once

#include <filesystem>
#include <optional>
#include <unordered_map>

#include "kernel/output/frames.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/tracks.hpp"
#include "kernel/run/pictures.hpp"
#include "kernel/run/window.hpp"

namespace millscope::run {

/// Which beads are followed where the case has tracks, once they are in: the user's, or a seeded draw, in the order of their ids or as
/// given.
std::vector<std::uint32_t> tracked_beads(const Assembly& a);

class Recorder {
 public:
  /// Throws UserError for outputs that this case cannot give, before anything is written.
  static void check(const Assembly& a);
  /// `resume_time`: drop what is later; nothing: a fresh directory.
  Recorder(const Assembly& a, std::filesystem::path directory, std::optional<double> resume_time);

  /// Whether the coming step must be observed.
  bool wants(std::int64_t step) const;
  /// Called inside System::observe.
  void observe(const dem::System& system);

  const std::vector<Sample>& samples() const { return samples_; }
  std::vector<Sample>& samples() { return samples_; }
  const std::optional<dem::Ledger>& window_start() const { return window_start_; }
  void set_window_start(dem::Ledger ledger) { window_start_ = std::move(ledger); }
  void flush();
  void close();

 private:
  void take_beads();
  void open_series(std::optional<double> resume_time);
  void open_frames(std::optional<double> resume_time);
  void open_tracks(std::optional<double> resume_time);
  void write_series(const Sample& s);
  void gather(const dem::System& system);
  void write_frame(const dem::System& system);
  void write_tracks(const dem::System& system);

  const Assembly& a_;
  std::filesystem::path directory_;
  std::int64_t sample_steps_, series_steps_ = 0, frame_steps_ = 0, frame_from_ = 0, track_steps_ = 0, picture_steps_ = 0;
  std::optional<output::SeriesWriter> series_;
  std::optional<output::FrameWriter> frames_;
  std::optional<output::TrackWriter> tracks_;
  std::optional<Pictures> pictures_;
  std::vector<Sample> samples_;
  std::optional<dem::Ledger> window_start_;
  std::vector<std::uint32_t> track_ids_;
  std::vector<std::uint32_t> index_of_id_;
  std::int64_t indexed_rebuild_ = -1;
  // bead arrays in id order
  std::vector<std::uint32_t> ids_, materials_;
  std::vector<double> radius_, mass_, position_, velocity_, spin_;
};

}  // namespace millscope::run
