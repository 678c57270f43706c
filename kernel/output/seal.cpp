#include "kernel/output/seal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernel/base/hash.hpp"
#include "kernel/output/file.hpp"

namespace millscope::output {

namespace {

struct Seal {
  std::array<char, 8> magic{'M', 'I', 'L', 'L', 'S', 'E', 'A', 'L'};
  std::uint64_t length = 0;    // bytes before the seal
  std::uint64_t checksum = 0;  // of those bytes
  std::uint64_t check = 0;     // of the three members above
};
static_assert(sizeof(Seal) == 32);

constexpr std::size_t kBlock = 1 << 20;

// FNV-1a over words of 8 bytes, the last one padded with zeros. Each step is a bijection of the word and of the sum so far, so a
// change within any one word always changes the result.
void add_words(base::Hash& sum, const char* bytes, std::size_t count) {
  for (std::size_t at = 0; at < count; at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min<std::size_t>(8, count - at));
    sum.add_word(word);
  }
}

std::uint64_t check_of(const Seal& seal) {
  base::Hash sum;
  add_words(sum, reinterpret_cast<const char*>(&seal), offsetof(Seal, check));
  return sum.value();
}

// Reads exactly `count` bytes; false at the end of the file or on an error.
bool read_all(int descriptor, char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t done = ::read(descriptor, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    count -= done;
  }
  return true;
}

bool checksum_of(int descriptor, std::uint64_t length, std::uint64_t& checksum) {
  std::vector<char> block(kBlock);
  base::Hash sum;
  for (std::uint64_t at = 0; at < length; at += kBlock) {
    const std::size_t count = std::min<std::uint64_t>(kBlock, length - at);
    if (!read_all(descriptor, block.data(), count)) return false;
    add_words(sum, block.data(), count);
  }
  checksum = sum.value();
  return true;
}

}  // namespace

void append_seal(const std::filesystem::path& path) {
  File file(path, O_RDWR);
  const off_t length = ::lseek(file.descriptor(), 0, SEEK_END);
  ::lseek(file.descriptor(), 0, SEEK_SET);
  Seal seal;
  seal.length = static_cast<std::uint64_t>(length);
  if (!checksum_of(file.descriptor(), seal.length, seal.checksum)) throw_write_error(path, EIO);
  seal.check = check_of(seal);
  file.write({reinterpret_cast<const char*>(&seal), sizeof seal});
  file.close();
}

std::string seal_fault(const std::filesystem::path& path) {
  if (::access(path.c_str(), R_OK) != 0) return std::string("cannot be read (") + std::strerror(errno) + ")";
  const File file(path, O_RDONLY);
  const off_t size = ::lseek(file.descriptor(), 0, SEEK_END);
  if (size < static_cast<off_t>(sizeof(Seal))) return "is cut short";
  Seal seal;
  ::lseek(file.descriptor(), size - static_cast<off_t>(sizeof seal), SEEK_SET);
  if (!read_all(file.descriptor(), reinterpret_cast<char*>(&seal), sizeof seal)) return "cannot be read to its end";
  if (seal.magic != Seal{}.magic || seal.check != check_of(seal)) return "is cut short or no archive (its end seal is missing)";
  if (seal.length + sizeof seal != static_cast<std::uint64_t>(size)) return "is cut short";
  std::uint64_t sum = 0;
  ::lseek(file.descriptor(), 0, SEEK_SET);
  if (!checksum_of(file.descriptor(), seal.length, sum)) return "cannot be read to its end";
  return sum == seal.checksum ? "" : "is damaged (its checksum differs)";
}

}  // namespace millscope::output
