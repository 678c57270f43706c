// Free flights of a bead: where its velocity changes as gravity alone would change it.
//
//   window [i, j]:  |(v_j − v_i)/(t_j − t_i) − g| < tolerance · |g|,   t_j − t_i ≥ window
//
// An arc goes from the first sample of a run of such windows to the last sample of its last one. Two arcs that overlap meet in the
// middle. The same selection serves simulated frames and splined recordings. A collision shorter than the window and weaker than
// tolerance · |g| · window goes unseen here.
#pragma once

#include <cmath>
#include <vector>

#include "analyzers/common/tracks.hpp"
#include "millscope/analyzer_adapter.hpp"

namespace millscope::analyzers {

struct FlightOptions {
  double gravity = 0;         ///< m/s², along −y
  double tolerance = 0;       ///< of gravity
  double window = 0;          ///< s
  double least_duration = 0;  ///< s; shorter arcs are left out
  bool keep_cut = false;      ///< arcs that the start or the end of the track cuts need half of that only
};

inline constexpr Parameter kFlightTolerance =
    number_parameter("flight_tolerance", "1", 0.3, 1e-3, 1, "Largest deviation of a flying bead's acceleration from gravity, of gravity.");
inline constexpr Parameter kFlightWindow =
    number_parameter("flight_window", "s", 0.04, 1e-4, 1, "Time over which a change of velocity is compared with gravity's.");
inline constexpr Parameter kLeastFlight =
    number_parameter("least_flight", "s", 0.1, 1e-3, 10, "Shorter flights are left out; a gap between two beads in a layer is no flight.");

/// The three options above; refuses where gravity is unknown.
inline FlightOptions flight_options(const Parameters& p, const AnalyzerContext& context) {
  if (!(context.gravity > 0)) throw Refusal("gravity is unknown, so free flight cannot be told from other motion");
  return {context.gravity, p.number("flight_tolerance"), p.number("flight_window"), p.number("least_flight"), false};
}

/// Samples first … last of a track.
struct Arc {
  std::size_t first, last;
  bool launch_seen;   ///< the bead was seen before, not in flight
  bool landing_seen;  ///< the bead was seen afterwards, not in flight
};

class FlightFinder {
 public:
  explicit FlightFinder(const FlightOptions& options) : options_(options) {}

  const std::vector<Arc>& find(const FrameBlock& block, const Track& track) {
    arcs_.clear();
    const std::size_t n = track.size();
    std::size_t j = 0;
    bool flying = false, seen_before = false;
    for (std::size_t i = 0; i < n; ++i) {
      while (j < n && track.time(j) - track.time(i) < options_.window * (1 - 1e-9)) ++j;
      if (j >= n) break;
      const bool free = falls_freely(block, track, i, j);
      if (free && !flying) arcs_.push_back({i, j, seen_before, false});
      if (free) arcs_.back().last = j;
      if (!free && flying) arcs_.back().landing_seen = true;
      if (!free) seen_before = true;
      flying = free;
    }
    separate();
    std::erase_if(arcs_, [&](const Arc& arc) {
      const bool whole = !options_.keep_cut || (arc.launch_seen && arc.landing_seen);
      return track.time(arc.last) - track.time(arc.first) < (whole ? 1 : 0.5) * options_.least_duration;
    });
    return arcs_;
  }

 private:
  bool falls_freely(const FrameBlock& block, const Track& track, std::size_t i, std::size_t j) const {
    const std::int64_t a = track.points[i].sample, b = track.points[j].sample;
    const double per_time = 1 / (track.time(j) - track.time(i)), limit = options_.tolerance * options_.gravity;
    const double x = (block.velocity[0][b] - block.velocity[0][a]) * per_time;
    const double y = (block.velocity[1][b] - block.velocity[1][a]) * per_time + options_.gravity;
    const double z = (block.velocity[2][b] - block.velocity[2][a]) * per_time;
    return x * x + y * y + z * z < limit * limit;
  }

  void separate() {
    for (std::size_t k = 0; k + 1 < arcs_.size(); ++k) {
      if (arcs_[k + 1].first >= arcs_[k].last) continue;
      const std::size_t middle = (arcs_[k + 1].first + arcs_[k].last) / 2;
      arcs_[k].last = arcs_[k + 1].first = middle;
    }
  }

  FlightOptions options_;
  std::vector<Arc> arcs_;
};

}  // namespace millscope::analyzers
