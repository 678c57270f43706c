// Files into one tree: includes, overrides, paths.
#include "kernel/config/document.hpp"

#include <fmt/format.h>
#include <filesystem>

#include "kernel/base/text.hpp"
#include "kernel/config/node_data.hpp"

namespace millscope::config {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargestFile = 16U << 20U;  // bytes; a case is a few kB

bool same(const NodeData& a, const NodeData& b) {
  if (a.type != b.type || a.null != b.null || a.text != b.text) return false;
  if (a.entries.size() != b.entries.size() || a.items.size() != b.items.size()) return false;
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].key != b.entries[i].key || !same(*a.entries[i].value, *b.entries[i].value)) return false;
  }
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same(*a.items[i], *b.items[i])) return false;
  }
  return true;
}

/// Adds the maps of one included file to those of the files before it.
void merge_sibling(NodeData& base, const NodeData& over) {
  for (const NodeEntry& e : over.entries) {
    NodeEntry* mine = base.entry(e.key);
    if (mine == nullptr) {
      base.entries.push_back(e);
    } else if (mine->value->type == Node::Type::map && e.value->type == Node::Type::map) {
      merge_sibling(*mine->value, *e.value);
    } else if (!same(*mine->value, *e.value)) {
      throw UserError(e.value->where, fmt::format("key '{}' differs from the one at {}; two included files may not disagree; override it "
                                                  "in the including file or remove one",
                                                  e.written, mine->value->where.text()));
    }
  }
}

Tree load_level(const std::string& text, const std::string& file, Keys keys, std::vector<std::string>& open_files);

Tree load_included(const NodeData& item, const std::string& from, Keys keys, std::vector<std::string>& open_files) {
  if (item.type != Node::Type::scalar || item.null) throw UserError(item.where, "'include' wants a list of file names");
  const std::string file = (fs::path(from).parent_path() / item.text).lexically_normal().string();
  const std::string key = fs::absolute(file).lexically_normal().string();
  for (const std::string& open : open_files) {
    if (open == key) throw UserError(item.where, fmt::format("'{}' includes itself; remove the circle", item.text));
  }
  return load_level(read_text(file, &item.where), file, keys, open_files);
}

Tree load_level(const std::string& text, const std::string& file, Keys keys, std::vector<std::string>& open_files) {
  Tree own = parse_tree(text, file, keys);
  if (own->type != Node::Type::map) throw UserError(own->where, "the file is no map; write 'key: value' lines");
  const NodeEntry* include = own->entry("include");
  if (include == nullptr) return own;
  open_files.push_back(fs::absolute(file).lexically_normal().string());
  auto merged = std::make_shared<NodeData>();
  merged->type = Node::Type::map;
  merged->where = own->where;
  std::vector<Tree> items = include->value->items;
  if (include->value->type == Node::Type::scalar) items = {include->value};
  for (const Tree& item : items) merge_sibling(*merged, *load_included(*item, file, keys, open_files));
  open_files.pop_back();
  own->erase("include");
  overlay(*merged, *own);
  return merged;
}

Node finish_tree(const Tree& root, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) apply_override(*root, text);
  root->consumed = true;
  assign_paths(*root, "");
  return Node(root);
}

}  // namespace

std::string read_text(const std::string& file, const Location* named_at) {
  const std::string prefix = named_at != nullptr ? named_at->text() + ": " : "";
  std::error_code error;
  if (!fs::exists(file, error)) throw UserError(fmt::format("{}{}: no such file; check the path", prefix, file));
  if (fs::is_directory(file, error)) throw UserError(fmt::format("{}{}: is a directory; name a YAML file", prefix, file));
  if (fs::is_regular_file(file, error) && fs::file_size(file, error) > kLargestFile) {
    throw UserError(fmt::format("{}{}: is larger than 16 MB; this is no case file", prefix, file));
  }
  std::optional<std::string> text = base::text_if_readable(file);
  if (!text) throw UserError(fmt::format("{}{}: cannot be read; check its permissions", prefix, file));
  return std::move(*text);
}

void overlay(NodeData& base, const NodeData& over) {
  for (const NodeEntry& e : over.entries) {
    NodeEntry* mine = base.entry(e.key);
    if (e.value->null && mine != nullptr) {
      base.erase(e.key);
    } else if (mine == nullptr) {
      base.entries.push_back(e);
    } else if (mine->value->type == Node::Type::map && e.value->type == Node::Type::map) {
      mine->value->where = e.value->where;
      overlay(*mine->value, *e.value);
    } else {
      *mine = e;
    }
  }
}

void assign_paths(NodeData& node, const std::string& path) {
  node.path = path;
  const std::string prefix = path.empty() ? "" : path + ".";
  for (NodeEntry& e : node.entries) assign_paths(*e.value, prefix + e.key);
  for (std::size_t i = 0; i < node.items.size(); ++i) assign_paths(*node.items[i], prefix + std::to_string(i));
}

Tree load_tree(const std::string& text, const std::string& file, Keys keys) {
  std::vector<std::string> open_files;
  return load_level(text, file, keys, open_files);
}

Node load_document(const std::string& file, const std::vector<std::string>& overrides) {
  return finish_tree(load_tree(read_text(file, nullptr), file), overrides);
}

Node load_document_with_paths(const std::string& file, const std::vector<std::string>& overrides) {
  return finish_tree(load_tree(read_text(file, nullptr), file, Keys::paths), overrides);
}

Node parse_document(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  return finish_tree(load_tree(text, file), overrides);
}

}  // namespace millscope::config
