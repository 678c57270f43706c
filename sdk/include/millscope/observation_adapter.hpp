// Turns a plain C++ class into an observation plugin.
//
//   struct MyNoise {
//     explicit MyNoise(const Parameters&);                                   // throws Refusal with the remedy
//     Track observe(const TrackView&, const TrackContext&) const;            // throws Refusal
//   };
//   constexpr Descriptor kDescriptor = describe<MyNoise>({.name = "my_noise", .doc = "…", .parameters = kParameters});
#pragma once

#include <vector>

#include "millscope/describe.hpp"
#include "millscope/observation.hpp"
#include "millscope/parameters.hpp"
#include "millscope/random.hpp"

namespace millscope {

/// One sample of a track.
struct TrackSample {
  double time;         ///< s
  double position[3];  ///< m
  double weight;       ///< confidence 0…1
  bool visible;
};

using Track = std::vector<TrackSample>;

/// Sample i of a view.
inline TrackSample sample_at(const TrackView& view, std::int64_t i) {
  return {view.time[i], {view.position[0][i], view.position[1][i], view.position[2][i]}, view.weight[i], view.visible[i] != 0};
}

namespace detail {

inline void write_track(const Track& track, const TrackSink& sink) {
  TrackBuffer out{};
  if (sink.resize(sink.host, static_cast<std::int64_t>(track.size()), &out) != 0) throw Refusal("no memory for the observed track");
  for (std::size_t i = 0; i < track.size(); ++i) {
    out.time[i] = track[i].time;
    for (int axis = 0; axis < 3; ++axis) out.position[axis][i] = track[i].position[axis];
    out.weight[i] = track[i].weight;
    out.visible[i] = track[i].visible ? 1 : 0;
  }
}

}  // namespace detail

template <class O>
constexpr ObservationTable make_observation_table() {
  ObservationTable t{};
  t.create = [](const Values* values, void** self, Failure* failure) -> Status {
    return guarded(failure, [&] { *self = new O(Parameters(*values)); });
  };
  t.destroy = [](void* self) { delete static_cast<O*>(self); };
  t.observe = [](const void* self, const TrackView* view, const TrackContext* context, const TrackSink* sink, Failure* failure) -> Status {
    return guarded(failure, [&] { detail::write_track(static_cast<const O*>(self)->observe(*view, *context), *sink); });
  };
  return t;
}

/// What tells an observation from the other kinds.
template <class C>
concept ObservationClass = requires(const C& camera, const TrackView& view, const TrackContext& context) {
  camera.observe(view, context);
};

template <ObservationClass C>
struct [[gnu::visibility("hidden")]] Adapter<C> {
  static constexpr Kind kind = Kind::observation;
  static constexpr std::uint64_t layout = kObservationLayout;
  static constexpr std::uint64_t features = 0;
  static constexpr ObservationTable table = make_observation_table<C>();
};

}  // namespace millscope
