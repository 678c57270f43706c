// All frames of an import, read once: turned into the mill's frame, judged, counted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/frames/beads.hpp"
#include "studies/frames/frame.hpp"
#include "studies/frames/mill_file.hpp"
#include "studies/frames/motion_watch.hpp"
#include "studies/frames/wall_watch.hpp"

namespace millscope::frames {

class Gather {
 public:
  Gather(const MillFile& mill, const std::filesystem::path& spool) : mill_(mill), walls_(mill), motion_(mill), spool_(spool) {}

  /// Throws base::UserError, one line with file:line, for what cannot be.
  void read();

  const Census& census() const { return census_; }
  Spool& spool() { return spool_; }
  const WallWatch& walls() const { return walls_; }
  bool has_velocity() const { return has_velocity_.value_or(false); }
  bool has_spin() const { return has_spin_.value_or(false); }
  bool has_ids() const { return has_ids_.value_or(false); }
  bool beads_vary() const { return least_ != most_ || census_.beads().size() != most_; }
  double stride() const { return motion_.stride(); }  ///< of MotionWatch
  /// What a reader must know, a sentence each.
  std::vector<std::string> notes() const;

 private:
  void take_time(Frame& frame, Beads& beads);
  void require_rising(const Frame& frame, double time) const;
  void require_same(const Frame& frame, std::optional<bool>& first, bool now, const char* what) const;
  void take_ids(const Frame& frame, Beads& beads);
  void take_motion(const Frame& frame, Beads& beads);
  void take_kinds(const Frame& frame);
  void watch_change(const Frame& frame, std::size_t i, BeadKind& kind, double radius);
  double density_of(const Frame& frame, std::size_t i, long long type, double radius) const;
  double radius_of(const Frame& frame, std::size_t i, long long type) const;

  const MillFile& mill_;
  WallWatch walls_;
  MotionWatch motion_;
  std::shared_ptr<TypeWords> types_ = std::make_shared<TypeWords>();
  Spool spool_;
  Census census_;
  std::optional<bool> has_velocity_, has_spin_, has_ids_;
  std::vector<std::string> passed_over_;
  std::vector<double> radius_;     ///< of each bead of the frame at hand
  std::vector<std::size_t> rows_;  ///< in the census, of each bead of the frame at hand
  std::size_t empty_ = 0, least_ = 0, most_ = 0, changed_ = 0, changed_mass_ = 0;
  std::size_t read_ = 0;  ///< frames, with those that hold no bead
  bool time_unknown_ = false, time_overruled_ = false, spin_without_unit_ = false;
};

}  // namespace millscope::frames
