#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "analysis/support.hpp"
#include "studies/analysis/frames_source.hpp"
#include "studies/analysis/open_source.hpp"
#include "studies/analysis/times.hpp"

using namespace analysis_test;
using namespace millscope;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

analysis::OpenedSource open(const fs::path& path, std::vector<std::string> tracers = {}, std::optional<double> from = {},
                            std::optional<double> to = {}) {
  analysis::SourceRequest request;
  request.path = path;
  request.tracers = std::move(tracers);
  request.from = from;
  request.to = to;
  return analysis::open_source(request, testing::registry());
}

/// Sums over all chunks of weight and of what changes from frame to frame.
struct Totals {
  double weight = 0, duration = 0, work = 0, elapsed = 0, largest_speed_error = 0, largest_place_error = 0;
};

Totals totals(const analysis::FrameSource& source, const Drum& drum, std::int64_t bead) {
  Totals t;
  const auto scratch = source.make_scratch();
  for (std::size_t c = 0; c < source.chunk_count(); ++c) {
    const FrameBlock& b = source.load(c, *scratch);
    t.duration += b.duration;
    for (std::int64_t f = 0; f < b.frame_count; ++f) {
      if (f > 0 && b.piece[f] == b.piece[f - 1]) {
        if (b.wall_work != nullptr) t.work += b.wall_work[f] - b.wall_work[f - 1];
        t.elapsed += b.time[f] - b.time[f - 1];
      }
      for (std::int64_t s = b.first[f]; s < b.first[f + 1]; ++s) {
        if (b.id[s] != bead) continue;
        t.weight += b.weight[s];
        const double a = drum.angle(static_cast<std::size_t>(bead), b.time[f]), r = drum.radius(static_cast<std::size_t>(bead));
        t.largest_place_error =
            std::max(t.largest_place_error, std::hypot(b.position[0][s] - r * std::cos(a), b.position[1][s] - r * std::sin(a)));
        t.largest_speed_error = std::max(t.largest_speed_error, std::hypot(b.velocity[0][s] + drum.omega * r * std::sin(a),
                                                                           b.velocity[1][s] - drum.omega * r * std::cos(a)));
      }
    }
  }
  return t;
}

}  // namespace

TEST_CASE("frames come with weights that fill the span and changes that add up, however they are cut") {
  const Scratch scratch;
  const Drum drum;
  drum.write(scratch.path);
  const analysis::OpenedSource opened = open(scratch.path);
  CHECK(opened.meta.source == "simulation");
  CHECK(opened.meta.name == "Drum");
  for (const std::size_t most : {1U, 7U, 128U}) {
    opened.source->cut(0, most);
    CHECK(opened.source->chunk_count() == most);
    const Totals t = totals(*opened.source, drum, 4);
    CHECK_THAT(t.weight, WithinRel(2.0, 1e-9));
    CHECK_THAT(t.duration, WithinRel(2.0, 1e-9));
    CHECK_THAT(t.elapsed, WithinRel(1.99, 1e-9));
    CHECK_THAT(t.work, WithinRel(0.3 * 1.99, 1e-9));
    CHECK(t.largest_place_error < 1e-7);
    CHECK(t.largest_speed_error < 1e-6);
  }
  const AnalyzerContext& c = opened.source->context();
  CHECK((c.has & (kHasAllBeads | kHasImpacts | kHasDissipation | kHasWallWork)) ==
        (kHasAllBeads | kHasImpacts | kHasDissipation | kHasWallWork));
  CHECK_THAT(c.mill_radius, WithinRel(0.1, 1e-12));
  CHECK_THAT(c.mill_high - c.mill_low, WithinRel(0.05, 1e-12));
  CHECK_THAT(c.omega, WithinRel(-2.0, 1e-12));
  CHECK_THAT(c.gravity, WithinRel(9.81, 1e-12));
  CHECK(c.charge_count == 6);
  CHECK_THAT(c.bead_density, WithinRel(2500.0, 1e-9));
  CHECK(c.is_periodic == 1);
  CHECK(c.is_recording == 0);
  CHECK(c.largest_id == 5);
  CHECK(c.impact_pair_count == 1);
}

TEST_CASE("the mean speed of the shell is that between the frames, also from a frame at the moment of the start") {
  const Scratch scratch;
  Drum drum;
  drum.start = 0;
  drum.at_rest_first = true;
  drum.write(scratch.path);
  CHECK_THAT(open(scratch / "frames.h5", {}, 0.0).source->context().omega, WithinRel(-2.0, 1e-12));
}

TEST_CASE("a part of the frames can be asked for, spins only where they are wanted") {
  const Scratch scratch;
  Drum().write(scratch.path);
  const analysis::OpenedSource opened = open(scratch.path, {}, 1.5, 2.0);
  CHECK_THAT(opened.source->context().start, WithinAbs(1.5, 1e-12));
  CHECK_THAT(opened.source->context().end, WithinAbs(2.0, 1e-12));
  CHECK(opened.source->survey()[0].size() == 51);
  opened.source->cut(0, 128);
  const auto block_scratch = opened.source->make_scratch();
  CHECK(opened.source->load(0, *block_scratch).spin[2][0] == -2);
  opened.source->want(kHasVelocity);
  CHECK((opened.source->context().has & kHasSpin) == 0);
  const auto fresh = opened.source->make_scratch();
  CHECK(opened.source->load(0, *fresh).spin[2] == nullptr);
}

TEST_CASE("followed beads have the speed of their motion, through the periodic border") {
  const Scratch scratch;
  const Drum drum;
  drum.write(scratch.path);
  const analysis::OpenedSource opened = open(scratch.path, {"3"});
  CHECK(opened.meta.source == "tracks");
  for (const std::size_t most : {1U, 9U}) {
    opened.source->cut(0, most);
    CHECK(opened.source->chunk_count() == most);
    const Totals t = totals(*opened.source, drum, 3);
    CHECK_THAT(t.weight, WithinRel(4.0, 1e-6));
    CHECK_THAT(t.elapsed, WithinRel(4.0, 1e-6));
    CHECK(t.largest_place_error < 1e-6);
    CHECK(t.largest_speed_error < 1e-3);
  }
  const auto block_scratch = opened.source->make_scratch();
  const FrameBlock& b = opened.source->load(4, *block_scratch);
  CHECK(b.position_variance == nullptr);  // exact
  CHECK_THAT(b.omega[0], WithinRel(-2.0, 1e-12));
  CHECK_THAT(b.phase[10] - b.phase[0], WithinRel(-2 * (b.time[10] - b.time[0]), 1e-9));
  for (std::int64_t f = 0; f < b.frame_count; ++f) {
    CHECK(b.position[2][f] >= 0);
    CHECK(b.position[2][f] < 0.05);
    CHECK_THAT(b.velocity[2][f], WithinAbs(0.02, 1e-3));
  }
  CHECK(open(scratch.path, {"all"}).source->survey().size() == 2);
  CHECK(open(scratch / "tracks.h5").source->survey().size() == 2);  // a file of a run stands for the run
  CHECK(open(scratch / "frames.h5").meta.source == "simulation");
  fs::remove(scratch / "frames.h5");
  const analysis::OpenedSource only_tracks = open(scratch.path);
  CHECK(only_tracks.meta.source == "tracks");
  CHECK_THAT(only_tracks.meta.notes.front(), Contains("no frames.h5"));
}

TEST_CASE("what cannot be analysed says why in one line") {
  const Scratch scratch;
  Drum().write(scratch.path);
  CHECK_THAT(refusal([&] { open(scratch / "nowhere"); }), Contains("there is no such file or directory"));
  CHECK_THAT(refusal([&] { open(scratch.path, {}, 3.0, 2.0); }), Contains("the span is empty"));
  CHECK_THAT(refusal([&] { open(scratch.path, {}, 10.0); }), Contains("its frames go from 1 s to 2.99 s"));
  CHECK_THAT(refusal([&] { open(scratch.path, {"1"}); }), Contains("follows no such bead; it has 0, 3"));
  CHECK_THAT(refusal([&] { open(scratch.path, {"x"}); }), Contains("follows no such bead"));
  CHECK_THAT(refusal([&] { open(scratch.path, {"0"}, 3.9999); }), Contains("at least 8 are needed"));
  fs::create_directory(scratch / "empty");
  CHECK_THAT(refusal([&] { open(scratch / "empty"); }), Contains("case.resolved.yaml"));
  fs::copy_file(scratch / "case.resolved.yaml", scratch / "empty" / "case.resolved.yaml");
  CHECK_THAT(refusal([&] { open(scratch / "empty"); }), Contains("neither frames.h5 nor tracks.h5"));
  spill(scratch / "bad.a", "no numbers\n");
  CHECK_THAT(refusal([&] { open(scratch / "bad.a"); }), Contains("bad.a"));
  CHECK_THAT(refusal([&] { open(scratch / "bad.a", {"1"}); }), Contains("is a recording"));
}
