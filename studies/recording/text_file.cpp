#include "studies/recording/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "kernel/config/error.hpp"

namespace millscope::studies {
namespace {

using config::UserError;

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file) : value_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  operator int() const { return value_; }

 private:
  int value_;
};

std::string read_bytes(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  if (descriptor < 0) throw UserError(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(errno)));
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || S_ISDIR(status.st_mode)) {
    throw UserError(fmt::format("{}: is a folder; name a file of points or a recording.yaml", file.string()));
  }
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)), '\0');
  std::size_t filled = 0;
  for (;;) {  // a pipe says no size, a file may grow
    if (filled == bytes.size()) bytes.resize(bytes.size() + 65536);
    const ssize_t got = ::read(descriptor, bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw UserError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

/// Inflates all members of a gzip file (RFC 1952: members may follow one another).
std::string inflate_gzip(const std::string& packed, const std::filesystem::path& file) {
  constexpr int kGzipOnly = 15 + 16;  // largest window; 16: with a gzip head
  z_stream stream{};
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw std::bad_alloc();
  std::string text;
  std::size_t taken = 0;
  int state = Z_OK;
  const char* fault = nullptr;
  char block[1 << 16];
  while (fault == nullptr) {
    if (stream.avail_in == 0 && taken < packed.size()) {
      const std::size_t size = std::min<std::size_t>(packed.size() - taken, std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + taken));
      stream.avail_in = static_cast<uInt>(size);
      taken += size;
    }
    stream.next_out = reinterpret_cast<Bytef*>(block);
    stream.avail_out = sizeof block;
    state = inflate(&stream, Z_NO_FLUSH);
    text.append(block, sizeof block - stream.avail_out);
    const bool at_end = stream.avail_in == 0 && taken == packed.size();
    if (state == Z_STREAM_END) {
      if (at_end) break;
      inflateReset(&stream);
    } else if (state == Z_BUF_ERROR || (state == Z_OK && at_end && stream.avail_out > 0)) {
      fault = "is cut short";
    } else if (state != Z_OK) {
      fault = "is damaged";
    }
  }
  inflateEnd(&stream);
  if (fault != nullptr) throw UserError(fmt::format("{}: this gzip file {}; copy it again from where it was made", file.string(), fault));
  return text;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file) {
  std::string bytes = read_bytes(file);
  const bool gzip = bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
  return gzip ? inflate_gzip(bytes, file) : bytes;
}

}  // namespace millscope::studies
