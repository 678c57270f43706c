// One plugin library, opened and checked before any of its functions is called.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/host/instruction_set.hpp"
#include "millscope/abi.hpp"

namespace millscope::host {

/// A plugin library that passed every check. Descriptors, tables and strings live as long as it does.
class Library {
 public:
  /// Opens the file, checks its owner, list, descriptors and parameter lists. All or nothing: throws UserError that names the file,
  /// what differs and what to do.
  static std::shared_ptr<const Library> open(const std::string& path, const std::string& level);
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  const std::string& path() const;   ///< absolute, links resolved
  const std::string& level() const;  ///< "v2", "v3", "v4", or "" when it was built once for all machines
  const std::string& hash() const;   ///< FNV-1a of the file's bytes, 16 hexadecimal digits
  /// 16 hexadecimal digits over what can change a result: code and constants of all its builds, and the versions of the libraries it needs.
  const std::string& code_hash() const;
  const std::vector<const Descriptor*>& descriptors() const;

 private:
  struct State;
  explicit Library(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace millscope::host
