#include "studies/inspect/mill_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/base/statistics.hpp"
#include "studies/inspect/circles.hpp"
#include "studies/inspect/resample.hpp"
#include "studies/inspect/rides.hpp"
#include "studies/inspect/windows.hpp"
#include "studies/recording/noise.hpp"

namespace millscope::inspect {
namespace {

constexpr std::size_t kFewestRides = 5;
constexpr std::size_t kDraws = 120;
// What resampling rides cannot see, because it is in all of them: beads that do not quite touch the shell (part of its radius), and that
// roll on between two lifters (part of its speed). From thirty recordings of a mill whose axis and speed are known.
constexpr double kLooseness = 0.001;
constexpr double kRolling = 0.006;
// The axis besides: beads that ride on the lifters' tops, press into a soft liner or leave it lie within the noise of the shell's circle
// and pull it. Part of the radius; 0.1 to 0.5 % in simulated mills of 150 mm with 3 to 10 mm high lifters (docs/inspect.md).
constexpr double kAxisPull = 0.003;

/// What the steps share.
struct Work {
  const recording::Recording& recording;
  double noise = 0;  ///< of x and y, m
  PlanePoints points;
  std::vector<Parabola> windows;
  Rotation rotation;
  Circle circle;
  RideRule rule;
  std::vector<Ride> rides;
};

std::string rides_text(std::size_t rides) { return fmt::format("{} {}", rides, rides == 1 ? "ride" : "rides"); }

double plane_noise(const recording::Recording& recording) {
  double sum = 0, count = 0;
  for (const recording::Run& run : recording.runs) {
    const auto noise = recording::difference_noise(run, recording.gap_limit);
    const auto n = static_cast<double>(run.size());
    sum += 0.5 * (noise[0] + noise[1]) * n;
    count += n;
  }
  return sum / count;
}

// At most about twenty thousand points, evenly chosen, in groups of a second.
PlanePoints plane_points(const recording::Recording& recording) {
  std::size_t count = 0;
  for (const recording::Run& run : recording.runs) count += run.size();
  const std::size_t stride = count / 20000 + 1;
  PlanePoints points;
  std::size_t group = 0;
  for (const recording::Run& run : recording.runs) {
    double start = run.time.front();
    for (std::size_t i = 0; i < run.size(); i += stride) {
      if (run.time[i] - start > 1) {
        start = run.time[i];
        ++group;
      }
      points.x.push_back(run.position[0][i]);
      points.y.push_back(run.position[1][i]);
      points.group.push_back(group);
    }
    ++group;
  }
  return points;
}

// The window is long against the noise and short against a turn: first by the rate of points, then by the speed found.
bool find_rotation(Work& work) {
  const std::vector<UnbrokenStretch> stretches = unbroken_stretches(work.recording);
  double length = std::clamp(12 * median_interval(work.recording), 0.04, 0.2);
  for (int pass = 0; pass < 2; ++pass) {
    work.windows = local_parabolas(stretches, length, 8);
    if (const std::size_t stride = work.windows.size() / 3000 + 1; stride > 1) {
      for (std::size_t i = 0; i * stride < work.windows.size(); ++i) work.windows[i] = work.windows[i * stride];
      work.windows.resize(work.windows.size() / stride);
    }
    const auto found = search_rotation(work.windows, work.points, work.noise);
    if (!found) return false;
    work.rotation = *found;
    length = std::clamp(0.45 / std::fabs(found->angular_velocity), 0.03, 0.5);
  }
  return true;
}

// Only what lies far out decides where the enclosing circle stands.
void keep_outer(Work& work) {
  const Circle& c = work.rotation.circle;
  PlanePoints outer;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    if (std::hypot(work.points.x[i] - c.x, work.points.y[i] - c.y) < 0.8 * c.radius) continue;
    outer.x.push_back(work.points.x[i]);
    outer.y.push_back(work.points.y[i]);
    outer.group.push_back(work.points.group[i]);
  }
  work.points = std::move(outer);
}

Circle enclose(const Work& work, const std::vector<double>& weights) {
  const double radius = work.rotation.circle.radius;
  const Circle coarse =
      touching_circle(work.points, weights, work.rotation.circle, 0.06 * radius, std::max(3 * work.noise, 0.012 * radius));
  return touching_circle(work.points, weights, coarse, 0.01 * radius, std::max(2.2 * work.noise, 0.008 * radius));
}

// Rides and their circle, in turn.
void settle(Work& work) {
  const int sense = work.rotation.angular_velocity > 0 ? 1 : -1;
  work.rule.band = std::max(4.2 * work.noise, 0.012 * work.circle.radius);
  for (int pass = 0; pass < 4; ++pass) {
    work.rides = find_rides(work.recording, work.circle, sense, work.rule);
    if (work.rides.size() < kFewestRides) return;
    work.circle = ridge_circle(points_of(work.recording, work.rides), {}, work.circle, work.rule.band / 1.56);
  }
}

double scatter_about(const PlanePoints& points, const Circle& circle) {
  std::vector<double> misses;
  for (std::size_t i = 0; i < points.size(); ++i)
    misses.push_back(std::fabs(std::hypot(points.x[i] - circle.x, points.y[i] - circle.y) - circle.radius));
  return misses.empty() ? 0 : 1.4826 * base::quantile(misses, 0.5);
}

void report_circle(const Work& work, MillMotion& motion) {
  const PlanePoints points = points_of(work.recording, work.rides);
  std::vector<double> weights(points.size());
  const auto deviation = bootstrap_deviation(work.rides.size(), kDraws, [&](const std::vector<double>& times) {
    for (std::size_t i = 0; i < points.size(); ++i) weights[i] = times[points.group[i]];
    const Circle c = ridge_circle(points, weights, work.circle, work.rule.band / 1.56);
    return std::vector<double>{c.x, c.y, c.radius};
  });
  const double freedom = static_cast<double>(work.rides.size()) - 3;
  const std::string basis = fmt::format("{} rides along one circle", work.rides.size());
  motion.axis_scatter = {deviation[0], deviation[1]};
  motion.axis[0] = {interval(work.circle.x, deviation[0], freedom, kAxisPull * work.circle.radius), basis};
  motion.axis[1] = {interval(work.circle.y, deviation[1], freedom, kAxisPull * work.circle.radius), basis};
  motion.path_radius = {interval(work.circle.radius, deviation[2], freedom, 2 * kLooseness * work.circle.radius),
                        basis + ", the outermost; a shell that the tracer never touched is larger"};
  motion.radial_scatter = scatter_about(points, work.circle);
}

void report_speed(const Work& work, MillMotion& motion) {
  const double speed = common_speed(work.rides, {});
  const auto deviation = bootstrap_deviation(
      work.rides.size(), kDraws, [&](const std::vector<double>& times) { return std::vector<double>{common_speed(work.rides, times)}; });
  double near = 0, all = 0;
  for (const Ride& ride : work.rides) {
    all += ride.duration;
    if (std::fabs(ride.angular_velocity / speed - 1) < 0.025 + 2 * ride.deviation / std::fabs(speed)) near += ride.duration;
  }
  Finding& result = motion.speed;
  result.estimate = interval(std::fabs(speed), deviation[0], static_cast<double>(work.rides.size()) - 1, kRolling * std::fabs(speed));
  result.note = fmt::format("{} rides along the shell, {:.0f} % of their time within 2.5 % of it; even slip of all would hide",
                            work.rides.size(), 100 * near / all);
  if (near >= 0.5 * all) return;
  result.bound = Bound::at_least;
  result.estimate->high = std::numeric_limits<double>::infinity();
  result.note = "rides along the shell differ in speed, so the charge slips and the shell is at least so fast; " + result.note;
}

// Rides along a wall have one radius; rides through the charge that happen to pass a band have any.
bool met_wall(const Work& work) { return work.rides.size() >= kFewestRides && radius_spread(work.rides) < 0.26 * work.rule.band; }

std::string why_no_wall(const Work& work) {
  if (work.rides.size() < kFewestRides) return fmt::format("only {} along the shell", rides_text(work.rides.size()));
  return fmt::format("{} whose radii differ by {:.1f} mm, so that no wall is recognised", rides_text(work.rides.size()),
                     radius_spread(work.rides) * 1e3);
}

// The tracer hardly met the shell: the enclosing circle, with blocks of a second resampled.
void report_enclosing(const Work& work, MillMotion& motion) {
  std::vector<double> weights(work.points.size());
  const auto deviation = bootstrap_deviation(work.points.group.back() + 1, 40, [&](const std::vector<double>& times) {
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = times[work.points.group[i]];
    const Circle c = enclose(work, weights);
    return std::vector<double>{c.x, c.y, c.radius};
  });
  const std::string basis = why_no_wall(work) + ": from the circle that encloses the points";
  const double floor = 0.01 * work.circle.radius;
  motion.axis[0] = {interval(work.circle.x, deviation[0], 30, floor), basis};
  motion.axis[1] = {interval(work.circle.y, deviation[1], 30, floor), basis};
  base::Interval90 radius = interval(work.circle.radius, deviation[2], 30, floor);
  radius.high = std::numeric_limits<double>::infinity();
  motion.path_radius = {radius, basis + "; the tracer may never have touched the shell", Bound::at_least};
}

// The fast end of the outer windows' angular velocities.
void report_least_speed(const Work& work, MillMotion& motion) {
  std::vector<double> speeds;
  for (const Parabola& w : work.windows) {
    const double dx = w.position[0] - work.circle.x, dy = w.position[1] - work.circle.y, square = dx * dx + dy * dy;
    const double radial = (dx * w.velocity[0] + dy * w.velocity[1]) / std::sqrt(square),
                 omega = (dx * w.velocity[1] - dy * w.velocity[0]) / square;
    const bool outer = std::sqrt(square) > 0.75 * work.circle.radius,
               circular = std::fabs(radial) < 0.1 * std::fabs(omega) * std::sqrt(square);
    if (outer && circular && omega * motion.sense > 0) speeds.push_back(std::fabs(omega));
  }
  if (speeds.size() < 10) {
    motion.speed.note = "too few circular paths near the shell";
    return;
  }
  const double typical = base::quantile(speeds, 0.9), low = base::quantile(speeds, 0.5);
  motion.speed = {base::Interval90{typical, low, std::numeric_limits<double>::infinity()},
                  why_no_wall(work) + ": the outer charge turns so fast, the shell at least", Bound::at_least};
}

}  // namespace

Agreement compare_speed(const recording::Condition& stated, const MillMotion& motion) {
  constexpr double kFar = 1.5, kFarBeyondBound = 10;
  if (!stated.speed || motion.sense == 0) return Agreement::unknown;
  if (stated.angular_velocity.value_or(0) * motion.sense < 0) return Agreement::opposite;
  if (!motion.speed.estimate) return Agreement::unknown;
  const base::Interval90& found = *motion.speed.estimate;
  const double least = found.low / (motion.rides > 0 ? kFar : 2 * kFar);  // without rides the charge may fall past the shell
  const double high = motion.speed.bound == Bound::at_least ? kFarBeyondBound / kFar * found.value : found.high;
  if (*stated.speed < least || *stated.speed > kFar * high) return Agreement::far;
  return *stated.speed < found.low || *stated.speed > found.high ? Agreement::outside : Agreement::within;
}

MillMotion estimate_motion(const recording::Recording& recording) {
  Work work{recording, plane_noise(recording), plane_points(recording), {}, {}, {}, {}, {}};
  MillMotion motion;
  motion.noise = work.noise;
  if (!find_rotation(work)) {
    const char* why = "no rigid rotation of the outer charge is recognised: too few points in unbroken stretches, or no turning mill";
    motion.axis = {Finding{{}, why}, Finding{{}, why}};
    motion.speed.note = motion.path_radius.note = why;
    return motion;
  }
  motion.sense = work.rotation.angular_velocity > 0 ? 1 : -1;
  keep_outer(work);
  work.circle = enclose(work, {});
  const Circle enclosing = work.circle;
  settle(work);
  if (met_wall(work)) {
    motion.rides = work.rides.size();
    for (const Ride& ride : work.rides) motion.ride_time += ride.duration;
    report_circle(work, motion);
    report_speed(work, motion);
  } else {
    work.circle = enclosing;
    report_enclosing(work, motion);
    report_least_speed(work, motion);
  }
  return motion;
}

std::optional<std::array<double, 2>> axis_by_rides(const recording::Recording& recording, double path_radius, double angular_velocity,
                                                   double noise) {
  Work work{recording, noise, {}, {}, {}, {}, {}, {}};
  work.circle = {0, 0, path_radius};
  work.rotation = {work.circle, angular_velocity, 0};
  settle(work);
  if (!met_wall(work)) return {};
  return std::array{work.circle.x, work.circle.y};
}

}  // namespace millscope::inspect
