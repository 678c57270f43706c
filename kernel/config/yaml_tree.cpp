// From yaml-cpp's events to the own tree. The library's own tree is not used: it lets duplicate keys pass and hides aliases.
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <fmt/format.h>
#include <cctype>
#include <sstream>

#include "kernel/base/text.hpp"
#include "kernel/config/node_data.hpp"

namespace millscope::config {
namespace {

bool digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// `.nan`, `-.INF`, `010`, `0x1f`: plain text that YAML readers take for odd numbers.
std::string odd_number(const std::string& text) {
  std::string_view rest = text;
  if (!rest.empty() && (rest[0] == '+' || rest[0] == '-')) rest.remove_prefix(1);
  const std::string low = base::lower(rest);
  if (low == ".nan" || low == ".inf") return "is not a finite number";
  if (low.size() > 2 && low[0] == '0' && (low[1] == 'x' || low[1] == 'o') && digit(low[2])) return "is not decimal; write it in decimal";
  if (low.size() < 2 || low[0] != '0' || !digit(low[1])) return "";
  const std::size_t end = low.find_first_not_of("0123456789.e+-");
  const bool whole_word = end == std::string::npos || low[end] == ' ';
  const bool one_point = low.find('.') == low.rfind('.');
  const bool dashed = low.substr(0, end).find('-') != std::string::npos && low.find('e') == std::string::npos;  // a date
  if (whole_word && one_point && !dashed)
    return "begins with 0 and might mean octal; write it without the leading 0, or in quotes if it is a text";
  return "";
}

class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string file, Keys keys = Keys::plain) : file_(std::move(file)), keys_(keys) {}
  Tree root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    if (expects_key()) throw UserError(place(mark), "a key is empty; write a name before the colon");
    Tree node = make(Node::Type::scalar, mark);
    node->null = true;
    attach(node);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw UserError(place(mark), "aliases (*name) are not supported; write the value out, or share a file with 'include:'");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (expects_key()) return take_key(mark, value);
    if (tag == "?") {
      const std::string odd = odd_number(value);
      if (!odd.empty()) throw UserError(place(mark), fmt::format("'{}' {}", value, odd));
    }
    Tree node = make(Node::Type::scalar, mark);
    node->text = value;
    attach(node);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(Node::Type::sequence, mark, tag, anchor);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open(Node::Type::map, mark, tag, anchor);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Level {
    Tree node;
    bool has_key = false;
    std::vector<std::string> path;  // one key, or with Keys::paths several
    std::string written;
    Location where;
  };

  Location place(const YAML::Mark& mark) const { return {file_, mark.line + 1}; }
  bool expects_key() const { return !open_.empty() && open_.back().node->type == Node::Type::map && !open_.back().has_key; }

  Tree make(Node::Type type, const YAML::Mark& mark) const {
    auto node = std::make_shared<NodeData>();
    node->type = type;
    node->where = place(mark);
    return node;
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) throw UserError(place(mark), "anchors (&name) are not supported; share a file with 'include:'");
  }
  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.size() > 1) throw UserError(place(mark), fmt::format("the tag '{}' is not supported; remove it", tag));
  }

  std::vector<std::string> split(const std::string& written, const Location& where) const {
    std::vector<std::string> path;
    std::size_t begin = 0;
    for (std::size_t dot = 0; dot != std::string::npos; begin = dot + 1) {
      dot = keys_ == Keys::paths ? written.find('.', begin) : std::string::npos;
      const std::string key = written.substr(begin, dot == std::string::npos ? dot : dot - begin);
      check_key(key, where);
      path.push_back(normal_pair(key));
    }
    return path;
  }

  void take_key(const YAML::Mark& mark, const std::string& written) {
    Level& level = open_.back();
    level.path = split(written, place(mark));
    level.written = written;
    level.where = place(mark);
    level.has_key = true;
    NodeData* parent = level.node.get();
    for (std::size_t i = 0; i < level.path.size(); ++i) {
      const NodeEntry* first = parent->entry(level.path[i]);
      if (first == nullptr) return;
      const bool on_the_way = i + 1 < level.path.size();
      if (!on_the_way || first->value->type != Node::Type::map) refuse_twice(level, *first, on_the_way);
      parent = first->value.get();
    }
  }

  static std::string last_of(const std::string& written) { return written.substr(written.rfind('.') + 1); }

  [[noreturn]] static void refuse_twice(const Level& level, const NodeEntry& first, bool on_the_way) {
    if (on_the_way) {
      throw UserError(level.where, fmt::format("'{}' lies below '{}', which is a single value at line {}; remove one", level.written,
                                               first.written, first.value->where.line));
    }
    const std::string spelling =
        first.written == last_of(level.written) ? "" : fmt::format(" as '{}' (the order of a pair does not matter)", first.written);
    throw UserError(level.where, fmt::format("key '{}' is given twice; first at line {}{}; remove one", level.written,
                                             first.value->where.line, spelling));
  }

  void attach(const Tree& node) {
    if (open_.empty()) {
      root = node;
      return;
    }
    Level& level = open_.back();
    if (level.node->type == Node::Type::sequence) {
      level.node->items.push_back(node);
      return;
    }
    node->where = level.where;
    NodeData* parent = level.node.get();
    for (std::size_t i = 0; i + 1 < level.path.size(); ++i) {
      if (parent->entry(level.path[i]) == nullptr) {
        auto map = std::make_shared<NodeData>();
        map->type = Node::Type::map;
        map->where = level.where;
        parent->entries.push_back({level.path[i], level.path[i], map});
      }
      parent = parent->entry(level.path[i])->value.get();
    }
    parent->entries.push_back({level.path.back(), last_of(level.written), node});
    level.has_key = false;
  }

  void open(Node::Type type, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (expects_key()) throw UserError(place(mark), "a key must be a name, not a list or a map");
    Tree node = make(type, mark);
    attach(node);
    open_.push_back({node, false, {}, {}, {}});
  }

  std::string file_;
  Keys keys_;
  std::vector<Level> open_;
};

void refuse_tabs(const std::string& text, const std::string& file) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t content = line.find_first_not_of(" \t\r");
    if (content == std::string::npos || line[content] == '#') continue;
    if (line.find('\t') < content) throw UserError({file, number}, "a tab in the indentation; YAML wants spaces");
  }
}

void place_everywhere(NodeData& node, const Location& where) {
  node.where = where;
  for (NodeEntry& e : node.entries) place_everywhere(*e.value, where);
  for (const Tree& item : node.items) place_everywhere(*item, where);
}

}  // namespace

Tree parse_tree(const std::string& text, const std::string& file, Keys keys) {
  refuse_tabs(text, file);
  Builder builder(file, keys);
  try {
    std::istringstream stream(text + "\n...\n");  // the end mark makes the library refuse a quote that is never closed
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    Builder second(file);
    if (parser.HandleNextDocument(second)) {
      throw UserError({file, second.root ? second.root->where.line : 1}, "a second document ('---') in the file; one file holds one case");
    }
  } catch (const YAML::Exception& e) {
    const bool open_quote = e.msg.find("document indicator") != std::string::npos;  // it met the end mark
    if (open_quote) throw UserError({file, e.mark.line + 1}, "a quoted text above is never closed; add the closing quote");
    throw UserError({file, e.mark.line + 1}, fmt::format("not valid YAML at column {}: {}", e.mark.column + 1, e.msg));
  }
  if (!builder.root || builder.root->null) {
    builder.root = std::make_shared<NodeData>();
    builder.root->type = Node::Type::map;
    builder.root->where = {file, 1};
  }
  return builder.root;
}

Tree parse_value(const std::string& text, const Location& where) {
  try {
    const Tree wrapped = parse_tree("value: " + text, where.file);
    if (wrapped->entries.size() != 1) throw UserError(where, "the value holds more than one line");
    Tree value = wrapped->entries[0].value;
    place_everywhere(*value, where);
    return value;
  } catch (const UserError& e) {
    const std::string what = e.what();
    const std::string prefix = Location{where.file, 1}.text();
    throw UserError(what.rfind(prefix, 0) == 0 ? where.text() + what.substr(prefix.size()) : what);
  }
}

void check_key(const std::string& key, const Location& where) {
  if (key.empty()) throw UserError(where, "a key is empty; write a name before the colon");
  if (key == "<<") throw UserError(where, "merge keys (<<) are not supported; share a file with 'include:'");
  if (key.find_first_of(".=") != std::string::npos) {
    throw UserError(where, fmt::format("key '{}' contains '.' or '=', which --set could not name; use '_'", key));
  }
}

}  // namespace millscope::config
