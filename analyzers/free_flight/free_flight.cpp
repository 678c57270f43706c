// Free flight: what pulls and what slows a bead in the air, from whole arcs pooled (arc_fit.hpp), and where arcs begin and end.
//
//   a = g − k |v| v        g: gravity, free in all three components; k: drag coefficient, 1/m
//   k = 3/8 ρ_fluid C_d/(ρ R) of a sphere
//
// Arcs are chosen from the samples (common/flight.hpp), the same way for simulated and measured beads; the fit uses the measured points
// themselves where there are any, else the samples. Arcs that a smooth path does not describe within the noise are left out and counted: a
// collision too weak to end the arc hides in them. Collisions that hide in the noise bend what is left, so compare a recording with a
// simulation seen by the same camera, not with 9.81.
#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "analyzers/common/flight.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"
#include "analyzers/free_flight/arc_fit.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr std::int64_t kAngleBins = 72;

constexpr Parameter kParameters[] = {
    kFlightTolerance,
    kFlightWindow,
    kLeastFlight,
    number_parameter("trim", "s", 0.01, 0, 1, "Left out at each end of an arc, where the spline still feels the collision."),
    integer_parameter("least_points", 8, 6, 10000, "Arcs with fewer points are left out and counted."),
    number_parameter("exact", "m", 1e-6, 1e-9, 1, "Accuracy of a point beyond its stated variance; simulated positions have no other."),
    number_parameter("roughest", "1", 2, 0.1, 1000, "Arcs whose residuals are larger than this many times their noise are left out."),
    integer_parameter("beads", 4000, 1, 1e9, "Arcs are looked for in at most about this many beads, evenly by id."),
};

enum Array { kNormal, kRight, kTotals, kLaunches, kLandings, kArrays };
enum Total { kSquare, kFreedom, kArcs, kRough, kShort, kDuration, kLength, kPoints, kLaunchSpeed, kLandingSpeed, kWatched, kTotalCount };

class FreeFlight {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  FreeFlight(const Parameters& p, const AnalyzerContext& context)
      : sense_(turning_sense(context)),
        gravity_(context.gravity),
        options_(flight_options(p, context)),
        trim_(p.number("trim")),
        exact_(p.number("exact")),
        roughest_(p.number("roughest")),
        least_points_(as_size(p.integer("least_points"))),
        stride_(even_stride(context.largest_id, p.integer("beads"))),
        angles_(-std::numbers::pi, std::numbers::pi, kAngleBins) {}

  std::vector<ArrayInfo> arrays() const {
    return {additive("normal", "mixed", {4, 4}), additive("right", "mixed", {4}), additive("totals", "mixed", {kTotalCount}),
            additive("launches", "1", {kAngleBins}), additive("landings", "1", {kAngleBins})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    const Locations locations(block);
    FlightFinder finder(options_);
    std::vector<ArcPoint> points;
    for_each_track(block, stride_, [&](const Track& track) {
      sums[kTotals][kWatched] += track.time(track.size() - 1) - track.time(0);
      for (const Arc& arc : finder.find(block, track)) {
        const double from = track.time(arc.first) + trim_, to = track.time(arc.last) - trim_;
        points.clear();
        if (locations.any()) {
          locations.gather(track.id, from, to, exact_ * exact_, points);
        } else {
          gather_samples(block, track, arc, from, to, points);
        }
        add_arc(block, track, arc, points, sums);
      }
    });
  }

  void finish(const double* const* sums, Results& results) const {
    add_counts(results, sums[kTotals]);
    add_fit(results, sums);
    if (sense_ == 0) return;  // angles have no direction
    results.add("angle_edges_deg", "deg", angles_.edges(kDegrees).data(), {kAngleBins + 1},
                "Edges of the angles from 6 o'clock, positive in the turning sense.");
    add_angles(results, sums[kLaunches], "launch", "begin");
    add_angles(results, sums[kLandings], "landing", "end");
  }

 private:
  /// The measured points of a block, by bead and time.
  class Locations {
   public:
    explicit Locations(const FrameBlock& block) : block_(&block) {
      if ((block.has & kHasLocations) == 0) return;
      order_.resize(as_size(block.location_count));
      for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::int64_t>(i);
      std::sort(order_.begin(), order_.end(), [&](std::int64_t a, std::int64_t b) {
        return std::pair(block.location_id[a], block.location_time[a]) < std::pair(block.location_id[b], block.location_time[b]);
      });
    }
    bool any() const { return (block_->has & kHasLocations) != 0; }
    void gather(std::int64_t id, double from, double to, double floor, std::vector<ArcPoint>& points) const {
      const FrameBlock& b = *block_;
      auto at = std::partition_point(order_.begin(), order_.end(), [&](std::int64_t i) {
        return b.location_id[i] < id || (b.location_id[i] == id && b.location_time[i] < from);
      });
      for (; at != order_.end() && b.location_id[*at] == id && b.location_time[*at] <= to; ++at) {
        const std::int64_t i = *at;
        const double variance = b.location_variance != nullptr ? b.location_variance[i] : 0;
        points.push_back({b.location_time[i],
                          {b.location_position[0][i], b.location_position[1][i], b.location_position[2][i]},
                          1 / (variance + floor)});
      }
    }

   private:
    const FrameBlock* block_;
    std::vector<std::int64_t> order_;
  };

  void gather_samples(const FrameBlock& block, const Track& track, const Arc& arc, double from, double to,
                      std::vector<ArcPoint>& out) const {
    for (std::size_t i = arc.first; i <= arc.last; ++i) {
      if (track.time(i) < from || track.time(i) > to) continue;
      const std::int64_t s = track.points[i].sample;
      const double variance = block.position_variance != nullptr ? block.position_variance[s] : 0;
      out.push_back({track.time(i), {block.position[0][s], block.position[1][s], block.position[2][s]}, 1 / (variance + exact_ * exact_)});
    }
  }

  void add_arc(const FrameBlock& block, const Track& track, const Arc& arc, const std::vector<ArcPoint>& points,
               double* const* sums) const {
    double* totals = sums[kTotals];
    if (points.size() < least_points_) {
      totals[kShort] += 1;
      return;
    }
    const auto equations = arc_equations(points, gravity_);
    if (!equations || equations->roughness > roughest_) {
      totals[kRough] += 1;
      return;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) sums[kNormal][4 * i + j] += equations->normal[i][j];
      sums[kRight][i] += equations->right[i];
    }
    totals[kSquare] += equations->square;
    totals[kFreedom] += equations->freedom;
    totals[kArcs] += 1;
    totals[kDuration] += track.time(arc.last) - track.time(arc.first);
    totals[kLength] += equations->length;
    totals[kPoints] += static_cast<double>(points.size());
    totals[kLaunchSpeed] += equations->first_speed;
    totals[kLandingSpeed] += equations->last_speed;
    if (arc.launch_seen) count_angle(block, track.points[arc.first].sample, sums[kLaunches]);
    if (arc.landing_seen) count_angle(block, track.points[arc.last].sample, sums[kLandings]);
  }

  void count_angle(const FrameBlock& block, std::int64_t s, double* counts) const {
    const std::optional<std::int64_t> bin = angles_.at(std::atan2(sense_ * block.position[0][s], -block.position[1][s]));
    if (bin) counts[*bin] += 1;
  }

  static void add_counts(Results& results, const double* t) {
    results.add("arcs", "1", t[kArcs], "Free flights that went into the fit.", kBookkeeping | kNotNegative);
    results.add("arcs_too_rough", "1", t[kRough], "Flights left out because a smooth path does not describe them within the noise.",
                kBookkeeping | kNotNegative);
    results.add("arcs_too_few_points", "1", t[kShort], "Flights left out because too few points lie in them.", kBookkeeping | kNotNegative);
    results.add("arcs_per_bead_second", "1/s", ratio(t[kArcs], t[kWatched]),
                "Flights that went into the fit, per second of a bead's time.");
    results.add("mean_duration", "s", ratio(t[kDuration], t[kArcs]), "Mean time from launch to landing, as far as it was seen.");
    results.add("mean_length", "m", ratio(t[kLength], t[kArcs]), "Mean length of the fitted paths.");
    results.add("mean_first_speed", "m/s", ratio(t[kLaunchSpeed], t[kArcs]), "Mean speed at the first fitted point.");
    results.add("mean_last_speed", "m/s", ratio(t[kLandingSpeed], t[kArcs]), "Mean speed at the last fitted point.");
  }

  void add_fit(Results& results, const double* const* sums) const {
    Square<4> normal;
    std::array<double, 4> right;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) normal[i][j] = sums[kNormal][4 * i + j];
      right[i] = sums[kRight][i];
    }
    const double freedom = sums[kTotals][kFreedom], square = sums[kTotals][kSquare];
    std::array<double, 4> both{kNaN, kNaN, kNaN, kNaN}, error = both;
    double rest = kNaN;
    if (const auto inverted = inverse(normal); inverted && freedom > 4) {
      both = product(*inverted, right);
      rest = square;
      for (std::size_t i = 0; i < 4; ++i) rest -= both[i] * right[i];
      rest = std::fmax(rest, 0) / (freedom - 4);
      for (std::size_t i = 0; i < 4; ++i) error[i] = std::sqrt(rest * (*inverted)[i][i]);
      both[1] -= gravity_;
    }
    const double size = std::hypot(both[0], both[1], both[2]);
    results.add("gravity", "m/s^2", both.data(), {3}, "Gravity from the arcs, fitted with drag; x, y, z.", {}, kFirstOdd);
    results.add("gravity_standard_error", "m/s^2", error.data(), {3}, "Of each component, from the scatter within the arcs.", {},
                kBookkeeping | kNotNegative);
    results.add("gravity_size", "m/s^2", size, "Its size; a wrong scale of the camera shows here.");
    results.add("gravity_tilt", "deg", kDegrees * std::atan2(both[0], -both[1]),
                "Its direction seen along the axis: 0 is straight down, positive towards +x.", kOdd);
    results.add("gravity_axial_tilt", "deg", kDegrees * std::atan2(both[2], std::hypot(both[0], both[1])), "Its direction towards +z.");
    results.add("drag", "1/m", both[3], "Drag coefficient k in a = g - k |v| v, fitted with gravity.");
    results.add("drag_standard_error", "1/m", error[3], "Of it, from the scatter within the arcs.", kBookkeeping | kNotNegative);
    results.add("residual", "1", std::sqrt(rest), "Rms of what the fit leaves, over the noise of the points.");

    std::array<double, 3> alone{kNaN, kNaN, kNaN};
    for (std::size_t i = 0; i < 3; ++i) alone[i] = ratio(right[i], normal[i][i]) - (i == 1 ? gravity_ : 0);
    results.add("gravity_without_drag", "m/s^2", alone.data(), {3}, "Gravity fitted with k = 0; x, y, z.", {}, kFirstOdd);
    results.add("drag_at_known_gravity", "1/m", ratio(right[3], normal[3][3]),
                "Drag coefficient with gravity as stated, straight down; the camera's scale and tilt go into it.");
  }

  void add_angles(Results& results, const double* counts, const std::string& what, const std::string& verb) const {
    std::vector<double> density(kAngleBins);
    double all = 0, below = 0, median = kNaN;
    for (std::int64_t i = 0; i < kAngleBins; ++i) all += counts[i];
    for (std::int64_t i = 0; i < kAngleBins; ++i) {
      element(density, i) = ratio(counts[i], all) / angles_.width();
      if (below < 0.5 * all && below + counts[i] >= 0.5 * all) median = angles_.edge(i) + angles_.width() * (0.5 * all - below) / counts[i];
      below += counts[i];
    }
    results.add((what + (what.back() == 'h' ? "es" : "s") + "_seen").c_str(), "1", all, ("Arcs that were seen to " + verb + ".").c_str(),
                kBookkeeping | kNotNegative);
    results.add((what + "_density").c_str(), "1/rad", density.data(), {kAngleBins},
                ("Distribution of the angles at which arcs " + verb + ".").c_str(), {"angle_edges_deg"});
    results.add((what + "_median").c_str(), "deg", kDegrees * median, ("Median angle at which arcs " + verb + ".").c_str());
  }

  double sense_, gravity_;
  FlightOptions options_;
  double trim_, exact_, roughest_;
  std::size_t least_points_;
  std::int64_t stride_;
  Bins angles_;
};

constexpr Descriptor kDescriptor = describe<FreeFlight>({
    .name = "free_flight",
    .version = "0.1.0",
    .doc = "Gravity and drag from whole free flights, pooled; where flights begin and end.",
    .equation = "x(t) = x0 + v0 t + g t^2/2 - k int int |v| v",
    .citation = "Ljung 1999, System Identification (output error)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
