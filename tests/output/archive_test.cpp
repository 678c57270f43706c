#include "kernel/output/archive.hpp"
#include "kernel/base/text.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "output/support.hpp"

using millscope::base::text_of;
using namespace millscope::output;
using namespace output_test;
using Catch::Contains;

namespace {

void write_small(const std::filesystem::path& path, double value) {
  ArchiveWriter writer(path);
  writer.write("state/x", std::vector<double>(500, value));
  writer.write_text("case", "mill: {}\n");
  writer.commit();
}

}  // namespace

TEST_CASE("an archive gives back the same bits of every type") {
  const Scratch scratch;
  std::mt19937_64 random(7);
  std::vector<double> doubles(1000);
  for (double& value : doubles) {
    const std::uint64_t bits = random();  // any bits: NaNs with payloads, denormals, infinities
    std::memcpy(&value, &bits, sizeof value);
  }
  const std::vector<std::uint8_t> bytes{0, 255, 7};
  const std::vector<std::int32_t> ints{std::numeric_limits<std::int32_t>::min(), -1, 3};
  {
    ArchiveWriter writer(scratch / "a.h5");
    writer.write("deep/down/doubles", doubles);
    writer.write("bytes", bytes);
    writer.write("ints", ints);
    writer.write("empty", std::vector<std::uint32_t>{});
    writer.write_value<std::uint64_t>("steps", ~0ULL);
    writer.write_value<std::int64_t>("signed", -5);
    writer.write_text("text", std::string("line\nµ\0end", 11));
    writer.write_text("no text", "");
    writer.commit();
  }
  const ArchiveReader reader(scratch / "a.h5");
  const auto read = reader.read<double>("deep/down/doubles");
  REQUIRE(read.size() == doubles.size());
  CHECK(std::memcmp(read.data(), doubles.data(), 8 * read.size()) == 0);
  CHECK(reader.read<std::uint8_t>("bytes") == bytes);
  CHECK(reader.read<std::int32_t>("ints") == ints);
  CHECK(reader.read<std::uint32_t>("empty").empty());
  CHECK(reader.read_value<std::uint64_t>("steps") == ~0ULL);
  CHECK(reader.read_value<std::int64_t>("signed") == -5);
  CHECK(reader.read_text("text") == std::string("line\nµ\0end", 11));
  CHECK(reader.read_text("no text").empty());
  CHECK(reader.has("deep/down/doubles"));
  CHECK_FALSE(reader.has("deep/other/doubles"));
  CHECK_THAT(refusal([&] { reader.read<std::int32_t>("bytes"); }), Contains("of another kind"));
  CHECK_THAT(refusal([&] { reader.read<std::int32_t>("nothing"); }), Contains("holds no 'nothing'"));
  CHECK_FALSE(std::filesystem::exists(scratch / "a.h5.tmp"));
}

TEST_CASE("any damaged byte of an archive is found, and any cut") {
  const Scratch scratch;
  write_small(scratch / "checkpoint.h5", 1);
  const std::string whole = text_of(scratch / "checkpoint.h5");
  const auto opens = [&] { return refusal([&] { ArchiveReader reader(scratch / "checkpoint.h5"); }); };
  REQUIRE(opens().empty());
  int missed = 0;
  std::fstream file(scratch / "checkpoint.h5", std::ios::in | std::ios::out | std::ios::binary);
  const auto put = [&](std::size_t at, char byte) { file.seekp(static_cast<std::streamoff>(at)).put(byte).flush(); };
  for (std::size_t at = 0; at < whole.size(); ++at) {
    put(at, static_cast<char>(whole[at] ^ (1 << (at % 8))));
    missed += opens().empty() ? 1 : 0;
    put(at, whole[at]);
  }
  file.close();
  CHECK(missed == 0);
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
    spill(scratch / "checkpoint.h5", whole.substr(0, length));
    CHECK_THAT(opens(), Contains("is cut short"));
  }
  spill(scratch / "checkpoint.h5", whole + "x");
  CHECK_FALSE(opens().empty());
  CHECK_THAT(opens(), Contains("start the run again"));
  write_small(scratch / "checkpoint.previous.h5", 0);
  CHECK_THAT(opens(), Contains("use the previous checkpoint: 'mv "));
}

TEST_CASE("an archive without commit leaves what was there") {
  const Scratch scratch;
  const auto path = scratch / "checkpoint.h5";
  write_small(path, 1);
  const std::string before = text_of(path);
  {
    ArchiveWriter writer(path);
    writer.write("state/x", std::vector<double>(10, 2));
  }
  {
    ArchiveWriter writer(path);
    writer.write("state/x", std::vector<double>(10, 2));
    writer.seal();
  }
  CHECK(text_of(path) == before);
  CHECK_FALSE(std::filesystem::exists(path.string() + ".tmp"));
}

TEST_CASE("the last two checkpoints are kept") {
  const Scratch scratch;
  CHECK_THAT(refusal([&] { newest_checkpoint(scratch.path); }), Contains("no checkpoint"));
  for (const double value : {1.0, 2.0, 3.0}) {
    ArchiveWriter writer(checkpoint_path(scratch.path));
    writer.write_value("x", value);
    writer.seal();
    rotate_checkpoints(scratch.path);
    writer.commit();
  }
  CHECK(ArchiveReader(newest_checkpoint(scratch.path)).read_value<double>("x") == 3);
  CHECK(ArchiveReader(previous_checkpoint_path(scratch.path)).read_value<double>("x") == 2);
  rotate_checkpoints(scratch.path);
  rotate_checkpoints(scratch.path);
  CHECK(ArchiveReader(newest_checkpoint(scratch.path)).read_value<double>("x") == 3);
  std::filesystem::remove(checkpoint_path(scratch.path));
  CHECK(newest_checkpoint(scratch.path) == previous_checkpoint_path(scratch.path));
}
