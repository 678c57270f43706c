#include "studies/frames/input.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>

#include "kernel/base/error.hpp"

namespace millscope::frames {
namespace {

using base::UserError;
namespace fs = std::filesystem;

constexpr std::size_t kChunk = 1U << 20U;
constexpr std::size_t kLongestLine = std::size_t{1} << 30U;  // EDEM writes all beads of a quantity on one line
constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

Input::Input(fs::path file) : file_(std::move(file)) {
  std::error_code ignored;
  if (fs::is_directory(file_, ignored))
    throw UserError(fmt::format("{}: is a folder; name files, e.g. {}/*.vtk", file_.string(), file_.string()));
  // zlib reads what is not gzipped as it stands.
  stream_ = gzopen(file_.c_str(), "rb");
  if (stream_ == nullptr) throw UserError(fmt::format("{}: cannot be opened: {}", file_.string(), std::strerror(errno)));
  gzbuffer(stream_, 1U << 18U);
}

Input::~Input() { gzclose(stream_); }

bool Input::more() {
  if (finished_) return false;
  if (at_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + at_, end_ - at_);
    taken_ += at_, end_ -= at_, at_ = 0;
  }
  if (buffer_.size() < end_ + kChunk) buffer_.resize(std::max(2 * buffer_.size(), end_ + kChunk));
  const int got = gzread(stream_, buffer_.data() + end_, kChunk);
  int error = Z_OK;
  const char* text = gzerror(stream_, &error);
  if (got < 0 || error != Z_OK) {
    const std::string why = error == Z_BUF_ERROR ? "the gzip file is cut short"
                            : error == Z_ERRNO   ? std::strerror(errno)
                                                 : fmt::format("the gzip file is damaged ({})", text);
    fail_here(why + "; copy it again from where it was made");
  }
  finished_ = got == 0;
  end_ += static_cast<std::size_t>(got);
  return got > 0;
}

bool Input::line(std::string_view& text) {
  for (std::size_t looked = at_;;) {
    const void* found = std::memchr(buffer_.data() + looked, '\n', end_ - looked);
    if (found != nullptr) {
      const std::size_t stop = static_cast<std::size_t>(static_cast<const char*>(found) - buffer_.data());
      text = {buffer_.data() + at_, stop - at_};
      at_ = stop + 1;
      break;
    }
    const std::size_t pending = end_ - at_;
    if (pending > kLongestLine)
      fail_here("a line of more than 1 GiB: this is no text; give a file of one of the formats in docs/import.md");
    if (!more()) {
      if (pending == 0) return false;
      text = {buffer_.data() + at_, pending};
      at_ = end_;
      break;
    }
    looked = at_ + pending;
  }
  if (text.ends_with('\r')) text.remove_suffix(1);
  ++line_;
  return true;
}

bool Input::word(std::string_view& text) {
  for (;;) {
    while (at_ < end_ && kBlanks.find(buffer_[at_]) != std::string_view::npos) line_ += buffer_[at_++] == '\n' ? 1 : 0;
    if (at_ < end_) break;
    if (!more()) return false;
  }
  for (std::size_t looked = at_;;) {
    while (looked < end_ && kBlanks.find(buffer_[looked]) == std::string_view::npos) ++looked;
    const std::size_t length = looked - at_;
    if (looked < end_ || length > kChunk || !more()) {
      text = {buffer_.data() + at_, length};
      at_ += length;
      return true;
    }
    looked = at_ + length;
  }
}

std::string_view Input::word(const char* what) {
  std::string_view text;
  if (!word(text))
    fail(fmt::format("the file ends where {} is expected: it is cut short; copy it again, or let the program write it again", what));
  return text;
}

double Input::number(const char* what) {
  const std::string_view text = word(what);
  double value = 0;
  if (!parse_number(text, value))
    fail(fmt::format("'{}' stands where {} is expected; the file is damaged, or cut short", text.substr(0, 60), what));
  return value;
}

void Input::bytes(void* to, std::size_t count, const char* what) {
  char* out = static_cast<char*>(to);
  while (count > 0) {
    if (at_ == end_ && !more())
      fail_here(fmt::format(
          "the file ends {} bytes before the end of {}: it is cut short; copy it again, or let the program write it again", count, what));
    const std::size_t part = std::min(count, end_ - at_);
    if (out != nullptr) std::memcpy(out, buffer_.data() + at_, part), out += part;
    at_ += part, count -= part;
  }
}

void Input::pass_over(std::size_t count, const char* what) { bytes(nullptr, count, what); }

std::string_view Input::look(std::size_t most) {
  while (end_ - at_ < most && more()) {
  }
  return {buffer_.data() + at_, std::min(most, end_ - at_)};
}

std::string Input::rest() {
  std::string all;
  do {
    all.append(buffer_.data() + at_, end_ - at_);
    at_ = end_;
  } while (more());
  return all;
}

void Input::fail(const std::string& what) const {
  throw UserError(fmt::format("{}:{}: {}", file_.string(), std::max<std::size_t>(line_, 1), what));
}

void Input::fail_here(const std::string& what) const { throw UserError(fmt::format("{}: byte {}: {}", file_.string(), offset(), what)); }

bool parse_number(std::string_view text, double& value) {
  while (!text.empty() && kBlanks.find(text.front()) != std::string_view::npos) text.remove_prefix(1);
  while (!text.empty() && kBlanks.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range && end == text.data() + text.size()) {
    value = 0;  // 1e-400 is nothing; 1e400 no length
    const std::size_t exponent = text.find_first_of("eE");
    if (exponent == std::string_view::npos || text.substr(exponent + 1, 1) != "-") value = std::numeric_limits<double>::infinity();
    return true;
  }
  return error == std::errc() && end == text.data() + text.size() && !text.empty();
}

}  // namespace millscope::frames
