// What a file says besides the one that it includes.
#include <fmt/format.h>

#include <algorithm>

#include "kernel/config/node_data.hpp"
#include "kernel/config/writer.hpp"

namespace millscope::config {
namespace {

/// On one line; text that YAML could take for something else is quoted.
std::string flow(const NodeData& node) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.+-/^%~ ";
  if (node.null) return "~";
  if (node.type == Node::Type::scalar) {
    const std::string& t = node.text;
    const bool plain = t.find_first_not_of(kPlain) == std::string::npos && !t.empty() &&
                       (std::isalnum(static_cast<unsigned char>(t[0])) != 0 || (t[0] == '-' && t.size() > 1 && t[1] != ' ')) &&
                       t.back() != ' ';
    return plain ? t : quoted(t);
  }
  std::string list;
  for (const Tree& item : node.items) list += (list.empty() ? "" : ", ") + flow(*item);
  if (node.type == Node::Type::sequence) return "[" + list + "]";
  for (const NodeEntry& e : node.entries) list += fmt::format("{}{}: {}", list.empty() ? "" : ", ", e.key, flow(*e.value));
  return "{" + list + "}";
}

class Difference {
 public:
  explicit Difference(const std::vector<std::string>& named) : named_(named) {}

  /// Lines of a map; "" where it says nothing besides.
  std::string lines(NodeData& base, NodeData& changed, const std::string& path, std::size_t indent) const {
    std::string out;
    const std::string margin(indent, ' ');
    for (const NodeEntry& e : changed.entries) {
      const NodeEntry* before = base.entry(e.key);
      if (before != nullptr && maps(*before->value, *e.value)) {
        const std::string below = lines(*before->value, *e.value, path + e.key + ".", indent + 2);
        if (!below.empty()) out.append(margin).append(e.key).append(":\n").append(below);
      } else if (before == nullptr || flow(*before->value) != flow(*e.value) || named(path + e.key)) {
        out += value(e, indent);
      }
    }
    for (const NodeEntry& e : base.entries) {
      if (changed.entry(e.key) == nullptr) out += margin + e.key + ": ~\n";
    }
    return out;
  }

 private:
  static bool maps(const NodeData& a, const NodeData& b) { return a.type == Node::Type::map && b.type == Node::Type::map; }

  bool named(const std::string& path) const { return std::find(named_.begin(), named_.end(), path) != named_.end(); }

  static std::string value(const NodeEntry& e, std::size_t indent) {
    const std::string head = std::string(indent, ' ') + e.key + ":";
    if (e.value->type != Node::Type::map || e.value->entries.empty()) return head + " " + flow(*e.value) + "\n";
    std::string out = head + "\n";
    for (const NodeEntry& below : e.value->entries) out += value(below, indent + 2);
    return out;
  }

  const std::vector<std::string>& named_;
};

}  // namespace

std::string difference(const Node& base, const Node& changed, const std::vector<std::string>& named) {
  return Difference(named).lines(*base.data(), *changed.data(), "", 0);
}

}  // namespace millscope::config
