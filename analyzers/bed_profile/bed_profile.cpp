// Velocity along the free surface against depth: the profile that studies of rotating drums show.
//
//   g = ⟨(x, y)⟩                  centre of the charge
//   n = −g/|g|                    the bed's normal, away from the bed, through the mill's axis
//   t = sign Ω ẑ × g/|g|          along the surface, the way the shell goes beneath the bed
//   p = (x, y)·n                  position from the axis: −R at the shell beneath the bed, 0 at the axis
//   v(p_k) = Σ w h_k v·t / Σ w h_k  over |(x, y)·t| ≤ band/2,  h_k = max(0, 1 − |p − p_k|/Δp)
//
// v > 0 is carried with the shell, v < 0 flows down the surface. g is known only when all is seen, so beads are gathered in cells of a
// fixed map first; each cell stands at the mean place of its beads, so that its width blurs v only where v bends within it.
#include <algorithm>
#include <optional>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr std::int64_t kCells = 80;  // from shell to shell

constexpr Parameter kParameters[] = {
    integer_parameter("points", 51, 5, 81, "Positions from the shell beneath the bed through the axis to the shell above it."),
    number_parameter("band", "1", 0.2, 0.01, 2, "Width of the strip about the bed's normal, in radii of the shell."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

enum Moment { kTime, kX, kY, kVx, kVy, kMoments };

/// Directions of the bed; known when |g| > 0.
struct Bed {
  double along_x, along_y, normal_x, normal_y;
};

class BedProfile {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  BedProfile(const Parameters& p, const AnalyzerContext& context)
      : range_(axial_range(p, context)),
        radius_(shell_radius(context)),
        sense_(known_sense(context)),
        points_(p.integer("points")),
        half_band_(0.5 * p.number("band") * radius_),
        cells_(-radius_, radius_, kCells) {}

  std::vector<ArrayInfo> arrays() const {
    const auto n = static_cast<std::uint64_t>(kCells);
    return {additive("map", "mixed", {n, n, kMoments})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    for (std::int64_t s = block.first[0]; s < block.first[block.frame_count]; ++s) {
      const double x = block.position[0][s], y = block.position[1][s], w = block.weight[s];
      const std::optional<std::int64_t> cell = cell_at(cells_, x, y);
      if (!cell || !range_.contains(block.position[2][s])) continue;
      double* m = sums[0] + *cell * kMoments;
      m[kTime] += w;
      m[kX] += w * x;
      m[kY] += w * y;
      m[kVx] += w * block.velocity[0][s];
      m[kVy] += w * block.velocity[1][s];
    }
  }

  void finish(const double* const* sums, Results& results) const {
    const auto n = as_size(points_);
    double time = 0, x = 0, y = 0;
    for (std::int64_t c = 0; c < kCells * kCells; ++c) {
      const double* m = sums[0] + c * kMoments;
      time += m[kTime], x += m[kX], y += m[kY];
    }
    x = ratio(x, time), y = ratio(y, time);
    const double depth = std::hypot(x, y);
    const Bed bed{-sense_ * y / depth, sense_ * x / depth, -x / depth, -y / depth};
    std::vector<double> position(n), weight(n), velocity(n);
    for (std::size_t k = 0; k < n; ++k) position[k] = -radius_ + static_cast<double>(k) * step();
    if (depth > 0) lay_on_line(bed, sums[0], weight, velocity);
    for (std::size_t k = 0; k < n; ++k) {
      velocity[k] = ratio(velocity[k], weight[k]);
      weight[k] = ratio(weight[k], time * step());
    }
    results.add("position", "m", position.data(), {n}, "Along the bed's normal from the axis; below 0 on the side of the bed.");
    results.add("velocity", "m/s", velocity.data(), {n}, "Mean velocity along the free surface; above 0 with the shell beneath the bed.",
                {"position"});
    results.add("time_share", "1/m", weight.data(), {n}, "Share of the beads' time that the strip holds, per length of the normal.",
                {"position"}, kNotNegative);
    results.add("surface_angle", "deg", kDegrees * angle_of(sense_ * x, -y),
                "Angle of the free surface from the horizontal: that of the charge's centre from 6 o'clock, in the turning sense.");
    results.add("still_position", "m", still(position, velocity),
                "Position of the first change of sign, going from the shell beneath the bed; NaN: nowhere.");
  }

 private:
  double step() const { return 2 * radius_ / static_cast<double>(points_ - 1); }

  void lay_on_line(const Bed& bed, const double* map, std::vector<double>& weight, std::vector<double>& momentum) const {
    for (std::int64_t c = 0; c < kCells * kCells; ++c) {
      const double* m = map + c * kMoments;
      if (!(m[kTime] > 0)) continue;
      const double x = m[kX] / m[kTime], y = m[kY] / m[kTime];
      if (std::fabs(x * bed.along_x + y * bed.along_y) > half_band_) continue;
      const double place = (x * bed.normal_x + y * bed.normal_y + radius_) / step(), along = m[kVx] * bed.along_x + m[kVy] * bed.along_y;
      const std::int64_t k = std::clamp<std::int64_t>(static_cast<std::int64_t>(place), 0, points_ - 2);
      const double upper = std::clamp(place - static_cast<double>(k), 0.0, 1.0);
      const auto at = as_size(k);
      weight[at] += (1 - upper) * m[kTime], momentum[at] += (1 - upper) * along;
      weight[at + 1] += upper * m[kTime], momentum[at + 1] += upper * along;
    }
  }

  static double still(const std::vector<double>& position, const std::vector<double>& velocity) {
    for (std::size_t k = 1; k < position.size(); ++k) {
      const double below = velocity[k - 1], above = velocity[k];
      if (below > 0 && above <= 0) return position[k - 1] + (position[k] - position[k - 1]) * below / (below - above);
    }
    return kNaN;
  }

  AxialRange range_;
  double radius_, sense_;
  std::int64_t points_;
  double half_band_;
  Bins cells_;
};

constexpr Descriptor kDescriptor = describe<BedProfile>({
    .name = "bed_profile",
    .version = "0.1.0",
    .doc = "Velocity along the free surface against depth, on the bed's normal through the mill's axis.",
    .equation = "v(p) = sum w v.t / sum w on the line through the axis and the centre of the charge",
    .citation = "Alizadeh et al. 2013, AIChE Journal 59 (drum profiles by particle tracking)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
