// The samples of a block by bead: each bead's unbroken stretches in time order, whether the block holds the whole charge or one tracer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "millscope/analyzer.hpp"
#include "millscope/element.hpp"

namespace millscope::analyzers {

/// One sample of a track.
struct TrackPoint {
  std::int64_t sample;  ///< index into the arrays per sample of the block
  double time;          ///< s
};

/// One bead over one unbroken stretch of the block.
struct Track {
  std::int64_t id = 0;
  std::vector<TrackPoint> points;
  std::size_t size() const { return points.size(); }
  double time(std::size_t i) const { return points[i].time; }
};

/// Calls visit(const Track&) for each bead with id % stride == 0 and each unbroken stretch. Frames of a track are in time order.
template <class Visit>
void for_each_track(const FrameBlock& block, std::int64_t stride, Visit&& visit) {
  const std::int64_t begin = block.first[0], end = block.first[block.frame_count];
  if (end <= begin) return;
  const auto [low, high] = std::minmax_element(block.id + begin, block.id + end);
  const std::int64_t lowest = *low;
  const auto beads = as_size(*high - lowest) + 1;

  // Counting sort by bead: where each bead's samples start, then its frames and samples in time order.
  std::vector<std::size_t> start(beads + 1, 0);
  for (std::int64_t s = begin; s < end; ++s) start[as_size(block.id[s] - lowest) + 1] += block.id[s] % stride == 0;
  for (std::size_t b = 0; b < beads; ++b) start[b + 1] += start[b];
  struct Place {
    std::int32_t frame;
    std::int32_t offset;  // of the sample in its frame
  };
  std::vector<Place> places(start[beads]);
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for (std::int64_t f = 0; f < block.frame_count; ++f) {
    for (std::int64_t s = block.first[f]; s < block.first[f + 1]; ++s) {
      if (block.id[s] % stride != 0) continue;
      places[element(next, block.id[s] - lowest)++] = {static_cast<std::int32_t>(f), static_cast<std::int32_t>(s - block.first[f])};
    }
  }

  Track track;
  for (std::size_t b = 0; b < beads; ++b) {
    track.id = lowest + static_cast<std::int64_t>(b);
    for (std::size_t i = start[b]; i < start[b + 1];) {
      track.points.clear();
      const std::int32_t piece = block.piece[places[i].frame];
      for (; i < start[b + 1] && block.piece[places[i].frame] == piece; ++i) {
        track.points.push_back({block.first[places[i].frame] + places[i].offset, block.time[places[i].frame]});
      }
      visit(static_cast<const Track&>(track));
    }
  }
}

/// Stride for for_each_track so that about `most` of the beads 0 … largest_id are looked at, evenly by id.
inline std::int64_t even_stride(std::int64_t largest_id, std::int64_t most) {
  return std::max<std::int64_t>(1, (largest_id + most) / most);
}

}  // namespace millscope::analyzers
