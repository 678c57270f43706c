#include "kernel/output/tracks.hpp"

#include <catch2/catch.hpp>

#include "output/support.hpp"

using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

const std::vector<TrackInfo> kTracks{{"bead_3", 3, 0.01, 2500, "simulation"}, {"bead_9", 9, 0.01, 2500, "simulation"}};

void write(TrackWriter& writer, int from, int to) {
  for (int k = from; k < to; ++k) {
    const double t = k / 2000.0;
    writer.append(t, std::vector<double>{t, 2 * t, 3 * t, -t, -2 * t, -3 * t});
  }
}

}  // namespace

TEST_CASE("a resumed tracks file equals that of an uninterrupted run") {
  const Scratch scratch;
  TrackWriter whole = TrackWriter::create(scratch / "whole.h5", kTracks);
  write(whole, 0, 5000);
  whole.close();
  {
    TrackWriter first = TrackWriter::create(scratch / "tracks.h5", kTracks);
    write(first, 0, 3001);
    first.flush();
    write(first, 3001, 3500);
  }
  {
    TrackWriter second = TrackWriter::resume(scratch / "tracks.h5", kTracks, 3000 / 2000.0);
    write(second, 3001, 5000);
  }
  for (const char* name : {"bead_3/t", "bead_3/position", "bead_9/t", "bead_9/position"}) {
    INFO(name);
    CHECK(read_all(scratch / "tracks.h5", name) == read_all(scratch / "whole.h5", name));
  }
  CHECK(read_all(scratch / "tracks.h5", "bead_9/t").size() == 5000);
}

TEST_CASE("tracks of their own lengths, as recordings have") {
  const Scratch scratch;
  TrackWriter writer = TrackWriter::create(scratch / "r.h5", kTracks);
  for (int k = 0; k < 3000; ++k) writer.append_one(1, k, std::array<double, 3>{1, 2, 3});
  writer.append_one(0, 0.5, std::array<double, 3>{4, 5, 6});
  writer.close();
  CHECK(read_all(scratch / "r.h5", "bead_9/t").size() == 3000);
  CHECK(read_all(scratch / "r.h5", "bead_3/position") == std::vector<double>{4, 5, 6});
}

TEST_CASE("a tracks file refuses what does not belong to it") {
  const Scratch scratch;
  TrackWriter::create(scratch / "tracks.h5", kTracks).close();
  const std::vector<TrackInfo> other{{"bead_4", 4, 0.01, 2500, "simulation"}};
  CHECK_THAT(refusal([&] { TrackWriter::resume(scratch / "tracks.h5", other, 0); }), Contains("has no track 'bead_4'"));
  CHECK_THAT(refusal([&] { TrackWriter::create(scratch / "tracks.h5", kTracks); }), Contains("exists already"));
  const std::vector<TrackInfo> twice{kTracks[0], kTracks[0]};
  CHECK_THROWS_AS(TrackWriter::create(scratch / "t.h5", twice), std::logic_error);
}
