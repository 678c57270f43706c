#include "app/tables.hpp"

namespace millscope::app {
namespace {

CommandTable* being_written = nullptr;

/// Commands called during its life fill in the table.
class Writing {
 public:
  explicit Writing(CommandTable& table) : before_(being_written) { being_written = &table; }
  ~Writing() { being_written = before_; }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;

 private:
  CommandTable* before_;
};

}  // namespace

CommandTable* table_being_written() { return being_written; }

CommandTable table_of(const Command& command) {
  CommandTable table;
  table.name = command.name;
  table.what = command.what;
  const Writing writing(table);
  command.call({});
  return table;
}

std::vector<CommandTable> all_tables() {
  std::vector<CommandTable> tables;
  for (const Command& command : all_commands()) {
    if (command.what != nullptr) tables.push_back(table_of(command));
  }
  return tables;
}

}  // namespace millscope::app
