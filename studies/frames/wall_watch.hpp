// What the beads show of the mill that is stated: whether they are in it, which way is down, how fast its shell turns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/frames/beads.hpp"
#include "studies/frames/mill_file.hpp"

namespace millscope::frames {

class WallWatch {
 public:
  explicit WallWatch(const MillFile& mill) : mill_(mill) {}

  /// `radius`: of each bead. Throws base::UserError where more beads are outside the mill than can be; `place`: of the frame.
  void look(const Beads& beads, const std::vector<double>& radius, const std::string& place);
  /// A bead where it is and how it moves: counts for `turning` where it is at the shell, and the mill turns at that time.
  void ride(double time, const base::Vector3& place, const base::Vector3& velocity, double radius);
  /// After the last frame. Throws base::UserError where the mill is too large or too long for its beads, or the charge hangs above its
  /// axis.
  void judge() const;

  /// Angular speed about our z of the beads within a fifth of their radius of the shell, the median; nothing where too few are seen, or
  /// they do not agree in sense. A bead that rides along turns as the shell; one that slips turns slower.
  std::optional<double> turning() const;
  std::size_t riding() const { return turning_.size(); }

  std::size_t outside() const { return outside_; }  ///< beads, most in one frame

 private:
  const MillFile& mill_;
  std::vector<double> turning_;
  std::size_t outside_ = 0;
  double farthest_ = 0;                 ///< m from the axis, of the beads' surfaces
  double low_ = 1e300, high_ = -1e300;  ///< m along the axis, of the beads' centres
  double mean_y_ = 0;
};

}  // namespace millscope::frames
