// Values per unordered pair of materials.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/config/document.hpp"

namespace millscope::config {

/// The section `pairs`. A key names two materials (`glass~hdpe`) or groups of materials (`glass~liner` with `groups: {liner: [hdpe,
/// nylon]}`); `default` holds for every pair that is not named.
class PairTable {
 public:
  PairTable() = default;
  /// `group_of`: the group of each grouped material.
  PairTable(Node section, std::map<std::string, std::string> group_of);

  /// The section of a pair: first the two materials, then one material and the other's group, then both groups, then `default`.
  /// Throws UserError naming the keys when there is none, or when two keys fit equally well.
  Node lookup(std::string_view first, std::string_view second) const;

  /// Keys as written (in normal order), `default` among them.
  std::vector<std::string> keys() const;
  const Node& section() const { return section_; }
  const std::map<std::string, std::string>& group_of() const { return group_of_; }

 private:
  std::vector<std::string> candidates(const std::string& first, const std::string& second, int groups) const;
  Node section_;
  std::map<std::string, std::string> group_of_;
};

}  // namespace millscope::config
