// Recordings as tracks.h5.
#include "kernel/output/tracks.hpp"

#include <catch2/catch.hpp>

#include "kernel/output/track_reader.hpp"
#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

TEST_CASE("a recording written as tracks reads back to the bit") {
  const Scratch scratch;
  scratch.file("a.txt", circle_rows(3000));
  scratch.file("b.txt", circle_rows(500));
  const recording::Recording recording =
      recording::read_recording(scratch.file("r.yaml", "files: [a.txt, b.txt]\ncondition: {tracer: {diameter: 10 mm, density: 2500}}\n"));
  recording::write_tracks(recording, scratch / "tracks.h5");
  CHECK_FALSE(std::filesystem::exists(scratch / "tracks.h5.tmp"));

  const millscope::output::TrackReader reader(scratch / "tracks.h5");
  REQUIRE(reader.tracks().size() == 2);
  CHECK(reader.tracks()[0].name == "a");
  CHECK(reader.tracks()[0].bead == 0);
  CHECK(reader.tracks()[0].diameter == 0.01);
  CHECK(reader.tracks()[0].source == "a.txt");

  const recording::Recording back = recording::read_recording(scratch / "tracks.h5");
  REQUIRE(back.runs.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(back.runs[k].time == recording.runs[k].time);
    CHECK(back.runs[k].position == recording.runs[k].position);
    CHECK(back.runs[k].name == recording.runs[k].name);
  }
  CHECK(*back.condition.tracer.diameter == 0.01);
  CHECK(*back.condition.tracer.density == 2500);
}

TEST_CASE("tracks replace an older file whole") {
  const Scratch scratch;
  const recording::Recording recording = recording::read_recording(scratch.file("a.txt", circle_rows(300)));
  scratch.file("tracks.h5", "something older");
  recording::write_tracks(recording, scratch / "tracks.h5");
  CHECK(recording::read_recording(scratch / "tracks.h5").runs[0].size() == 300);
  CHECK_THAT(refusal([&] { recording::write_tracks(recording, scratch / "absent" / "tracks.h5"); }), Contains("absent"));
}

TEST_CASE("beads of a simulation are read as runs, and a jump across a periodic boundary is kept") {
  const Scratch scratch;
  const std::vector<millscope::output::TrackInfo> infos{{"bead_7", 7, 0.005, 2500, "simulation"}};
  auto writer = millscope::output::TrackWriter::create(scratch / "tracks.h5", infos);
  for (int k = 0; k < 2000; ++k) {
    const double t = k / 2000.0, z = std::fmod(0.015 + 0.02 * t, 0.02);
    writer.append(t, std::vector<double>{0.1 * std::cos(6 * t), 0.1 * std::sin(6 * t), z});
  }
  writer.close();
  const recording::Recording recording = recording::read_recording(scratch / "tracks.h5");
  REQUIRE(recording.runs.size() == 1);
  CHECK(recording.runs[0].name == "bead_7");
  CHECK(recording.runs[0].size() == 2000);
  CHECK(recording.runs[0].report.outliers == 0);
  CHECK(*recording.condition.tracer.diameter == 0.005);
}
