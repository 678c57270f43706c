#include "kernel/output/frames.hpp"
#include "kernel/base/text.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "output/support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

const std::vector<std::string> kAll{
    "time", "wall_angle", "angular_velocity", "wall_work",      "dissipation",  "position", "velocity",
    "spin", "beads/id",   "beads/mass",       "beads/material", "beads/radius", "impacts",  "impact_energy_edge"};

void write(FrameWriter& writer, Story& story, int from, int to) {
  for (int k = from; k < to; ++k) writer.append(story.frame(k));
}

}  // namespace

TEST_CASE("a resumed frames file equals that of an uninterrupted run") {
  const Scratch scratch;
  Story story(17);
  FrameWriter whole = FrameWriter::create(scratch / "whole.h5", story.table());
  write(whole, story, 0, 20);
  CHECK(whole.frame_count() == 20);
  whole.close();
  {
    FrameWriter first = FrameWriter::create(scratch / "frames.h5", story.table());
    write(first, story, 0, 14);
  }
  {
    FrameWriter second = FrameWriter::resume(scratch / "frames.h5", 17, story.frame(8).time);
    CHECK(second.frame_count() == 9);
    write(second, story, 9, 20);
  }
  FrameWriter::resume(scratch / "frames.h5", 17, 1e9).close();  // a finished run, to be continued
  for (const std::string& name : kAll) {
    INFO(name);
    CHECK(read_all(scratch / "frames.h5", name) == read_all(scratch / "whole.h5", name));
  }
  CHECK(read_all(scratch / "frames.h5", "position").size() == 20 * 17 * 3);
}

TEST_CASE("frames can be read while the run goes on") {
  const Scratch scratch;
  Story story(5, 0);
  FrameWriter writer = FrameWriter::create(scratch / "frames.h5", story.table());
  write(writer, story, 0, 1);
  CHECK(read_all(scratch / "frames.h5", "time") == std::vector<double>{0});
  write(writer, story, 1, 2);
  CHECK(writer.frame_count() == 2);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  write(writer, story, 2, 3);  // the second has waited for it
  CHECK(read_all(scratch / "frames.h5", "time") == std::vector<double>{0, 0.005, 0.01});
  CHECK(read_all(scratch / "frames.h5", "position").size() == 45);
}

TEST_CASE("frames wait for each other, a large one for none") {
  const Scratch scratch;
  const auto written = [&](const char* name) { return read_all(scratch / name, "time").size(); };
  Story small(5), large(8000);
  FrameWriter waits = FrameWriter::create(scratch / "waits.h5", small.table());
  write(waits, small, 0, 40);  // 170 KB, in far less than a quarter of a second
  CHECK(waits.frame_count() == 40);
  CHECK(written("waits.h5") < 40);
  write(waits, small, 40, 80);
  CHECK(written("waits.h5") > 40);
  waits.flush();
  CHECK(written("waits.h5") == 80);
  FrameWriter alone = FrameWriter::create(scratch / "alone.h5", large.table());
  write(alone, large, 0, 3);
  CHECK(written("alone.h5") == 3);
}

TEST_CASE("a frames file refuses what does not belong to it") {
  const Scratch scratch;
  Story story(5);
  const auto path = scratch / "frames.h5";
  CHECK_THAT(refusal([&] { FrameWriter::resume(path, 5, 0); }), Contains("is missing"));
  FrameWriter writer = FrameWriter::create(path, story.table());
  write(writer, story, 0, 3);
  CHECK_THROWS_AS(writer.append(story.frame(2)), std::logic_error);
  CHECK_THROWS_AS(writer.append(Story(4).frame(3)), std::logic_error);
  writer.close();
  CHECK_THAT(refusal([&] { FrameWriter::create(path, story.table()); }), Contains("exists already"));
  CHECK_THAT(refusal([&] { FrameWriter::resume(path, 6, 0); }), Contains("holds 5 beads"));
  spill(path, text_of(path).substr(0, 3000));
  CHECK_THAT(refusal([&] { FrameWriter::resume(path, 5, 0); }), Contains("frames.h5"));
  spill(path, "no HDF5");
  CHECK_THAT(refusal([&] { FrameWriter::resume(path, 5, 0); }), Contains("is damaged at its start"));
  CHECK_THAT(refusal([&] { FrameWriter::create(scratch / "missing/frames.h5", story.table()); }), Contains("cannot be written"));
}
