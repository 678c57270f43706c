// A YAML file as an own tree that remembers where everything was written and what has been read.
//
// Refused, each with file:line: duplicate keys (also `a~b` beside `b~a`), keys with a '.', tabs in the indentation, anchors, aliases,
// merge keys, tags, several documents in one file, `.nan` and `.inf`, numbers that look octal (`010`) or hexadecimal.
//
// `include: [other.yaml, …]` at the top of a file merges the maps of other files, paths relative to the including file:
//  - two included files may both define a leaf only with the same text;
//  - maps are merged key by key; anything else (a list is one value) is replaced by what the including file says;
//  - `key: ~` in the including file removes the inherited key.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/base/error.hpp"

namespace millscope::config {

using base::Location;
using base::UserError;

struct NodeData;

/// A handle on one value of the tree; copies share the value and the record of what was read.
class Node {
 public:
  enum class Type { map, sequence, scalar };

  Node() = default;  ///< empty handle: only `valid` may be asked
  explicit Node(std::shared_ptr<NodeData> data) : data_(std::move(data)) {}

  bool valid() const { return data_ != nullptr; }
  Type type() const;
  bool is_map() const { return type() == Type::map; }
  bool is_sequence() const { return type() == Type::sequence; }
  bool is_scalar() const { return type() == Type::scalar; }
  bool is_null() const;  ///< nothing after the colon, or `~`

  const Location& where() const;
  const std::string& path() const;  ///< "geometry.liner.kind"; "" for the root
  std::string name() const;         ///< last segment of `path`

  /// Text of a scalar as written, without quotes. Throws UserError for a map or a list.
  const std::string& text() const;

  /// Keys of a map in the order of the file. Throws UserError when this is no map.
  std::vector<std::string> keys() const;
  /// The value of a key, marked as read; nothing when absent. A key without a value is an error.
  std::optional<Node> find(std::string_view key) const;
  /// The value of a key, marked as read. Absent: UserError naming the key and `meaning`, e.g. "the end of the run, e.g. 4 s".
  Node at(std::string_view key, std::string_view meaning = "") const;
  /// Throws UserError unless every key is in `known`; says the nearest.
  void expect(std::initializer_list<std::string_view> known) const;
  /// Marks the key as known (for suggestions) without reading it; says whether it is present.
  bool has(std::string_view key) const;

  /// Items of a list. Throws UserError when this is no list.
  std::vector<Node> items() const;

  /// Throws UserError for the first key below this node that nobody has read, with the nearest key that somebody asked for.
  void finish() const;

  /// Throws UserError at this node's place: "file:line: 'name' " + message.
  [[noreturn]] void fail(const std::string& message) const;

  const std::shared_ptr<NodeData>& data() const { return data_; }

 private:
  std::shared_ptr<NodeData> data_;
};

/// Reads a file with its includes, then applies overrides "path.to.key=value" in order (the value is YAML; `~` removes the key; a list
/// item is named by its index). A path segment that is not there is created, unless a sibling has nearly the same name; whether a
/// created key means anything shows when the tree is read. Throws UserError.
Node load_document(const std::string& file, const std::vector<std::string>& overrides = {});

/// The same for a file whose keys may be paths: `mill.speed: 60 rpm` stands for `mill: {speed: 60 rpm}`.
Node load_document_with_paths(const std::string& file, const std::vector<std::string>& overrides = {});

/// The same from text; `file` is the name used in messages and for relative paths.
Node parse_document(const std::string& text, const std::string& file, const std::vector<std::string>& overrides = {});

/// YAML lines that a file which includes `base` has to say besides to read as `changed`. Leaves at the paths `named` are said where they
/// are as in the base, too.
std::string difference(const Node& base, const Node& changed, const std::vector<std::string>& named = {});

/// `liner~glass` → `glass~liner`: the one spelling of an unordered pair. Keys without '~' come back unchanged.
std::string normal_pair(std::string_view key);

/// The path of a file named in the tree, against the file where it was written (a --set: against the working directory), absolute.
std::string resolve_file(const Node& node);

}  // namespace millscope::config
