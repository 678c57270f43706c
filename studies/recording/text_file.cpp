#include "studies/recording/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <iconv.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>

#include "kernel/base/error.hpp"

namespace millscope::recording {
namespace {

using base::UserError;

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

/// Reads a whole file into `bytes`, which is not cleared before; returns its size.
std::size_t read_bytes(const std::filesystem::path& file, std::unique_ptr<char[]>& bytes) {
  const Descriptor descriptor(file);
  if (descriptor < 0) throw UserError(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(errno)));
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || S_ISDIR(status.st_mode)) {
    throw UserError(fmt::format("{}: is a folder; name a file of points or a recording.yaml", file.string()));
  }
  std::size_t room = static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)) + 1, filled = 0;
  bytes = std::make_unique_for_overwrite<char[]>(room);
  for (;;) {
    const ssize_t got = ::read(descriptor, bytes.get() + filled, room - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw UserError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    if (got == 0) return filled;
    filled += got;
    if (filled < room) continue;
    room = 2 * room + 65536;  // a pipe says no size, a file may grow
    auto larger = std::make_unique_for_overwrite<char[]>(room);
    std::memcpy(larger.get(), bytes.get(), filled);
    bytes = std::move(larger);
  }
}

/// Refuses what no recording unpacks to, before the memory is gone.
void check_unpacked(std::size_t unpacked, std::size_t packed, const std::filesystem::path& file) {
  constexpr std::size_t kMost = std::size_t{8} << 30U, kHarmless = 100'000'000, kRatio = 200;
  if (unpacked <= kHarmless || (unpacked <= kMost && unpacked / kRatio <= packed)) return;
  throw UserError(
      fmt::format("{}: this gzip file of {} bytes unpacks to more than {} bytes, which no recording does; check what it holds, or "
                  "unpack it and name the parts",
                  file.string(), packed, unpacked));
}

/// Inflates all members of a gzip file (RFC 1952: members may follow one another; zeros behind the last fill a block of a tape).
std::string inflate_gzip(std::string_view packed, const std::filesystem::path& file) {
  constexpr int kGzipOnly = 15 + 16;  // largest window; 16: with a gzip head
  z_stream stream{};
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw std::bad_alloc();
  std::string text;
  std::size_t taken = 0;
  int state = Z_OK;
  const char* fault = nullptr;
  char block[1 << 16];
  const auto end = [](z_stream* open) { inflateEnd(open); };
  const std::unique_ptr<z_stream, decltype(end)> guard(&stream, end);
  const auto only_zeros = [](std::string_view bytes) { return bytes.find_first_not_of('\0') == std::string_view::npos; };
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
    check_unpacked(text.size(), packed.size(), file);
    const bool at_end = stream.avail_in == 0 && taken == packed.size();
    if (state == Z_STREAM_END) {
      if (only_zeros(packed.substr(taken - stream.avail_in))) break;
      inflateReset(&stream);
    } else if (state == Z_BUF_ERROR || (state == Z_OK && at_end && stream.avail_out > 0)) {
      fault = "is cut short";
    } else if (state != Z_OK) {
      fault = "is damaged";
    }
  }
  if (fault != nullptr) throw UserError(fmt::format("{}: this gzip file {}; copy it again from where it was made", file.string(), fault));
  return text;
}

/// Which byte of a pair is the higher one of UTF-16; nothing: the text is of single bytes. Spreadsheets write a mark; without one the
/// digits of a table have a zero in every second byte.
std::optional<std::size_t> high_byte_of(std::string_view text) {
  if (text.size() < 4) return std::nullopt;
  if (text.starts_with("\xFF\xFE")) return 1;
  if (text.starts_with("\xFE\xFF")) return 0;
  constexpr std::size_t kLook = 64;
  for (const std::size_t high : {std::size_t{0}, std::size_t{1}}) {
    bool all = true;
    for (std::size_t i = 0; i + 1 < std::min(text.size(), kLook); i += 2) all = all && text[i + high] == '\0' && text[i + 1 - high] != '\0';
    if (all) return high;
  }
  return std::nullopt;
}

std::string utf8_of(std::string_view text, std::size_t high, const std::filesystem::path& file) {
  const iconv_t converter = iconv_open("UTF-8", high == 0 ? "UTF-16BE" : "UTF-16LE");
  std::string out(2 * text.size(), '\0');  // three bytes at most for two
  char *from = const_cast<char*>(text.data()), *to = out.data();
  std::size_t left = text.size() - text.size() % 2, room = out.size();
  const bool whole = iconv(converter, &from, &left, &to, &room) != static_cast<std::size_t>(-1);
  iconv_close(converter);
  if (!whole) throw UserError(fmt::format("{}: is no text of UTF-16, as its first bytes say; save it as plain text", file.string()));
  out.resize(out.size() - room);
  return out;
}

}  // namespace

TextFile::TextFile(const std::filesystem::path& file) {
  const std::size_t size = read_bytes(file, bytes_);
  text_ = {bytes_.get(), size};
  if (size > 2 && text_[0] == '\x1f' && text_[1] == '\x8b') {
    inflated_ = inflate_gzip(text_, file);
    text_ = inflated_;
    bytes_.reset();
  }
  if (const auto high = high_byte_of(text_)) {
    inflated_ = utf8_of(text_, *high, file);
    text_ = inflated_;
    bytes_.reset();
  }
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // the byte-order mark of UTF-8
}

}  // namespace millscope::recording
