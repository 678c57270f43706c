// Reading the tree and remembering what was read.
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

#include "kernel/base/nearest.hpp"
#include "kernel/config/node_data.hpp"

namespace millscope::config {
namespace {

const char* type_name(Node::Type type) {
  if (type == Node::Type::map) return "a map";
  return type == Node::Type::sequence ? "a list" : "a single value";
}

std::vector<std::string> entry_keys(const NodeData& data) {
  std::vector<std::string> keys;
  for (const NodeEntry& e : data.entries) keys.push_back(e.key);
  return keys;
}

void remember(NodeData& data, std::string_view key) {
  if (std::find(data.asked.begin(), data.asked.end(), key) == data.asked.end()) data.asked.emplace_back(key);
}

std::string inside(const NodeData& data) { return data.path.empty() ? "" : fmt::format(" in '{}'", data.path); }

[[noreturn]] void refuse_unknown(const NodeData& map, const NodeEntry& entry) {
  throw UserError(entry.value->where,
                  fmt::format("unknown key '{}'{}; {}", entry.written, inside(map), base::suggestion(entry.key, map.asked)));
}

void finish_below(const NodeData& data) {
  for (const NodeEntry& e : data.entries) {
    if (!e.value->consumed) refuse_unknown(data, e);
    finish_below(*e.value);
  }
  for (const Tree& item : data.items) finish_below(*item);
}

}  // namespace

NodeEntry* NodeData::entry(std::string_view key) {
  const auto found = std::find_if(entries.begin(), entries.end(), [key](const NodeEntry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

void NodeData::erase(std::string_view key) {
  std::erase_if(entries, [key](const NodeEntry& e) { return e.key == key; });
}

Node::Type Node::type() const { return data_->type; }
bool Node::is_null() const { return data_->null; }
const Location& Node::where() const { return data_->where; }
const std::string& Node::path() const { return data_->path; }

std::string Node::name() const {
  const std::size_t dot = data_->path.rfind('.');
  return dot == std::string::npos ? data_->path : data_->path.substr(dot + 1);
}

const std::string& Node::text() const {
  if (!is_scalar()) fail(fmt::format("is {}; a single value is expected", type_name(type())));
  if (is_null()) fail("has no value; write one or remove the key");
  return data_->text;
}

std::vector<std::string> Node::keys() const {
  if (!is_map()) fail(fmt::format("is {}; a map (indented 'key: value' lines) is expected", is_null() ? "empty" : type_name(type())));
  return entry_keys(*data_);
}

std::optional<Node> Node::find(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  Tree& value = data_->entry(key)->value;
  value->consumed = true;
  if (value->null) Node(value).fail("has no value; write one or remove the key");
  return Node(value);
}

Node Node::at(std::string_view key, std::string_view meaning) const {
  if (std::optional<Node> found = find(key)) return *found;
  std::vector<std::string> unread;
  for (const NodeEntry& e : data_->entries) {
    if (!e.value->consumed) unread.push_back(e.key);
  }
  std::string message = fmt::format("missing key '{}'{}", key, inside(*data_));
  if (!meaning.empty()) message += fmt::format("; expected: {}", meaning);
  const std::string near = base::nearest(key, unread);
  if (!near.empty()) message += fmt::format("; is '{}' meant for it?", near);
  throw UserError(where(), message);
}

void Node::expect(std::initializer_list<std::string_view> known) const {
  keys();
  for (const std::string_view key : known) remember(*data_, key);
  for (const NodeEntry& e : data_->entries) {
    if (std::find(data_->asked.begin(), data_->asked.end(), e.key) == data_->asked.end()) refuse_unknown(*data_, e);
  }
}

bool Node::has(std::string_view key) const {
  keys();
  remember(*data_, key);
  return data_->entry(key) != nullptr;
}

std::vector<Node> Node::items() const {
  if (!is_sequence()) fail(fmt::format("is {}; a list [a, b, …] is expected", is_null() ? "empty" : type_name(type())));
  std::vector<Node> result;
  for (const Tree& item : data_->items) result.emplace_back(item);
  return result;
}

void Node::finish() const { finish_below(*data_); }

void Node::fail(const std::string& message) const {
  throw UserError(where(), path().empty() ? message : fmt::format("'{}' {}", path(), message));
}

std::string resolve_file(const Node& node) {
  namespace fs = std::filesystem;
  const fs::path written = node.text();
  const fs::path base = node.where().line > 0 ? fs::path(node.where().file).parent_path() : fs::path();
  return fs::absolute(base / written).lexically_normal().string();
}

}  // namespace millscope::config
