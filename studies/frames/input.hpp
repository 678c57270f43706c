// A file, gzipped or not, read forward in lines, words or bytes, with its place for messages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace millscope::frames {

class Input {
 public:
  /// Throws base::UserError where it cannot be opened.
  explicit Input(std::filesystem::path file);
  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// The next line without its end; false behind the last. The view lives until the next call of anything here.
  bool line(std::string_view& text);
  /// The next word, whatever lines lie between; false at the end.
  bool word(std::string_view& text);
  /// The next word. `what` is expected there, for the message.
  std::string_view word(const char* what);
  /// The next word as a number. `what` is expected there, for the message.
  double number(const char* what);
  /// Exactly so many bytes. `what` they are, for the message where the file ends before.
  void bytes(void* to, std::size_t count, const char* what);
  void pass_over(std::size_t count, const char* what);
  /// What comes next, without taking it: up to `most` bytes, fewer only at the end.
  std::string_view look(std::size_t most);
  /// All that is left.
  std::string rest();

  const std::filesystem::path& file() const { return file_; }
  std::size_t line_number() const { return line_; }      ///< of the line that was read last, from 1
  std::uint64_t offset() const { return taken_ + at_; }  ///< of the next byte, unpacked
  /// "file:line: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// "file: byte 1234: what".
  [[noreturn]] void fail_here(const std::string& what) const;

 private:
  bool more();

  std::filesystem::path file_;
  gzFile_s* stream_ = nullptr;
  std::vector<char> buffer_;
  std::size_t at_ = 0, end_ = 0;  ///< of what is in the buffer and not taken yet
  std::uint64_t taken_ = 0;       ///< bytes before the buffer
  std::size_t line_ = 0;
  bool finished_ = false;
};

/// A finite or infinite number, or NaN; false where the text is none, or more than one. Blanks around it are allowed.
bool parse_number(std::string_view text, double& value);

}  // namespace millscope::frames
