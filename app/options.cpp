#include <fmt/core.h>

#include <charconv>
#include <iostream>
#include <limits>
#include <sstream>

#include "app/commands.hpp"
#include "app/file_kinds.hpp"
#include "app/tables.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"

namespace millscope::app {

namespace po = boost::program_options;
using base::UserError;

std::vector<std::string> command_line;

Options::Options(std::string usage, std::string what, std::string example)
    : usage_(std::move(usage)), what_(std::move(what)), example_(std::move(example)), visible_("Options", 110, 60) {
  visible_.add_options()("help,h", "show this page");
}

void Options::positional(const std::string& name, const std::string& what, bool takes_all) {
  hidden_.add_options()(name.c_str(), po::value<std::vector<std::string>>());
  positions_.add(name.c_str(), takes_all ? -1 : 1);
  position_help_.emplace_back(name, what);
  takes_all_ = takes_all;
}

void Options::with_plugins() {
  add()("plugin-dir", po::value<std::vector<std::string>>()->value_name("DIR"),
        "also load the plugins of this directory (may be repeated)");
  add()("instruction-set", po::value<std::string>()->value_name("v2|v3|v4"),
        "force the builds for an x86-64 level (default: the best that this machine runs)");
}

void Options::with_overrides(const char* what) {
  add()("set", po::value<std::vector<std::string>>()->value_name("path.to.key=value"), what);
}

bool Options::parse(const Arguments& arguments) {
  if (CommandTable* table = table_being_written()) {
    note_down(*table);
    return false;
  }
  po::options_description all;
  all.add(visible_).add(hidden_);
  try {
    const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(arguments).options(all).positional(positions_).style(style).run(), values_);
  } catch (const po::unknown_option& e) {
    std::vector<std::string> known;
    for (const auto& option : visible_.options()) known.push_back("--" + option->long_name());
    throw UserError(fmt::format("unknown option '{}'; {}", e.get_option_name(), base::suggestion(e.get_option_name(), known)));
  } catch (const po::error& e) {
    throw UserError(fmt::format("{}; usage: millscope {}", e.what(), usage_));
  }
  if (has("help")) {
    print_help();
    return false;
  }
  for (const auto& [name, what] : position_help_) {
    for (const std::string& file : list(name)) refuse_other_kind(name, file);
  }
  return true;
}

void Options::note_down(CommandTable& table) const {
  table.usage = usage_;
  table.page = what_;
  table.example = example_;
  const auto words_of = [this](const std::string& name) {
    const auto found = choices_.find(name);
    return found == choices_.end() ? std::vector<std::string>{} : found->second;
  };
  for (const auto& option : visible_.options()) {
    const std::string shown = option->format_name();  // "-o [ --output ]" or "--output"
    const bool is_flag = option->semantic()->max_tokens() == 0;
    table.options.push_back({option->long_name(), shown.starts_with("--") ? std::string() : shown.substr(1, 1),
                             is_flag ? std::string() : option->semantic()->name(), option->description(), words_of(option->long_name())});
  }
  for (const auto& [name, what] : position_help_) table.positions.push_back({name, what, words_of(name)});
  table.last_takes_all = takes_all_;
}

void Options::print_help() const {
  std::ostringstream options;
  options << visible_;
  fmt::print("usage: millscope {}\n\n{}\n", usage_, what_);
  if (!position_help_.empty()) fmt::print("\n");
  for (const auto& [name, what] : position_help_) fmt::print("  {:<12} {}\n", name, what);
  fmt::print("\n{}\nExample:\n  {}\n", options.str(), example_);
}

std::string Options::text(const std::string& name) const {
  if (!has(name)) {
    const bool is_option = visible_.find_nothrow(name, false) != nullptr;
    throw UserError(fmt::format("{}{} is missing; usage: millscope {}", is_option ? "--" : "", name, usage_));
  }
  const auto& value = values_[name].value();
  if (const auto* list = boost::any_cast<std::vector<std::string>>(&value)) return list->front();
  return boost::any_cast<std::string>(value);
}

std::uint64_t Options::seed(const std::string& name) const {
  const std::string digits = text(name);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc{} && end == digits.data() + digits.size()) return value;
  throw UserError(fmt::format("--{} {}: a seed is a whole number from 0 to {}", name, digits, std::numeric_limits<std::uint64_t>::max()));
}

std::vector<std::string> Options::list(const std::string& name) const {
  return has(name) ? values_[name].as<std::vector<std::string>>() : std::vector<std::string>{};
}

host::Registry Options::registry() const {
  host::RegistryOptions options;
  options.directories = list("plugin-dir");
  if (has("instruction-set")) {
    options.instruction_set = host::parse_instruction_set(text("instruction-set"));
    if (!options.instruction_set) throw UserError(fmt::format("--instruction-set '{}': v2, v3 or v4", text("instruction-set")));
  }
  return host::Registry(options);
}

}  // namespace millscope::app
