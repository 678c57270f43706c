// `--set path.to.key=value`.
#include <fmt/format.h>
#include <charconv>

#include "kernel/base/nearest.hpp"
#include "kernel/config/node_data.hpp"

namespace millscope::config {
namespace {

std::vector<std::string> split_path(const std::string& path, const Location& where) {
  std::vector<std::string> segments;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t dot = path.find('.', begin);
    const std::string segment = path.substr(begin, dot == std::string::npos ? dot : dot - begin);
    if (segment.empty()) throw UserError(where, "the path has an empty segment; write path.to.key=value");
    segments.push_back(normal_pair(segment));
    if (dot == std::string::npos) return segments;
    begin = dot + 1;
  }
}

Tree& list_item(NodeData& list, const std::string& segment, const Location& where) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(segment.data(), segment.data() + segment.size(), index);
  if (error != std::errc() || end != segment.data() + segment.size() || index >= list.items.size()) {
    throw UserError(where, fmt::format("'{}' is no item of the list; its items are 0 to {}", segment, list.items.size() - 1));
  }
  return list.items[index];
}

/// The place of a segment below `parent`; an empty map is put there when it is new.
Tree& child(NodeData& parent, const std::string& segment, const Location& where) {
  if (parent.type == Node::Type::sequence && !parent.items.empty()) return list_item(parent, segment, where);
  if (parent.type != Node::Type::map) throw UserError(where, fmt::format("'{}' lies below a single value, which has no keys", segment));
  if (NodeEntry* found = parent.entry(segment)) return found->value;
  auto made = std::make_shared<NodeData>();
  made->type = Node::Type::map;
  made->where = where;
  parent.entries.push_back({segment, segment, made});
  return parent.entries.back().value;
}

/// A path that does not exist but nearly does is a slip of the pen. The last segment may be new: the reader checks it. So may the one
/// before in NAME.kind=NAME, which puts a plugin beside others: restitution_by_speed beside friction_by_speed.
void refuse_near_miss(const NodeData& root, const std::vector<std::string>& segments, const std::string& value, const Location& where) {
  const std::size_t last = segments.size() - 1;
  const std::size_t fresh = last > 0 && segments[last] == "kind" && segments[last - 1] == value ? 2 : 1;
  const NodeData* node = &root;
  for (std::size_t i = 0; i + fresh < segments.size() && node->type == Node::Type::map; ++i) {
    const NodeEntry* found = const_cast<NodeData*>(node)->entry(segments[i]);
    if (found == nullptr) {
      std::vector<std::string> keys;
      for (const NodeEntry& e : node->entries) keys.push_back(e.key);
      const std::string near = i == 0 ? "" : base::nearest(segments[i], keys);
      if (!near.empty()) throw UserError(where, fmt::format("unknown key '{}'; did you mean '{}'?", segments[i], near));
      return;
    }
    node = found->value.get();
  }
}

}  // namespace

void apply_override(NodeData& root, const std::string& text) {
  const Location where{"--set " + text, 0};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw UserError(where, "is no override; write path.to.key=value");
  const std::vector<std::string> segments = split_path(text.substr(0, equals), where);
  const std::string written = text.substr(equals + 1);
  refuse_near_miss(root, segments, written, where);
  Tree value = parse_value(written, where);
  NodeData* parent = &root;
  for (std::size_t i = 0; i + 1 < segments.size(); ++i) parent = child(*parent, segments[i], where).get();
  if (value->null && parent->type == Node::Type::map) {
    parent->erase(segments.back());
    return;
  }
  child(*parent, segments.back(), where) = value;
}

}  // namespace millscope::config
