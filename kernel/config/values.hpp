// A plugin's parameters checked against its own list: type, unit, range, choice, presence.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/config/document.hpp"
#include "millscope/abi.hpp"

namespace millscope::config {

/// Values of one plugin object and the strings behind them; copies share both. The view lives as long as any copy.
class ResolvedValues {
 public:
  struct Storage;

  ResolvedValues();
  explicit ResolvedValues(std::shared_ptr<const Storage> storage) : storage_(std::move(storage)) {}

  Values view() const;
  /// Where a parameter was written, or the place of the whole section when it is a default.
  const Location& where(std::string_view name) const;

 private:
  std::shared_ptr<const Storage> storage_;
};

/// Resolves the parameters of `scope` from the keys of `node`, marking them as read. At scope `instance` any key left over is an error
/// (the reader has already taken `kind`, `material`, …); a pair's section is shared by several plugins, so there `Node::finish`
/// finds what is left. Throws UserError with file:line, the value, the reason and the parameter's own sentence.
ResolvedValues resolve(const Descriptor& descriptor, const Node& node, Scope scope);

/// Both scopes of one law on one pair in one list, as `create` of contact laws, interactions and pair parameters wants it.
ResolvedValues resolve_for_pair(const Descriptor& descriptor, const Node& instance, const Node& pair);

/// One value without a check that it is present: nothing written and no default gives `given` 0. For writers of resolved files.
ResolvedValues resolve_present(const Descriptor& descriptor, const Node& node, Scope scope);

/// The descriptor of that kind and name, or nullptr.
const Descriptor* find_descriptor(std::span<const Descriptor* const> descriptors, Kind kind, std::string_view name);

}  // namespace millscope::config
