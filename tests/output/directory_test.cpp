#include "kernel/output/directory.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "kernel/output/archive.hpp"
#include "output/support.hpp"
#include "tests/skip.hpp"

using namespace millscope::output;
using namespace output_test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::string opens(const fs::path& path, Mode mode, std::uint64_t bytes = 0) {
  return refusal([&] { OutputDirectory directory(path, mode, bytes); });
}

}  // namespace

TEST_CASE("a run that does not start leaves no directory") {
  const Scratch scratch;
  { OutputDirectory directory(scratch / "a/b/c", Mode::fresh); }
  CHECK(fs::is_empty(scratch.path));
  {
    OutputDirectory directory(scratch / "a/b/c/", Mode::fresh);
    CHECK(fs::is_directory(scratch / "a/b/c"));
    directory.start();
  }
  CHECK(fs::is_empty(scratch / "a/b/c"));
  CHECK(opens(scratch / "a/b/c", Mode::fresh).empty());  // empty: still fresh, and it stays
  CHECK(fs::is_directory(scratch / "a/b/c"));
}

TEST_CASE("existing output is not overwritten") {
  const Scratch scratch;
  spill(scratch / "summary.json", "{}");
  CHECK_THAT(opens(scratch.path, Mode::fresh), Contains("not overwritten") && Contains("millscope resume") && Contains("--force"));
  spill(scratch / "file", "");
  CHECK_THAT(opens(scratch / "file", Mode::fresh), Contains("is a file"));
  CHECK_THAT(opens(scratch.path, Mode::overwrite), Contains("file is something else"));
  fs::remove(scratch / "file");
  spill(scratch / "frames.h5.tmp", "");
  {
    OutputDirectory directory(scratch.path, Mode::overwrite);
    CHECK(fs::exists(scratch / "summary.json"));  // until the run starts
    directory.start();
    CHECK_FALSE(fs::exists(scratch / "summary.json"));
    CHECK_FALSE(fs::exists(scratch / "frames.h5.tmp"));
    CHECK_FALSE(opens(scratch.path, Mode::overwrite).empty());  // still locked
  }
  CHECK(fs::is_empty(scratch.path));
}

TEST_CASE("what a killed run left half written goes when it is resumed, and nothing else") {
  const Scratch scratch;
  for (const char* name : {"checkpoint.h5", "summary.json.tmp", "frames.h5.2.tmp", "notes.tmp", "notes.txt"}) spill(scratch / name, "x");
  fs::create_directory(scratch / "vtk");
  spill(scratch / "vtk/beads_000001.vtp.tmp", "x");
  spill(scratch / "vtk/beads_000001.vtp", "x");
  OutputDirectory directory(scratch.path, Mode::resume);
  CHECK(fs::exists(scratch / "summary.json.tmp"));
  directory.start();
  for (const char* name : {"summary.json.tmp", "frames.h5.2.tmp", "vtk/beads_000001.vtp.tmp"}) CHECK_FALSE(fs::exists(scratch / name));
  for (const char* name : {"checkpoint.h5", "notes.tmp", "notes.txt", "vtk/beads_000001.vtp"}) CHECK(fs::exists(scratch / name));
}

TEST_CASE("resume needs a run") {
  const Scratch scratch;
  CHECK_THAT(opens(scratch / "none", Mode::resume), Contains("no such directory"));
  CHECK_THAT(opens(scratch.path, Mode::resume), Contains("no checkpoint"));
  ArchiveWriter(scratch / "checkpoint.h5").commit();
  CHECK(opens(scratch.path, Mode::resume).empty());
  CHECK(fs::exists(scratch / "checkpoint.h5"));
}

TEST_CASE("two runs do not share a directory") {
  const Scratch scratch;
  const OutputDirectory first(scratch / "out", Mode::fresh);
  CHECK_THAT(opens(scratch / "out", Mode::fresh), Contains("another run is writing there"));
  CHECK(fs::exists(scratch / "out"));
}

TEST_CASE("places where nothing can be written, and disks that are too small") {
  const Scratch scratch;
  CHECK_THAT(opens(scratch / "out", Mode::fresh, 1ULL << 60), Contains("the run will write about"));
  CHECK_FALSE(fs::exists(scratch / "out"));
  CHECK_THAT(opens("/proc/nothing/out", Mode::fresh), Contains("/proc/nothing: cannot be written"));
  spill(scratch / "file", "");
  CHECK_FALSE(opens(scratch / "file/out", Mode::fresh).empty());
}

TEST_CASE("a folder that its owner has closed") {
  const Scratch scratch;
  fs::create_directory(scratch / "closed");
  REQUIRE(::chmod((scratch / "closed").c_str(), 0500) == 0);
  const bool root = ::geteuid() == 0;  // who may write anywhere: so this is asked as nobody, who owns the folders
  constexpr uid_t kNobody = 65534;
  if (root) {
    for (const fs::path& path : {scratch.path, scratch / "closed"}) REQUIRE(::chown(path.c_str(), kNobody, 0) == 0);
    if (::seteuid(kNobody) != 0) return testing::skip("root cannot be somebody else here");
  }
  const std::string message = opens(scratch / "closed/out", Mode::fresh);
  if (root) REQUIRE(::seteuid(0) == 0);
  CHECK_THAT(message, Contains("closed") && Contains("cannot be written (Permission denied)"));
}
