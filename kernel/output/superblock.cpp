#include "kernel/output/superblock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace millscope::output::hdf5 {

namespace {

// HDF5 file format specification 3.0, II.A.2: signature (8), version, size of offsets, size of lengths, status flags, four addresses
// of 8 bytes, checksum of the 44 bytes before it.
constexpr std::size_t kSize = 48;
constexpr std::size_t kVersion = 8, kOffsetSize = 9, kFlags = 11, kEnd = 28, kChecksum = 44;
constexpr std::array<unsigned char, 8> kSignature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
using Superblock = std::array<unsigned char, kSize>;

// Bob Jenkins' lookup3 (public domain) of the first 44 bytes, with initial value 0: what HDF5 checks its metadata with.
std::uint32_t lookup3(const Superblock& bytes) {
  std::array<std::uint32_t, kChecksum / 4> k;
  std::memcpy(k.data(), bytes.data(), kChecksum);
  std::uint32_t a = 0xdeadbeefU + static_cast<std::uint32_t>(kChecksum), b = a, c = a;
  const auto turn = [](std::uint32_t x, int by) { return std::rotl(x, by); };
  for (std::size_t at = 0; at < 9; at += 3) {
    a += k[at], b += k[at + 1], c += k[at + 2];
    a -= c, a ^= turn(c, 4), c += b;
    b -= a, b ^= turn(a, 6), a += c;
    c -= b, c ^= turn(b, 8), b += a;
    a -= c, a ^= turn(c, 16), c += b;
    b -= a, b ^= turn(a, 19), a += c;
    c -= b, c ^= turn(b, 4), b += a;
  }
  a += k[9], b += k[10];
  c ^= b, c -= turn(b, 14);
  a ^= c, a -= turn(c, 11);
  b ^= a, b -= turn(a, 25);
  c ^= b, c -= turn(b, 16);
  a ^= c, a -= turn(c, 4);
  b ^= a, b -= turn(a, 14);
  c ^= b, c -= turn(b, 24);
  return c;
}

// Rewrites the superblock with `change` applied, unless it is of a kind that knows no mark. False when it is damaged.
template <class Change>
bool rewrite(const std::filesystem::path& path, const Change& change) {
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  Superblock block;
  bool good = ::pread(descriptor, block.data(), kSize, 0) == static_cast<ssize_t>(kSize) &&
              std::memcmp(block.data(), kSignature.data(), kSignature.size()) == 0;
  if (good && block[kVersion] == 3 && block[kOffsetSize] == 8) {
    std::uint32_t stored = 0;
    std::memcpy(&stored, block.data() + kChecksum, 4);
    good = stored == lookup3(block);
    const Superblock before = block;
    if (good) change(block, descriptor);
    if (good && block != before) {
      stored = lookup3(block);
      std::memcpy(block.data() + kChecksum, &stored, 4);
      good = ::pwrite(descriptor, block.data(), kSize, 0) == static_cast<ssize_t>(kSize);
    }
  }
  ::close(descriptor);
  return good;
}

}  // namespace

bool clear_writer_mark(const std::filesystem::path& path) {
  return rewrite(path, [](Superblock& block, int) { block[kFlags] = 0; });
}

bool repair_superblock(const std::filesystem::path& path) {
  bool extended = true;
  const bool rewritten = rewrite(path, [&extended](Superblock& block, int descriptor) {
    block[kFlags] = 0;
    std::uint64_t end = 0;
    std::memcpy(&end, block.data() + kEnd, 8);
    const auto length = static_cast<std::uint64_t>(std::max<off_t>(0, ::lseek(descriptor, 0, SEEK_END)));
    if (length < end) extended = ::ftruncate(descriptor, static_cast<off_t>(end)) == 0;
    end = std::max(end, length);
    std::memcpy(block.data() + kEnd, &end, 8);
  });
  return rewritten && extended;
}

}  // namespace millscope::output::hdf5
