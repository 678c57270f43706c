#include <catch2/catch.hpp>
#include <vector>

#include "millscope/conformance/values.hpp"
#include "millscope/millscope.hpp"

using namespace millscope;

namespace {

struct Slide {
  static constexpr int kHistory = 1;
  static constexpr PairParameterInfo kInfo = pair_parameter_info({{"seen", 1}});
  static constexpr std::uint64_t kGives = kGivesRestitution;
  Slide(const Parameters&, const PairContext&) {}
  template <class R>
  void values(const ParameterState<R>& p, R (&seen)[1], PairValues<R>& out) const {
    seen[0] = maximum(seen[0], -dot(p.velocity, p.normal));
    out.restitution = R(1.0) / (R(1.0) + seen[0]);
  }
};

struct Fall {
  explicit Fall(const Parameters&) {}
  bool uniform(double time, double (&a)[3]) const {
    a[0] = a[2] = 0;
    a[1] = -9.81 - time;
    return true;
  }
};

struct Halve {
  explicit Halve(const Parameters&) {}
  Track observe(const TrackView& view, const TrackContext& context) const {
    Random random(context.seed);
    Track track;
    for (std::int64_t i = 0; i < view.count; i += 2) {
      track.push_back(sample_at(view, i));
      track.back().position[0] += random.normal();
    }
    if (track.empty()) throw Refusal("the track is empty");
    return track;
  }
};

/// A track that a sink writes to.
struct Written {
  std::vector<double> columns[5];
  std::vector<std::uint32_t> visible;
  TrackSink sink() {
    return {this, [](void* host, std::int64_t count, TrackBuffer* out) -> Status {
              auto& self = *static_cast<Written*>(host);
              for (auto& c : self.columns) c.assign(static_cast<std::size_t>(count), 0.0);
              self.visible.assign(static_cast<std::size_t>(count), 0);
              *out = {count,
                      self.columns[0].data(),
                      {self.columns[1].data(), self.columns[2].data(), self.columns[3].data()},
                      self.columns[4].data(),
                      self.visible.data()};
              return 0;
            }};
  }
};

}  // namespace

TEST_CASE("a pair parameter fills its column and keeps its history") {
  constexpr PairParameterTable table = make_pair_parameter_table<Slide>();
  const conformance::Held<PairParameterTable> slide(table, {nullptr, 0}, conformance::bead_pair());
  std::vector<double> zero(kLanes, 0.0), one(kLanes, 1.0), down(kLanes, -3.0), history(kLanes, 0.0), restitution(kLanes, 0.0);
  PairParameterBatch b{};
  b.count = kLanes;
  b.overlap = b.radius = b.mass = one.data();
  for (int axis = 0; axis < 3; ++axis) b.normal[axis] = axis == 0 ? one.data() : zero.data();
  for (int axis = 0; axis < 3; ++axis) b.velocity[axis] = axis == 0 ? down.data() : zero.data();
  b.history[0] = history.data();
  b.restitution = restitution.data();
  table.evaluate(slide.get(), &b);
  for (int s = 0; s < kLanes; ++s) CHECK(restitution[s] == 0.25);
  CHECK(history[0] == 3.0);
}

TEST_CASE("a uniform body force says its acceleration") {
  constexpr BodyForceTable table = make_body_force_table<Fall>();
  const Values none{nullptr, 0};
  Failure failure{};
  void* self = nullptr;
  REQUIRE(table.create(&none, &self, &failure) == 0);
  double a[3];
  CHECK(table.uniform(self, 1.0, a) == 1);
  CHECK(a[1] == -10.81);
  table.destroy(self);
}

TEST_CASE("an observation makes the same track from the same seed, and refuses with its reason") {
  constexpr ObservationTable table = make_observation_table<Halve>();
  const Values none{nullptr, 0};
  Failure failure{};
  void* self = nullptr;
  REQUIRE(table.create(&none, &self, &failure) == 0);
  const std::vector<double> time = {0, 1, 2}, place = {5, 6, 7};
  const std::vector<std::uint32_t> visible = {1, 0, 1};
  TrackView view{3, time.data(), {place.data(), place.data(), place.data()}, time.data(), visible.data()};
  const TrackContext context{42, 0, 0, 0, 0, 0, 0};
  Written first, second;
  const TrackSink a = first.sink(), b = second.sink();
  CHECK(table.observe(self, &view, &context, &a, &failure) == 0);
  CHECK(table.observe(self, &view, &context, &b, &failure) == 0);
  CHECK(first.columns[0] == std::vector<double>{0, 2});
  CHECK(first.columns[1] == second.columns[1]);
  CHECK(first.columns[1][0] != 5.0);
  CHECK(first.columns[2] == std::vector<double>{5, 7});
  view.count = 0;
  CHECK(table.observe(self, &view, &context, &a, &failure) != 0);
  CHECK(std::string(failure.message) == "the track is empty");
  table.destroy(self);
}
