// The inside of a Node; for the files of this room only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/config/document.hpp"

namespace millscope::config {

struct NodeEntry {
  std::string key;      ///< in normal order when it names a pair
  std::string written;  ///< as in the file
  std::shared_ptr<NodeData> value;
};

struct NodeData {
  Node::Type type = Node::Type::scalar;
  bool null = false;
  bool consumed = false;
  std::string text;
  std::vector<NodeEntry> entries;
  std::vector<std::shared_ptr<NodeData>> items;
  std::vector<std::string> asked;  ///< keys that a reader has asked for
  Location where;                  ///< of the key for a map's value, of the item in a list
  std::string path;

  NodeEntry* entry(std::string_view key);
  void erase(std::string_view key);
};

using Tree = std::shared_ptr<NodeData>;

/// How keys are written: `paths` lets `a.b` stand for a map within a map.
enum class Keys { plain, paths };

/// One file's text as a tree, without includes. Throws UserError.
Tree parse_tree(const std::string& text, const std::string& file, Keys keys = Keys::plain);
/// The value of an override: every node gets `where`.
Tree parse_value(const std::string& text, const Location& where);
/// Whether a key can be used in a path; throws UserError if not.
void check_key(const std::string& key, const Location& where);

/// Whole text of a file. Throws UserError, with `named_at` (may be null) as the place.
std::string read_text(const std::string& file, const Location* named_at);
/// Parses `text` with everything that it includes.
Tree load_tree(const std::string& text, const std::string& file, Keys keys = Keys::plain);
/// Lays `over` on `base`: its leaves win, null removes.
void overlay(NodeData& base, const NodeData& over);
void apply_override(NodeData& root, const std::string& text);
/// Fills `path` of every node.
void assign_paths(NodeData& node, const std::string& path);

}  // namespace millscope::config
