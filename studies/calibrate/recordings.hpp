// The recordings of a study, read and cleaned once, and handed to all who look at them: the checks, the observer, and diagnose.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "studies/calibrate/figure.hpp"
#include "studies/calibrate/study.hpp"
#include "studies/inspect/mill_motion.hpp"
#include "studies/recording/recording.hpp"

namespace millscope::calibrate {

/// What was recorded in a condition: tracks, or a figure. May be looked at by several threads.
class Recorded {
 public:
  explicit Recorded(recording::Recording tracks) : tracks_(std::move(tracks)) {}
  explicit Recorded(std::unique_ptr<const Figure> figure) : figure_(std::move(figure)) {}

  bool of_tracks() const { return tracks_.has_value(); }
  const recording::Recording& tracks() const { return tracks_.value(); }
  const Figure& figure() const { return *figure_; }
  /// What is stated of the mill.
  const recording::Condition& stated() const { return tracks_ ? tracks_->condition : figure_->condition; }
  /// Where the axis stands and how the mill turns, by the tracks; estimated when it is asked for first.
  const inspect::MillMotion& motion() const;

 private:
  std::optional<recording::Recording> tracks_;
  std::unique_ptr<const Figure> figure_;
  mutable std::once_flag motion_asked_;
  mutable inspect::MillMotion motion_;
};

/// One for each condition of a study.
using Recordings = std::vector<std::shared_ptr<const Recorded>>;

/// Throws base::UserError.
std::shared_ptr<const Recorded> read_recorded(const std::filesystem::path& recording);
Recordings read_recordings(const Study& study);

/// Holds the recordings against the case that is to be compared with them: another mill, beads, filling or speed. Throws base::UserError.
void check_recordings(const Study& study, const Recordings& recordings, const host::Registry& registry);

}  // namespace millscope::calibrate
