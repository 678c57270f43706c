// Files that are written aside: nothing of the user's is touched, no link followed.
#include "kernel/output/file.hpp"
#include "kernel/base/text.hpp"

#include <catch2/catch.hpp>

#include "support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
namespace fs = std::filesystem;

TEST_CASE("a file that is written aside spares what has the name of its temporary") {
  const Scratch scratch;
  spill(scratch / "y.stl.tmp", "my notes");
  spill(scratch / "secret", "another's");
  fs::create_symlink(scratch / "secret", scratch / "y.stl.1.tmp");
  {
    AtomicFile file(scratch / "y.stl");
    file.write("solid");
    CHECK(fs::exists(scratch / "y.stl.2.tmp"));
    AtomicFile second(scratch / "y.stl");  // two writers at once do not mix
    second.write("other");
    second.commit();
    CHECK(text_of(scratch / "y.stl") == "other");
    file.commit();
  }
  CHECK(text_of(scratch / "y.stl") == "solid");
  CHECK(text_of(scratch / "y.stl.tmp") == "my notes");
  CHECK(text_of(scratch / "secret") == "another's");
  CHECK(fs::is_symlink(scratch / "y.stl.1.tmp"));
  for (const char* name : {"y.stl.2.tmp", "y.stl.3.tmp"}) CHECK_FALSE(fs::exists(scratch / name));
  { AtomicFile given_up(scratch / "z"); }
  CHECK_FALSE(fs::exists(scratch / "z.tmp"));
}

TEST_CASE("a temporary is known by its name") {
  for (const char* name : {"a.h5.tmp", "a.h5.1.tmp", "a.h5.42.tmp"}) CHECK(is_temporary_of(name, "a.h5"));
  for (const char* name : {"a.h5", "a.h5tmp", "a.h5.x.tmp", "a.h5..tmp", "a.h51.tmp", "b.h5.tmp", ".tmp"})
    CHECK_FALSE(is_temporary_of(name, "a.h5"));
}
