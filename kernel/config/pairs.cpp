#include "kernel/config/pairs.hpp"

#include <fmt/format.h>

namespace millscope::config {
namespace {

std::string pair_key(const std::string& first, const std::string& second) { return normal_pair(first + "~" + second); }

}  // namespace

PairTable::PairTable(Node section, std::map<std::string, std::string> group_of)
    : section_(std::move(section)), group_of_(std::move(group_of)) {}

std::vector<std::string> PairTable::keys() const { return section_.keys(); }

/// Keys that name the pair through `groups` (0, 1 or 2) groups.
std::vector<std::string> PairTable::candidates(const std::string& first, const std::string& second, int groups) const {
  if (groups == 0) return {pair_key(first, second)};
  const auto a = group_of_.find(first), b = group_of_.find(second);
  std::vector<std::string> result;
  if (groups == 1 && a != group_of_.end()) result.push_back(pair_key(a->second, second));
  if (groups == 1 && b != group_of_.end() && first != second) result.push_back(pair_key(first, b->second));
  if (groups == 2 && a != group_of_.end() && b != group_of_.end()) result.push_back(pair_key(a->second, b->second));
  return result;
}

Node PairTable::lookup(std::string_view first, std::string_view second) const {
  const std::string a(first), b(second);
  std::string tried;
  for (int groups = 0; groups <= 2; ++groups) {
    std::optional<Node> found;
    for (const std::string& key : candidates(a, b, groups)) {
      tried += fmt::format("'{}', ", key);
      if (!section_.has(key)) continue;
      if (found)
        section_.fail(
            fmt::format("has '{}' and '{}', which fit the pair {}~{} equally; add '{}'", found->name(), key, a, b, pair_key(a, b)));
      found = section_.find(key);
    }
    if (found) return *found;
  }
  if (std::optional<Node> fallback = section_.find("default")) return *fallback;
  section_.fail(fmt::format("says nothing of the pair {}~{}; add a key {}or 'default'", a, b, tried));
}

}  // namespace millscope::config
