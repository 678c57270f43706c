// The suite of observations finds what is wrong with one.
#include "millscope/conformance/observation.hpp"

#include "millscope/observation_adapter.hpp"
#include "sdk/suite.hpp"

using namespace sdk_test;

namespace {

enum class Fault { none, clock, not_finite, confidence, seed, drops, sees_the_lost, empty, memory, identity };

constexpr Parameter kParameters[] = {number_parameter("size", "m", 0.0, 0.0, 0.1, "Of the noise.")};

/// White noise on x, wrong in one thing.
template <Fault fault>
struct Noise {
  explicit Noise(const Parameters& values) : size_(values.number("size")) {}

  Track observe(const TrackView& view, const TrackContext& context) const {
    Track track;
    Random random(fault == Fault::seed ? ++calls_ : context.seed);
    for (std::int64_t i = 0; i < view.count; ++i) {
      TrackSample sample = sample_at(view, i);
      sample.position[0] += size_ * random.normal();
      if (fault == Fault::identity) sample.position[1] += 1e-9;
      if (fault == Fault::clock) sample.time = std::floor(sample.time * 100.0);
      if (fault == Fault::not_finite) sample.position[2] /= context.mill_radius;
      if (fault == Fault::confidence) sample.weight = 1.5;
      if (fault == Fault::sees_the_lost) sample.visible = true;
      if (fault == Fault::drops && i % 10 == 0) continue;
      track.push_back(sample);
    }
    if (fault == Fault::empty && track.empty()) track.push_back({0.0, {0, 0, 0}, 1.0, true});
    return track;
  }

  double size_;
  mutable std::uint64_t calls_ = 0;
};

template <Fault fault>
Violations violations_of() {
  static constexpr Descriptor descriptor = describe<Noise<fault>>({.name = "noise", .parameters = kParameters});
  ValueSet values(descriptor);
  values.set("size", 1e-3);
  ObservationSetting setting;
  setting.keeps_times = true;
  return check_observation(descriptor, values.view(), setting);
}

/// The same by hand: does not ask whether there was room.
Violations violations_of_careless() {
  static constexpr ObservationTable table = [] {
    ObservationTable t = make_observation_table<Noise<Fault::none>>();
    t.observe = [](const void*, const TrackView*, const TrackContext*, const TrackSink* sink, Failure*) -> Status {
      TrackBuffer out{};
      sink->resize(sink->host, 0, &out);
      return 0;
    };
    return t;
  }();
  static constexpr Descriptor descriptor = [] {
    Descriptor d = describe<Noise<Fault::none>>({.name = "noise", .parameters = kParameters});
    d.table = &table;
    return d;
  }();
  const ValueSet values(descriptor);
  return check_observation(descriptor, values.view());
}

}  // namespace

TEST_CASE("a right observation passes the suite") {
  CHECK_FALSE(names(violations_of<Fault::none>(), ""));
  CHECK(violations_of<Fault::none>().empty());
}

TEST_CASE("the suite finds what is wrong with an observation") {
  CHECK(names(violations_of<Fault::clock>(), "order"));
  CHECK(names(violations_of<Fault::not_finite>(), "finite"));
  CHECK(names(violations_of<Fault::confidence>(), "confidence"));
  CHECK(names(violations_of<Fault::seed>(), "same seed, same track"));
  CHECK(names(violations_of<Fault::drops>(), "number and times"));
  CHECK(names(violations_of<Fault::sees_the_lost>(), "sight"));
  CHECK(names(violations_of<Fault::empty>(), "number and times"));
  CHECK(names(violations_of<Fault::identity>(), "identity"));
  CHECK(names(violations_of_careless(), "no memory"));
}
