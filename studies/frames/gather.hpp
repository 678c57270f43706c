// All frames of an import, read once: turned into the mill's frame, judged, counted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/frames/beads.hpp"
#include "studies/frames/frame.hpp"
#include "studies/frames/mill_file.hpp"
#include "studies/frames/wall_watch.hpp"

namespace millscope::frames {

class Gather {
 public:
  Gather(const MillFile& mill, const std::filesystem::path& spool) : mill_(mill), walls_(mill), spool_(spool) {}

  /// Throws base::UserError, one line with file:line, for what cannot be.
  void read();

  const Census& census() const { return census_; }
  Spool& spool() { return spool_; }
  const WallWatch& walls() const { return walls_; }
  bool has_velocity() const { return has_velocity_.value_or(false); }
  bool has_spin() const { return has_spin_.value_or(false); }
  bool has_ids() const { return has_ids_.value_or(false); }
  bool beads_vary() const { return least_ != most_; }
  /// The distance that 99 % of the beads go at most from one frame to the next, the median over the frames, m; 0: not known. Only without
  /// velocities.
  double stride() const { return stride_; }
  /// What a reader must know, a sentence each.
  std::vector<std::string> notes() const;

 private:
  void take_time(Frame& frame, Beads& beads);
  void require_rising(const Frame& frame, double time) const;
  void require_same(const Frame& frame, std::optional<bool>& first, bool now, const char* what) const;
  void take_ids(const Frame& frame, Beads& beads);
  void take_motion(const Frame& frame, Beads& beads);
  void take_kinds(const Frame& frame);
  double density_of(const Frame& frame, std::size_t i, long long type, double radius) const;
  double radius_of(const Frame& frame, std::size_t i, long long type) const;
  void watch_stride(const Beads& beads);

  const MillFile& mill_;
  WallWatch walls_;
  Spool spool_;
  Census census_;
  std::optional<bool> has_velocity_, has_spin_, has_ids_;
  std::vector<std::string> passed_over_;
  std::vector<double> strides_, radius_;  ///< radius: of each bead of the frame at hand
  std::vector<std::size_t> rows_;         ///< in the census, of each bead of the frame at hand
  Beads before_;
  std::size_t empty_ = 0, least_ = 0, most_ = 0, changed_ = 0;
  std::size_t read_ = 0;  ///< frames, with those that hold no bead
  double stride_ = 0;
  bool time_unknown_ = false;
};

}  // namespace millscope::frames
