// `a~b: {like: c~d, times: {static_friction: 0.5}}`: what a pair does not say itself it has from another, some of it multiplied.
#include <fmt/format.h>

#include <algorithm>

#include "kernel/base/nearest.hpp"
#include "kernel/config/node_data.hpp"
#include "kernel/config/reader.hpp"

namespace millscope::config {
namespace {

/// A value of the other pair times a factor, in SI: its unit is held against what is wanted where the other pair is read.
Tree multiplied(const Node& pair, const Node& value, const Node& factor) {
  const Quantity q = read_quantity(value);
  auto leaf = std::make_shared<NodeData>(*value.data());
  leaf->text = number_text(read_number(factor, "1") * (q.has_unit ? q.unit.to_si(q.number) : q.number));
  leaf->where = factor.where();
  leaf->path = fmt::format("{}.{}", pair.path(), factor.name());
  leaf->consumed = false;
  return leaf;
}

class Completion {
 public:
  explicit Completion(Node section) : section_(std::move(section)) {}

  void complete(const Node& pair) {
    const bool alike = pair.data()->entry("like") != nullptr;
    if (!alike && pair.data()->entry("times") != nullptr)
      pair.at("times").fail("multiplies values of no other pair; add 'like', e.g. like: glass~liner");
    if (!alike || std::find(done_.begin(), done_.end(), pair.path()) != done_.end()) return;
    open_.push_back(pair.path());
    const Node original = original_of(pair.at("like"));
    complete(original);
    take(pair, original);
    open_.pop_back();
    done_.push_back(pair.path());
  }

 private:
  Node original_of(const Node& like) const {
    const std::string name = normal_pair(like.text());
    if (!section_.has(name))
      like.fail(fmt::format("names '{}', which 'pairs' does not have; {}", like.text(), base::suggestion(name, section_.keys())));
    Node original = section_.at(name);
    if (std::find(open_.begin(), open_.end(), original.path()) != open_.end())
      like.fail(fmt::format("names '{}', which is in the end like this pair; give one of them values of its own", name));
    return original;
  }

  /// `like` and `times` stay in the tree, read: a study may vary a factor.
  static void take(const Node& pair, const Node& original) {
    NodeData& data = *pair.data();
    const auto own = [&](const std::string& key) { return data.entry(key) != nullptr; };
    if (const auto times = pair.find("times")) {
      for (const std::string& key : times->keys()) {
        const Node factor = times->at(key);
        if (own(key)) factor.fail(fmt::format("multiplies a value that '{}' gives itself; keep one of the two", pair.path()));
        if (!original.has(key) || is_of_likeness(key))
          factor.fail(
              fmt::format("multiplies a value that '{}' does not give; {}", original.path(), base::suggestion(key, values_of(original))));
        data.entries.push_back({key, key, multiplied(pair, original.at(key), factor)});
      }
    }
    for (const NodeEntry& e : original.data()->entries) {
      if (!is_of_likeness(e.key) && !own(e.key)) data.entries.push_back(e);
    }
    std::erase_if(data.entries, [](const NodeEntry& e) { return e.value->null; });  // `key: ~`: not from the other
  }

  static bool is_of_likeness(const std::string& key) { return key == "like" || key == "times"; }

  static std::vector<std::string> values_of(const Node& pair) {
    std::vector<std::string> keys = pair.keys();
    std::erase_if(keys, is_of_likeness);
    return keys;
  }

  Node section_;
  std::vector<std::string> open_, done_;  ///< paths of pairs
};

}  // namespace

void complete_pairs(const Node& section) {
  Completion completion(section);
  for (const std::string& key : section.keys()) completion.complete(section.at(key));
}

}  // namespace millscope::config
