// A full disk: one line that says which file and what to do, and nothing of what was written before is lost.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "kernel/base/error.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/frames.hpp"
#include "kernel/output/series.hpp"
#include "kernel/output/tracks.hpp"
#include "output/support.hpp"
#include "tests/skip.hpp"

using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

constexpr std::size_t kDisk = 4 << 20;

void write_checkpoint(const std::filesystem::path& directory, std::size_t count) {
  ArchiveWriter writer(checkpoint_path(directory));
  for (int part = 0; part < 8; ++part) writer.write(fmt::format("x{}", part), std::vector<double>(count / 8, 1.5));
  writer.seal();
  rotate_checkpoints(directory);
  writer.commit();
}

// Files may not grow beyond `bytes` while it lives: the second way for a write to fail late, through HDF5.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a disk that fills up during a run") {
  const SmallDisk disk(kDisk);
  if (!disk.mounted) return testing::skip("no right to mount a small disk here: only the file size limit is tested");
  const auto& out = disk.scratch;
  write_checkpoint(out.path, 1000);

  SECTION("frames") {
    Story story(1000);
    std::string message;
    std::size_t count = 0;
    {
      FrameWriter writer = FrameWriter::create(out / "frames.h5", story.table());
      message = refusal([&] {
        for (int k = 0;; ++k) writer.append(story.frame(k));
      });
      count = writer.frame_count();
    }
    CHECK_THAT(message, Contains("frames.h5: the disk is full (") && Contains("free); the last checkpoint is intact") &&
                            Contains("millscope resume " + out.path.string()));
    CHECK(count > 50);
    CHECK(read_all(out / "frames.h5", "time").size() == count);
    CHECK(read_all(out / "frames.h5", "spin").size() >= 3000 * count);
    FrameWriter::resume(out / "frames.h5", 1000, 0.1).close();
  }
  SECTION("tracks") {
    const std::vector<TrackInfo> tracks{{"bead_0", 0, 0.01, 2500, "simulation"}};
    TrackWriter writer = TrackWriter::create(out / "tracks.h5", tracks);
    CHECK_THAT(refusal([&] {
                 for (int k = 0;; ++k) writer.append(k, std::vector<double>{1, 2, 3});
               }),
               Contains("tracks.h5: the disk is full"));
  }
  SECTION("series") {
    const std::vector<std::string> columns{"time_s"};
    SeriesWriter writer = SeriesWriter::create(out / "series.csv", columns);
    CHECK_THAT(refusal([&] {
                 for (int k = 0;; ++k) writer.append(std::vector<double>{1.0 / k});
               }),
               Contains("series.csv: the disk is full") && Contains("millscope resume"));
  }
  SECTION("checkpoint") {
    CHECK_THAT(refusal([&] { write_checkpoint(out.path, 1'000'000); }), Contains("checkpoint.h5.tmp: the disk is full"));
    CHECK_FALSE(std::filesystem::exists(out / "checkpoint.h5.tmp"));
    CHECK(ArchiveReader(newest_checkpoint(out.path)).read<double>("x0").size() == 125);
  }
  SECTION("a single file") {
    CHECK_THAT(refusal([&] {
                 AtomicFile file(out / "liner.stl");
                 for (int k = 0; k < 100; ++k) file.write(std::string(100000, 'x'));
                 file.commit();
               }),
               Contains("liner.stl.tmp: the disk is full"));
    CHECK_FALSE(std::filesystem::exists(out / "liner.stl.tmp"));
  }
}

TEST_CASE("a write that fails inside HDF5") {
  const Scratch out;
  write_checkpoint(out.path, 1000);
  SECTION("checkpoint") {
    std::string message;
    {
      const FileSizeLimit limit(1 << 20);
      message = refusal([&] { write_checkpoint(out.path, 1'000'000); });
    }
    CHECK_THAT(message, Contains("larger than this system allows") && Contains("the last checkpoint is intact"));
    CHECK_FALSE(std::filesystem::exists(out / "checkpoint.h5.tmp"));
    CHECK(ArchiveReader(newest_checkpoint(out.path)).read<double>("x0").size() == 125);
  }
  SECTION("frames") {
    Story story(1000);
    std::string message;
    std::size_t count = 0;
    {
      FrameWriter writer = FrameWriter::create(out / "frames.h5", story.table());
      const FileSizeLimit limit(1 << 20);
      message = refusal([&] {
        for (int k = 0;; ++k) writer.append(story.frame(k));
      });
      count = writer.frame_count();
    }
    CHECK_THAT(message, Contains("frames.h5: the file would be larger"));
    CHECK(count > 10);
    FrameWriter writer = FrameWriter::resume(out / "frames.h5", 1000, 0.005 * 10);
    for (int k = 11; k < 60; ++k) writer.append(story.frame(k));
    writer.close();
    const std::vector<double> spin = read_all(out / "frames.h5", "spin");
    REQUIRE(spin.size() == 60 * 3000);
    for (std::size_t at = 0; at < spin.size(); ++at) {
      REQUIRE(spin[at] == 2 * (static_cast<double>(at / 3000) + 0.25 * static_cast<double>(at % 3000)));
    }
  }
}

TEST_CASE("tracks of which a write has failed take no more") {
  const Scratch out;
  const std::vector<TrackInfo> tracks{{"bead_0", 0, 0.01, 2500, "simulation"}, {"bead_1", 1, 0.01, 2500, "simulation"}};
  std::string message;
  {
    TrackWriter writer = TrackWriter::create(out / "tracks.h5", tracks);
    {
      const FileSizeLimit limit(1 << 19);
      message = refusal([&] {
        for (int k = 0;; ++k) writer.append(k, std::vector<double>{1.0 * k, 0, 0, 2.0 * k, 0, 0});
      });
    }
    CHECK_THROWS_AS(writer.flush(), std::logic_error);
  }  // there would be room again
  CHECK_THAT(message, Contains("tracks.h5: the file would be larger"));
  for (const int bead : {0, 1}) {
    const std::string track = fmt::format("bead_{}/", bead);
    const std::vector<double> t = read_all(out / "tracks.h5", track + "t"), position = read_all(out / "tracks.h5", track + "position");
    CHECK(t.size() > 1000);
    REQUIRE(position.size() >= 3 * t.size());
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (k > 0 && t[k] == 0) break;  // HDF5 had no room for these times
      REQUIRE(t[k] == static_cast<double>(k));
      REQUIRE(position[3 * k] == (bead + 1) * t[k]);
    }
  }
}

TEST_CASE("other reasons why a file cannot be written") {
  CHECK_THAT(refusal([] { File("/dev/full", 1).write("x"); }), Contains("/dev/full: the disk is full") && Contains("start again"));
  CHECK_THAT(refusal([] { AtomicFile file("/nowhere/at/all.json"); }), Contains("cannot be written (No such file or directory)"));
  try {
    throw_write_error("/nowhere/x", EACCES);
  } catch (const millscope::base::UserError& e) {
    CHECK(e.exit_code() == kExitDisk);
    CHECK_THAT(e.what(), Contains("Permission denied") && Contains("-o"));
  }
}
