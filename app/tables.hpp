// What every command takes, as data: read from the very tables that its --help is printed from, for completion and the manual.
#pragma once

#include <string>
#include <vector>

#include "app/commands.hpp"

namespace millscope::app {

struct OptionEntry {
  std::string name;    ///< long, without dashes
  std::string letter;  ///< of the short form, "" without one
  std::string value;   ///< what is shown for its value, e.g. "OUT"; "" for a flag
  std::string what;
  std::vector<std::string> choices;
};

struct PositionEntry {
  std::string name, what;
  std::vector<std::string> choices;
};

/// A command, or an action of one.
struct CommandTable {
  std::string name, what;  ///< as in the overview
  std::string usage, page, example;
  std::vector<OptionEntry> options;
  std::vector<PositionEntry> positions;
  bool last_takes_all = false;
  std::vector<CommandTable> actions;  ///< a command with actions has no options of its own
};

/// The table of a command, filled in by the command itself.
CommandTable table_of(const Command& command);
/// The tables of all commands that are for people.
std::vector<CommandTable> all_tables();

/// The table that a command called now shall fill in instead of doing its work; nullptr as a rule.
CommandTable* table_being_written();

}  // namespace millscope::app
