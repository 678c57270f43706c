// Commands that are several: `millscope NAME ACTION …`.
#pragma once

#include <fmt/core.h>

#include <span>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"

namespace millscope::app {

struct Action {
  const char* name;
  const char* what;
  int (*call)(const Arguments&);
};

struct ActionTable {
  const char* name;  ///< of the command
  const char* what;
  std::span<const Action> actions;
  const char* example;
};

inline void print_actions(const ActionTable& table) {
  fmt::print("usage: millscope {} ACTION …\n\n{}\n\n", table.name, table.what);
  for (const Action& a : table.actions) fmt::print("  {:<12} {}\n", a.name, a.what);
  fmt::print("\n'millscope {} ACTION --help' explains one, with an example.\n\nExample:\n  {}\n", table.name, table.example);
}

/// Calls the action that the first argument names; explains all without one and for --help. Throws UserError for a name of none.
inline int call_action(const ActionTable& table, const Arguments& arguments) {
  if (CommandTable* written = table_being_written()) {
    written->usage = fmt::format("{} ACTION …", table.name);
    written->page = table.what;
    written->example = table.example;
    for (const Action& a : table.actions) written->actions.push_back(table_of({a.name, a.what, a.call}));
    return kDone;
  }
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    print_actions(table);
    return arguments.empty() ? kBadInput : kDone;
  }
  std::vector<std::string> names;
  for (const Action& a : table.actions) {
    if (arguments[0] == a.name) return a.call(Arguments(arguments.begin() + 1, arguments.end()));
    names.emplace_back(a.name);
  }
  throw base::UserError(fmt::format("'{} {}' is no action; {}", table.name, arguments[0], base::suggestion(arguments[0], names)));
}

}  // namespace millscope::app
