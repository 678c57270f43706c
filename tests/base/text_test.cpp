#include "kernel/base/text.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "kernel/base/error.hpp"
#include "scratch.hpp"

using namespace millscope;
using Catch::Contains;

TEST_CASE("a file is read whole, byte by byte") {
  const testing::Scratch folder;
  const std::string bytes{"a\r\n\0b\xff\n\n", 8};
  std::ofstream(folder / "file", std::ios::binary) << bytes;
  CHECK(base::text_of(folder / "file") == bytes);
  CHECK(base::text_if_readable(folder / "file") == bytes);
  std::ofstream(folder / "empty").close();
  CHECK(base::text_of(folder / "empty").empty());
}

TEST_CASE("what cannot be read is named, with the system's reason") {
  const testing::Scratch folder;
  CHECK_THROWS_AS(base::text_of(folder / "none"), base::UserError);
  CHECK_THROWS_WITH(base::text_of(folder / "none"), Contains("none: cannot be read (No such file or directory)"));
  CHECK_THROWS_WITH(base::text_of(folder.path), Contains(folder.path.string() + ": cannot be read (Is a directory)"));
  CHECK_FALSE(base::text_if_readable(folder / "none"));
  CHECK_FALSE(base::text_if_readable(folder.path));
}
