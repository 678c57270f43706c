// The plugins of a run: found, checked, and looked up by kind and name.
//
// Searched are the install's own directories (beside the executable's: ../lib/millscope/plugins and ../<libdir>/millscope/plugins) and
// those that the user names; never the working directory unless it is named. A directory or library that others can write is refused.
// In each directory the sub-folders v4, v3, v2 hold builds per instruction set; the best that the machine runs is taken.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/host/instruction_set.hpp"
#include "kernel/host/library.hpp"
#include "millscope/abi.hpp"

namespace millscope::host {

using base::Location;
using base::UserError;

/// "contact_law", "interaction", … as it is written in YAML and on the command line.
std::string text(Kind kind);
/// The reverse; nothing for a word that is no kind.
std::optional<Kind> parse_kind(std::string_view word);
/// All kinds, in the order of the enumeration.
const std::vector<Kind>& all_kinds();

/// One plugin and the library that keeps it alive. Cheap to copy.
struct Loaded {
  const Descriptor* descriptor = nullptr;
  std::shared_ptr<const Library> library;

  Kind kind() const { return static_cast<Kind>(descriptor->kind); }
  std::string_view name() const { return descriptor->name; }
  /// The kind's table; the kind has been checked by `Registry::find`.
  template <class Table>
  const Table& table() const {
    return *static_cast<const Table*>(descriptor->table);
  }
};

/// Where to look and what to take.
struct RegistryOptions {
  std::vector<std::string> directories;           ///< --plugin-dir, in order; each must exist and hold a plugin library
  bool own = true;                                ///< also the install's own
  std::optional<InstructionSet> instruction_set;  ///< force a level; default: see choose_instruction_set
};

/// What was loaded, for `millscope plugins` and the provenance of results.
struct PluginRecord {
  std::string kind, name, version, compiler;
  std::string path;
  std::string instruction_set;  ///< "x86-64-v3", or "any"
  std::string file_hash;        ///< FNV-1a of the library's bytes, hexadecimal
  std::string code_hash;        ///< Library::code_hash
};

class Registry {
 public:
  /// Loads everything at once. Throws UserError for the first directory or library that is refused.
  explicit Registry(const RegistryOptions& options = {});

  /// The plugin of that kind and name. Throws UserError at `where` with the nearest names and the directories searched.
  const Loaded& find(Kind kind, std::string_view name, const Location& where = {}) const;
  /// The same without an error: nullptr when absent.
  const Loaded* try_find(Kind kind, std::string_view name) const;
  /// Every plugin of that name, whatever its kind (`millscope describe NAME`). Throws UserError when there is none.
  std::vector<const Loaded*> find_any(std::string_view name) const;

  const std::vector<Loaded>& loaded() const { return loaded_; }           ///< ordered by kind, then name
  std::vector<const Descriptor*> descriptors() const;                     ///< same order; what config wants
  std::vector<PluginRecord> records() const;                              ///< same order
  const std::vector<std::string>& searched() const { return searched_; }  ///< directories, in the order of the search
  InstructionSet instruction_set() const { return level_; }

 private:
  void add_directory(const std::string& directory, bool named_by_user);
  void add_library(const std::shared_ptr<const Library>& library);

  InstructionSet level_;
  std::vector<Loaded> loaded_;
  std::vector<std::string> searched_;
};

/// The install's own plugin directories that exist.
std::vector<std::string> own_directories();

/// Descriptors for readers of cases, from a registry's plugins. Same as Registry::descriptors, for a subset.
std::vector<const Descriptor*> descriptors_of(const std::vector<Loaded>& plugins);

}  // namespace millscope::host
