#include "studies/inspect/rides.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millscope::inspect {
namespace {

// Angles about the circle's centre in the turning sense, unwrapped.
std::vector<double> angles(const recording::Run& run, const std::vector<std::size_t>& points, const Circle& circle, int sense) {
  std::vector<double> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    double angle = sense * std::atan2(run.position[1][points[i]] - circle.y, run.position[0][points[i]] - circle.x);
    if (i > 0) angle += kTurn * std::round((result[i - 1] - angle) / kTurn);
    result[i] = angle;
  }
  return result;
}

// Slope of angle over time, and its standard error.
void fit_speed(const recording::Run& run, const std::vector<double>& angle, int sense, Ride& ride) {
  const auto n = static_cast<double>(ride.points.size());
  double mean_time = 0, mean_angle = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    mean_time += run.time[ride.points[i]] / n;
    mean_angle += angle[i] / n;
  }
  double tt = 0, ta = 0, aa = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const double t = run.time[ride.points[i]] - mean_time, a = angle[i] - mean_angle;
    tt += t * t;
    ta += t * a;
    aa += a * a;
  }
  ride.angular_velocity = sense * ta / tt;
  ride.deviation = std::sqrt(std::max(0.0, aa - ta * ta / tt) / (n - 2) / tt);
  ride.duration = run.time[ride.points.back()] - run.time[ride.points.front()];
}

// Cuts the ends, divides what is long.
void add_rides(const recording::Run& run, std::size_t number, const std::vector<std::size_t>& points, const Circle& circle, int sense,
               const RideRule& rule, std::vector<Ride>& rides) {
  if (points.size() < 8) return;
  const std::vector<double> angle = angles(run, points, circle, sense);
  const double whole = angle.back() - angle.front();
  if (whole < rule.least_angle) return;
  const double low = angle.front() + rule.cut_start * whole, high = angle.back() - rule.cut_end * whole;
  const auto parts = static_cast<std::size_t>(std::ceil((high - low) / rule.longest));
  for (std::size_t part = 0; part < parts; ++part) {
    const double from = low + (high - low) * static_cast<double>(part) / static_cast<double>(parts);
    const double to = low + (high - low) * static_cast<double>(part + 1) / static_cast<double>(parts);
    Ride ride;
    ride.run = number;
    std::vector<double> inside;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (angle[i] < from || angle[i] >= to) continue;
      ride.points.push_back(points[i]);
      inside.push_back(angle[i]);
    }
    if (ride.points.size() < 5) continue;
    fit_speed(run, inside, sense, ride);
    for (const std::size_t i : ride.points)
      ride.radius += std::hypot(run.position[0][i] - circle.x, run.position[1][i] - circle.y) / static_cast<double>(ride.points.size());
    if (ride.angular_velocity * sense > 0) rides.push_back(std::move(ride));
  }
}

}  // namespace

std::vector<Ride> find_rides(const recording::Recording& recording, const Circle& circle, int sense, const RideRule& rule) {
  constexpr std::size_t kMayMiss = 2;  // points outside the band that do not end a ride
  const double inner = std::max(0.0, circle.radius - rule.band), outer = circle.radius + rule.band;
  std::vector<Ride> rides;
  for (std::size_t r = 0; r < recording.runs.size(); ++r) {
    const recording::Run& run = recording.runs[r];
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double dx = run.position[0][i] - circle.x, dy = run.position[1][i] - circle.y, square = dx * dx + dy * dy;
      if (square < inner * inner || square > outer * outer) continue;
      if (!points.empty() && (i - points.back() > kMayMiss + 1 || run.time[i] - run.time[points.back()] > recording.gap_limit)) {
        add_rides(run, r, points, circle, sense, rule, rides);
        points.clear();
      }
      points.push_back(i);
    }
    add_rides(run, r, points, circle, sense, rule, rides);
  }
  return rides;
}

double radius_spread(const std::vector<Ride>& rides) {
  const auto n = static_cast<double>(rides.size());
  double mean = 0, squares = 0;
  for (const Ride& ride : rides) mean += ride.radius / n;
  for (const Ride& ride : rides) squares += (ride.radius - mean) * (ride.radius - mean);
  return n > 1 ? std::sqrt(squares / (n - 1)) : 0;
}

PlanePoints points_of(const recording::Recording& recording, const std::vector<Ride>& rides) {
  PlanePoints points;
  for (std::size_t r = 0; r < rides.size(); ++r) {
    const recording::Run& run = recording.runs[rides[r].run];
    for (const std::size_t i : rides[r].points) {
      points.x.push_back(run.position[0][i]);
      points.y.push_back(run.position[1][i]);
      points.group.push_back(r);
    }
  }
  return points;
}

double common_speed(const std::vector<Ride>& rides, const std::vector<double>& times) {
  constexpr std::size_t kStarts = 25;
  std::vector<double> starts;
  for (const Ride& ride : rides) starts.push_back(ride.angular_velocity);
  std::sort(starts.begin(), starts.end());
  const std::size_t stride = starts.size() / kStarts + 1;
  double best = -1, result = 0;
  for (std::size_t start = stride / 2; start < starts.size(); start += stride) {
    double speed = starts[start];
    double density = 0;
    for (int pass = 0; pass < 20; ++pass) {  // mean shift
      double sum = 0, shifted = 0;
      density = 0;
      for (std::size_t i = 0; i < rides.size(); ++i) {
        const double width = std::hypot(0.008 * speed, rides[i].deviation), e = (rides[i].angular_velocity - speed) / width;
        const double weight = rides[i].duration * (times.empty() ? 1 : times[i]) * std::exp(-0.5 * e * e) / width;
        density += weight;
        sum += weight / width;
        shifted += weight / width * rides[i].angular_velocity;
      }
      if (!(sum > 0) || std::fabs(shifted / sum - speed) < 1e-6 * std::fabs(speed)) break;
      speed = shifted / sum;
    }
    if (density > best) {
      best = density;
      result = speed;
    }
  }
  return result;
}

}  // namespace millscope::inspect
