#include <hdf5.h>

#include <catch2/catch.hpp>

#include "kernel/base/text.hpp"
#include "kernel/output/frame_reader.hpp"
#include "kernel/output/track_reader.hpp"
#include "output/support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

const std::vector<TrackInfo> kTracks{{"bead_10", 10, 0.01, 2500, "simulation"}, {"bead_9", 9, 0.008, 2600, "simulation"}};

}  // namespace

TEST_CASE("frames read back as they were written, while the run goes on") {
  const Scratch scratch;
  Story story(7);
  FrameWriter writer = FrameWriter::create(scratch / "frames.h5", story.table());
  for (int k = 0; k < 5; ++k) writer.append(story.frame(k));
  writer.flush();
  const FrameReader reader(scratch / "frames.h5");
  CHECK(reader.frame_count() == 5);
  CHECK(reader.beads().size() == 7);
  CHECK(reader.beads().material_names == std::vector<std::string>{"glass", "steel"});
  CHECK(reader.scalars().time == std::vector<double>{0, 0.005, 0.01, 0.015, 0.02});
  CHECK(reader.scalars().wall_names.size() == 2);
  CHECK(reader.scalars().wall_work.size() == 10);
  CHECK(reader.scalars().wall_work[9] == 0.1 * 4);
  CHECK(reader.scalars().dissipation_names == std::vector<std::string>{"glass~glass.normal"});
  CHECK(reader.scalars().impact_pairs == std::vector<std::string>{"glass~glass", "glass~liner"});
  CHECK(reader.scalars().impact_edges == std::vector<double>{1e-6, 1e-5, 1e-4, 1e-3});
  CHECK(reader.scalars().impacts.size() == 5 * 6);
  CHECK(reader.scalars().impacts[29] == 28);
  std::vector<float> position(2 * 21), velocity(2 * 21);
  reader.read(BeadField::position, 3, 2, position);
  reader.read(BeadField::velocity, 3, 2, velocity);
  CHECK(position[0] == 3.0F);
  CHECK(position[21 + 20] == 4.0F + 0.25F * 20.0F);
  CHECK(velocity[41] == -position[41]);
  CHECK_THROWS_AS(reader.read(BeadField::spin, 4, 2, position), std::logic_error);
}

TEST_CASE("frames are readable where a kill has left the mark of a writer") {
  const Scratch scratch;
  Story story(7);
  const auto path = scratch / "frames.h5";
  FrameWriter writer = FrameWriter::create(path, story.table());
  for (int k = 0; k < 3; ++k) writer.append(story.frame(k));
  writer.close();
  // What lies on the disk while another program has it open for writing.
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, list);
  REQUIRE(file >= 0);
  const std::string bytes = text_of(path);
  H5Fclose(file);
  H5Pclose(list);
  REQUIRE(bytes != text_of(path));
  spill(scratch / "killed.h5", bytes);
  CHECK(FrameReader(scratch / "killed.h5").frame_count() == 3);
}

TEST_CASE("a damaged head is refused at once") {
  const Scratch scratch;
  FrameWriter::create(scratch / "frames.h5", Story(7).table()).close();
  std::string bytes = text_of(scratch / "frames.h5");
  bytes.at(13) = static_cast<char>(bytes.at(13) + 1);
  spill(scratch / "damaged.h5", bytes);
  CHECK_THAT(refusal([&] { FrameReader reader(scratch / "damaged.h5"); }), Contains("damaged.h5"));
}

TEST_CASE("frames that cannot be read say why") {
  const Scratch scratch;
  const auto path = scratch / "frames.h5";
  CHECK_THAT(refusal([&] { FrameReader reader(path); }), Contains("there is no such file") && Contains("millscope run"));
  spill(path, "nothing of the kind");
  CHECK_THAT(refusal([&] { FrameReader reader(path); }), Contains("is no HDF5 file"));
  TrackWriter::create(scratch / "tracks.h5", kTracks).close();
  CHECK_THAT(refusal([&] { FrameReader reader(scratch / "tracks.h5"); }), Contains("'format' is 'millscope tracks'"));
}

TEST_CASE("tracks read back in the order of the beads") {
  const Scratch scratch;
  const auto path = scratch / "tracks.h5";
  TrackWriter writer = TrackWriter::create(path, kTracks);
  for (int k = 0; k < 1500; ++k) writer.append(k * 0.0005, std::vector<double>{1.0 * k, 2, 3, -1.0 * k, -2, -3});
  writer.close();
  const TrackReader reader(path);
  REQUIRE(reader.tracks().size() == 2);
  CHECK(reader.tracks()[0].name == "bead_9");
  CHECK(reader.tracks()[0].diameter == 0.008);
  CHECK(reader.tracks()[0].density == 2600);
  CHECK(reader.sample_count(1) == 1500);
  const TrackSamples samples = reader.read(0);
  REQUIRE(samples.size() == 1500);
  CHECK(samples.time[1499] == 1499 * 0.0005);
  CHECK(samples.position[0][1499] == -1499);
  CHECK(samples.position[2][7] == -3);
  CHECK(is_track_file(path));
}

TEST_CASE("tracks that cannot be read say why") {
  const Scratch scratch;
  CHECK_THAT(refusal([&] { TrackReader reader(scratch / "tracks.h5"); }), Contains("there is no such file"));
  TrackWriter::create(scratch / "empty.h5", {}).close();
  CHECK_THAT(refusal([&] { TrackReader reader(scratch / "empty.h5"); }), Contains("holds no track"));
  spill(scratch / "text.a", "0 1 2 3");
  CHECK_FALSE(is_track_file(scratch / "text.a"));
  CHECK_FALSE(is_track_file(scratch / "nowhere.a"));
}
