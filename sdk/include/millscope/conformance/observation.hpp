// What every observation must hold to.
#pragma once

#include <algorithm>

#include "millscope/conformance/values.hpp"
#include "millscope/element.hpp"
#include "millscope/observation.hpp"

namespace millscope::conformance {

/// A track, as the host hands it to an observation and takes it back.
struct TrackData {
  std::vector<double> time, position[3], weight;
  std::vector<std::uint32_t> visible;

  explicit TrackData(std::size_t n = 0) { resize(n); }
  void resize(std::size_t n) {
    time.resize(n);
    for (std::vector<double>& axis : position) axis.resize(n);
    weight.resize(n);
    visible.resize(n);
  }
  std::size_t count() const { return time.size(); }
  TrackView view() const {
    return {static_cast<std::int64_t>(time.size()),
            time.data(),
            {position[0].data(), position[1].data(), position[2].data()},
            weight.data(),
            visible.data()};
  }
  friend bool operator==(const TrackData& a, const TrackData& b) {
    return a.time == b.time && a.weight == b.weight && a.visible == b.visible && std::equal(a.position, a.position + 3, b.position);
  }
};

/// What the checks of an observation assume.
struct ObservationSetting {
  TrackContext context{42, 2.5e-3, 0.15, 0.0, 0.27, -6.0, 0.0};
  std::size_t sample_count = 2000;  ///< of the track, one each millisecond
  bool keeps_times = false;         ///< true: the same samples come back, at the same times, and none is seen that was not seen before
  bool defaults_do_nothing = true;  ///< the defaults of its list leave the track as it is; not asked where a value has no default
};

/// A bead that circles in the mill and wanders along its axis, out of sight now and then.
inline TrackData circling_track(const ObservationSetting& setting) {
  TrackData track(setting.sample_count);
  for (std::size_t i = 0; i < track.count(); ++i) {
    const double t = 1e-3 * static_cast<double>(i), r = 0.1 + 0.03 * std::sin(2.7 * t);
    track.time[i] = t;
    track.position[0][i] = r * std::cos(5.0 * t);
    track.position[1][i] = r * std::sin(5.0 * t);
    track.position[2][i] = 0.13 + 0.1 * std::sin(1.3 * t);
    track.weight[i] = 1.0;
    track.visible[i] = i % 97 < 90 ? 1 : 0;
  }
  return track;
}

namespace detail {

using Observation = Held<ObservationTable>;

struct Observed {
  TrackData track;
  Status status = 0;
  std::string reason;
};

/// `room`: false makes the sink say that it has no memory.
inline Observed observed(const Observation& observation, const TrackData& track, const TrackContext& context, bool room = true) {
  Observed found;
  struct Host {
    TrackData* track;
    bool room;
  } host{&found.track, room};
  const TrackSink sink{
      &host, [](void* self, std::int64_t count, TrackBuffer* out) -> Status {
        const Host& to = *static_cast<Host*>(self);
        if (!to.room || count < 0) return 1;
        TrackData& t = *to.track;
        t.resize(as_size(count));
        *out = {
            count, t.time.data(), {t.position[0].data(), t.position[1].data(), t.position[2].data()}, t.weight.data(), t.visible.data()};
        return 0;
      }};
  const TrackView view = track.view();
  Failure failure{};
  found.status = observation.table().observe(observation.get(), &view, &context, &sink, &failure);
  found.reason = failure.message;
  return found;
}

/// Times increase, all numbers are finite, the confidence lies in 0…1, the bead is seen or not.
inline bool is_a_track(const TrackData& track, Violations& out) {
  for (std::size_t i = 0; i < track.count(); ++i) {
    if (i > 0 && !(track.time[i] > track.time[i - 1]))
      return out.push_back({"order", text_of("the time goes from %g s to %g s", track.time[i - 1], track.time[i])}), false;
    const double sum = track.time[i] + track.position[0][i] + track.position[1][i] + track.position[2][i];
    if (!std::isfinite(sum))
      return out.push_back({"finite", text_of("sample %g (%g s) is not finite", static_cast<double>(i), track.time[i])}), false;
    if (!(track.weight[i] >= 0.0 && track.weight[i] <= 1.0))
      return out.push_back({"confidence", text_of("is %g at %g s", track.weight[i], track.time[i])}), false;
    if (track.visible[i] > 1)
      return out.push_back({"visible", text_of("is %g at %g s instead of 0 or 1", track.visible[i], track.time[i])}), false;
  }
  return true;
}

/// The same seed gives the same track, whatever was asked before; another seed may give another.
inline void seed_decides(const Observation& observation, const ObservationSetting& setting, const TrackData& track, Violations& out) {
  TrackContext other = setting.context;
  other.seed += 1;
  const TrackData first = observed(observation, track, setting.context).track;
  observed(observation, track, other);
  if (!(observed(observation, track, setting.context).track == first))
    out.push_back({"same seed, same track", "the second track of a seed differs from the first"});
}

inline void times_are_kept(const Observation& observation, const ObservationSetting& setting, const TrackData& track, Violations& out) {
  const TrackData found = observed(observation, track, setting.context).track;
  if (found.time != track.time)
    return out.push_back({"number and times", text_of("%g samples come back of %g, or at other times", static_cast<double>(found.count()),
                                                      static_cast<double>(track.count()))});
  for (std::size_t i = 0; i < track.count(); ++i) {
    if (found.visible[i] <= track.visible[i]) continue;
    return out.push_back({"sight", text_of("sample %g (%g s) is seen, though it was lost before", static_cast<double>(i), track.time[i])});
  }
}

/// Nothing, one sample, a mill of which nothing is known, a periodic one: a track or a refusal with its reason.
inline void odd_tracks(const Observation& observation, const ObservationSetting& setting, const TrackData& track, Violations& out) {
  TrackData one(1);
  one.weight[0] = 1.0, one.visible[0] = 1;
  TrackContext unknown{}, periodic = setting.context;
  unknown.seed = setting.context.seed;
  periodic.period = 0.02;
  const std::pair<const TrackData*, const TrackContext*> cases[] = {{&one, &setting.context}, {&track, &unknown}, {&track, &periodic}};
  for (const auto& [given, context] : cases) {
    const Observed found = observed(observation, *given, *context);
    if (found.status == 0) is_a_track(found.track, out);
    if (found.status != 0 && found.reason.empty()) out.push_back({"refusal", "a track was refused without a reason"});
  }
  const Observed empty = observed(observation, TrackData(), setting.context);
  if (empty.status == 0 && empty.track.count() > 0) out.push_back({"number and times", "samples are made of an empty track"});
}

inline void no_memory_is_said(const Observation& observation, const ObservationSetting& setting, const TrackData& track, Violations& out) {
  if (observed(observation, track, setting.context, false).status == 0)
    out.push_back({"no memory", "the sink has no room, but the call succeeds"});
}

/// With the defaults of its list the track stays as it is, so that a camera file may name an observation and leave it out.
inline void defaults_leave_the_track(const Descriptor& descriptor, const ObservationTable& table, const ObservationSetting& setting,
                                     const TrackData& track, Violations& out) {
  for (std::uint64_t i = 0; i < descriptor.parameter_count; ++i) {
    const Parameter& p = descriptor.parameters[i];
    if (p.optional == 0 && p.fallback_text == nullptr && std::isnan(p.fallback)) return;
  }
  const ValueSet defaults(descriptor);
  const Observation observation(table, defaults.view());
  if (!(observed(observation, track, setting.context).track == track))
    out.push_back({"identity", "the defaults of its list change the track"});
}

}  // namespace detail

/// Every check of an observation with these values. Throws Refusal when the plugin refuses the values.
inline Violations check_observation(const Descriptor& descriptor, const Values& values, const ObservationSetting& setting = {}) {
  Violations out;
  const auto& table = table_of<ObservationTable>(descriptor, Kind::observation, kObservationLayout);
  const detail::Observation observation(table, values);
  const TrackData track = circling_track(setting);
  const detail::Observed found = detail::observed(observation, track, setting.context);
  if (found.status != 0) return {{"observe", "a usual track is refused: " + found.reason}};
  detail::is_a_track(found.track, out);
  detail::seed_decides(observation, setting, track, out);
  if (setting.keeps_times) detail::times_are_kept(observation, setting, track, out);
  detail::odd_tracks(observation, setting, track, out);
  detail::no_memory_is_said(observation, setting, track, out);
  if (setting.defaults_do_nothing) detail::defaults_leave_the_track(descriptor, table, setting, track, out);
  with_ends_of_ranges(descriptor, table, values, out, [&](const detail::Observation& object) {
    const detail::Observed at_end = detail::observed(object, track, setting.context);
    if (at_end.status == 0) detail::is_a_track(at_end.track, out);
  });
  return out;
}

}  // namespace millscope::conformance
