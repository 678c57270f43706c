// Observation: what a camera does to the track of one bead (noise, irregular sampling, gaps, limited view).
//
// A chain of observations is applied in the order of the case, each to the result of the one before. Everything random comes from
// `TrackContext::seed`, so the same seed gives the same track.
#pragma once

#include "millscope/layout.hpp"

namespace millscope {

/// Samples of one bead in time order, in the frame of the mill (z is the axis).
struct TrackView {
  std::int64_t count;
  const double* time;            ///< s, increasing
  const double* position[3];     ///< m
  const double* weight;          ///< confidence 0…1; 1 for a simulated bead
  const std::uint32_t* visible;  ///< 1: the camera has it
};
template <>
struct Layout<TrackView> {
  using S = TrackView;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count), MILLSCOPE_MEMBER(S, time), MILLSCOPE_MEMBER(S, position),
                                       MILLSCOPE_MEMBER(S, weight), MILLSCOPE_MEMBER(S, visible)};
};

/// The same to be written.
struct TrackBuffer {
  std::int64_t count;
  double* time;
  double* position[3];
  double* weight;
  std::uint32_t* visible;
};
template <>
struct Layout<TrackBuffer> {
  using S = TrackBuffer;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, count), MILLSCOPE_MEMBER(S, time), MILLSCOPE_MEMBER(S, position),
                                       MILLSCOPE_MEMBER(S, weight), MILLSCOPE_MEMBER(S, visible)};
};

/// Receives the new track: the plugin asks once for room for `count` samples and fills the buffer.
struct TrackSink {
  void* host;
  Status (*resize)(void* host, std::int64_t count, TrackBuffer*);  ///< not 0: no memory
};
template <>
struct Layout<TrackSink> {
  using S = TrackSink;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, host), MILLSCOPE_MEMBER(S, resize)};
};

/// What a camera may know of the bead and the mill; 0 where unknown.
struct TrackContext {
  std::uint64_t seed;
  double bead_radius;          ///< m
  double mill_radius;          ///< of the bare shell, m
  double mill_low, mill_high;  ///< range along the axis, m
  double omega;                ///< mean Ω about z, rad/s
  double period;               ///< along z, m: the bead has an image in each; 0: the mill is not periodic
};
template <>
struct Layout<TrackContext> {
  using S = TrackContext;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, seed),     MILLSCOPE_MEMBER(S, bead_radius), MILLSCOPE_MEMBER(S, mill_radius),
                                       MILLSCOPE_MEMBER(S, mill_low), MILLSCOPE_MEMBER(S, mill_high),   MILLSCOPE_MEMBER(S, omega),
                                       MILLSCOPE_MEMBER(S, period)};
};

struct ObservationTable {
  Status (*create)(const Values*, void** self, Failure*);
  void (*destroy)(void* self);
  /// Called from many threads at once.
  Status (*observe)(const void* self, const TrackView*, const TrackContext*, const TrackSink*, Failure*);
};
template <>
struct Layout<ObservationTable> {
  using S = ObservationTable;
  static constexpr Member members[] = {MILLSCOPE_MEMBER(S, create), MILLSCOPE_MEMBER(S, destroy), MILLSCOPE_MEMBER(S, observe)};
};

inline constexpr std::uint64_t kObservationLayout =
    layout_hash(Kind::observation, {}, KindStructs<TrackView, TrackBuffer, TrackSink, TrackContext, ObservationTable>{});

}  // namespace millscope
