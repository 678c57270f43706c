#include "kernel/base/hash.hpp"

#include <catch2/catch.hpp>
#include <string>

using millscope::base::Hash;

// Fowler, Noll & Vo's own test vectors (draft-eastlake-fnv, appendix C).
TEST_CASE("the hash is FNV-1a of 64 bits") {
  CHECK(Hash().text() == "cbf29ce484222325");
  CHECK(Hash().add("a").text() == "af63dc4c8601ec8c");
  CHECK(Hash().add("foobar").value() == 0x85944171f73967e8ULL);
  CHECK(Hash().add("foo").add("bar").value() == Hash().add("foobar").value());
}

TEST_CASE("a hash of few digits keeps its zeros") {
  // Found by search: the first of "0", "1", … whose hash begins with a zero.
  int number = 0;
  while (Hash().add(std::to_string(number)).value() >> 60 != 0) ++number;
  CHECK(Hash().add(std::to_string(number)).text().size() == 16);
}

TEST_CASE("a word changes the hash as one step, not as its eight bytes") {
  const std::uint64_t word = 0x0123456789abcdefULL;
  CHECK(Hash().add_word(word).value() == (0xcbf29ce484222325ULL ^ word) * 0x100000001b3ULL);
  CHECK(Hash().add_word(word).value() != Hash().add(&word, sizeof word).value());
}
