// The error type of the whole kernel: what a user can put right.
#pragma once

#include <stdexcept>
#include <string>

namespace millscope::base {

/// Exit codes of the `millscope` command that a UserError may carry.
inline constexpr int kExitBadInput = 2;

/// Where something was written. `line` counts from 1; 0 means that `file` is no file but a text such as "--set time.end_s=4".
struct Location {
  std::string file;
  int line = 0;

  /// "file:line", or the text alone.
  std::string text() const;
};

/// An error that the user can put right. The message is one line: "file:line: what is wrong with the value; reason; remedy".
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message, int exit_code = kExitBadInput);
  UserError(const Location& where, const std::string& message, int exit_code = kExitBadInput);

  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

}  // namespace millscope::base
