// Mean acceleration of the beads by place and against speed, without differentiating: momentum that comes into a cell against what
// leaves it.
//
//   a(cell) = Σ (v_k+1 − v_k) / Σ (t_k+1 − t_k)   over steps of a track whose middle lies in the cell
//
// Within one visit the sum telescopes to (v_out − v_in)/dwell: only the velocities at the cell's border count, so that noise does not grow
// with the rate. In free flight a = g; elsewhere it is the mean force per mass of walls, neighbours, fluid. Along the motion:
// Σ v̂·Δv / Σ Δt by speed, v̂ the direction of the mean of both velocities: what brakes fast beads.
#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "analyzers/common/angle.hpp"
#include "analyzers/common/grid.hpp"
#include "analyzers/common/mill.hpp"
#include "analyzers/common/tracks.hpp"

#include "millscope/element.hpp"

namespace millscope::analyzers {
namespace {

constexpr Parameter kParameters[] = {
    integer_parameter("rings", 5, 1, 1000, "Rings of equal width from the axis to the shell."),
    integer_parameter("sectors", 12, 1, 1000, "Sectors of equal angle, from 6 o'clock in the turning sense."),
    integer_parameter("bins_speed", 12, 1, 1000, "Bins of the speed over the shell's."),
    number_parameter("largest_speed", "1", 2, 0.01, 1000, "End of the speed's bins, in speeds of the shell."),
    kAxialFrom,
    kAxialTo,
    kEndTrim,
};

enum Moment { kTime, kX, kY, kVx, kVy, kMoments };
enum SpeedMoment { kSpeedTime, kAlong, kSpeedMoments };

class MeanAcceleration {
 public:
  static constexpr std::uint64_t kNeeds = kHasVelocity;

  MeanAcceleration(const Parameters& p, const AnalyzerContext& context)
      : range_(axial_range(p, context)),
        rings_(0, shell_radius(context), p.integer("rings")),
        sectors_(-std::numbers::pi, std::numbers::pi, p.integer("sectors")),
        speeds_(0, p.number("largest_speed"), p.integer("bins_speed")),
        sense_(known_sense(context)),
        shell_speed_(std::fabs(context.omega) * shell_radius(context)) {}

  std::vector<ArrayInfo> arrays() const {
    const auto n = [](std::int64_t i) { return static_cast<std::uint64_t>(i); };
    return {additive("cells", "mixed", {n(rings_.count), n(sectors_.count), kMoments}),
            additive("speeds", "mixed", {n(speeds_.count), kSpeedMoments})};
  }

  void accumulate(const FrameBlock& block, double* const* sums) const {
    for_each_track(block, 1, [&](const Track& track) {
      for (std::size_t i = 1; i < track.size(); ++i) step(block, track, i, sums);
    });
  }

  void finish(const double* const* sums, Results& results) const {
    const auto rings = as_size(rings_.count), sectors = as_size(sectors_.count);
    const auto speeds = as_size(speeds_.count);
    const std::size_t cells = rings * sectors;
    std::vector<double> x(cells), y(cells), vx(cells), vy(cells), time(cells), along(speeds);
    for (std::size_t i = 0; i < cells; ++i) {
      const double* m = sums[0] + i * kMoments;
      time[i] = m[kTime], x[i] = ratio(m[kX], m[kTime]), y[i] = ratio(m[kY], m[kTime]);
      vx[i] = ratio(m[kVx], m[kTime]), vy[i] = ratio(m[kVy], m[kTime]);
    }
    for (std::size_t i = 0; i < speeds; ++i) along[i] = ratio(sums[1][i * kSpeedMoments + kAlong], sums[1][i * kSpeedMoments + kSpeedTime]);
    results.add("r_edges", "m", rings_.edges().data(), {rings + 1}, "Edges of the rings.");
    results.add("angle_edges", "deg", sectors_.edges(180 / std::numbers::pi).data(), {sectors + 1},
                "Edges of the sectors, from 6 o'clock in the turning sense.");
    results.add("speed_edges", "1", speeds_.edges().data(), {speeds + 1}, "Edges of the bins of speed over the shell's.");
    results.add("x", "m/s^2", x.data(), {rings, sectors}, "Mean acceleration along x.", {"r_edges", "angle_edges"}, kOdd);
    results.add("y", "m/s^2", y.data(), {rings, sectors}, "Mean acceleration along y, upwards.", {"r_edges", "angle_edges"});
    results.add("velocity_x", "m/s", vx.data(), {rings, sectors}, "Mean velocity along x.", {"r_edges", "angle_edges"}, kOdd);
    results.add("velocity_y", "m/s", vy.data(), {rings, sectors}, "Mean velocity along y, upwards.", {"r_edges", "angle_edges"});
    results.add("time", "s", time.data(), {rings, sectors}, "Time of the beads in each cell.", {"r_edges", "angle_edges"}, kBookkeeping);
    results.add("along_motion", "m/s^2", along.data(), {speeds},
                "Mean acceleration along the motion by speed over the shell's: below 0 it brakes.", {"speed_edges"});
  }

 private:
  void step(const FrameBlock& block, const Track& track, std::size_t i, double* const* sums) const {
    const std::int64_t before = track.points[i - 1].sample, after = track.points[i].sample;
    const double duration = track.time(i) - track.time(i - 1);
    const double z = 0.5 * (block.position[2][before] + block.position[2][after]);
    if (!(duration > 0) || !range_.contains(z)) return;
    const double x = 0.5 * (block.position[0][before] + block.position[0][after]),
                 y = 0.5 * (block.position[1][before] + block.position[1][after]);
    const double dx = block.velocity[0][after] - block.velocity[0][before], dy = block.velocity[1][after] - block.velocity[1][before];
    const std::optional<std::int64_t> ring = rings_.at(std::hypot(x, y)), sector = sectors_.at(angle_of(sense_ * x, -y));
    const double vx = 0.5 * (block.velocity[0][before] + block.velocity[0][after]),
                 vy = 0.5 * (block.velocity[1][before] + block.velocity[1][after]);
    if (ring && sector) {
      double* m = sums[0] + (*ring * sectors_.count + *sector) * kMoments;
      m[kTime] += duration, m[kX] += dx, m[kY] += dy, m[kVx] += vx * duration, m[kVy] += vy * duration;
    }
    const double speed = std::hypot(vx, vy);
    const std::optional<std::int64_t> bin = shell_speed_ > 0 ? speeds_.at(speed / shell_speed_) : std::nullopt;
    if (!bin || !(speed > 0)) return;
    sums[1][*bin * kSpeedMoments + kSpeedTime] += duration;
    sums[1][*bin * kSpeedMoments + kAlong] += (dx * vx + dy * vy) / speed;
  }

  AxialRange range_;
  Bins rings_, sectors_, speeds_;
  double sense_, shell_speed_;
};

constexpr Descriptor kDescriptor = describe<MeanAcceleration>({
    .name = "mean_acceleration",
    .version = "0.1.0",
    .doc = "Mean acceleration of the beads by place and against speed, from the momentum that enters and leaves.",
    .equation = "a = sum dv / sum dt over the steps in a cell; along the motion: sum dv.v/|v| / sum dt",
    .citation = "Momentum balance in integral form; compare Messenger & Bortz 2021, doi:10.1137/20M1343166 (weak form)",
    .parameters = kParameters,
});

}  // namespace
}  // namespace millscope::analyzers

MILLSCOPE_PLUGINS(&millscope::analyzers::kDescriptor)
