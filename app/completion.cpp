// completion: the script of a shell, and what fits at the cursor. The scripts hold no names: they ask the command at each press of the
// tabulator (`millscope complete -- WORD…`), which looks into the commands' own tables.
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>

#include "app/shell_scripts.hpp"
#include "app/tables.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/config/document.hpp"

namespace millscope::app {
namespace {

/// What is offered, one a line: "word<tab>explanation", or ":file yaml yml" and ":directory" for what the shell itself lists.
class Offer {
 public:
  Offer(std::string typed, std::string kept) : typed_(std::move(typed)), kept_(std::move(kept)) {}

  void word(const std::string& word, const std::string& what = "") {
    if (word.starts_with(typed_)) fmt::print("{}{}\t{}\n", kept_, word, what.substr(0, what.find('\n')));
  }
  void shell(const std::string& directive) { fmt::print(":{}\n", directive); }
  const std::string& typed() const { return typed_; }

 private:
  std::string typed_;  ///< what the offered words must begin with
  std::string kept_;   ///< part of the shell's word before that
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void offer_plugins(Offer& offer) {
  const host::Registry registry;
  std::set<std::string> known;  // a name may be that of several kinds
  for (const host::Loaded& p : registry.loaded()) {
    const char* what = p.descriptor->doc;
    if (known.insert(p.descriptor->name).second) offer.word(p.descriptor->name, what != nullptr ? what : "");
  }
}

/// From what the help shows for a value: "v2|v3|v4", "DIR", "FILE.yaml", "N", … A default stands behind it: "mm|m (=mm)".
void offer_value(Offer& offer, const std::string& shown, const std::vector<std::string>& choices) {
  const std::string name = shown.substr(0, shown.find(" ("));
  if (!choices.empty()) {
    for (const std::string& choice : choices) offer.word(choice);
  } else if (name.find('|') != std::string::npos) {
    for (const std::string& choice : split(name, '|')) offer.word(choice);
  } else if (name == "PLUGIN") {
    offer_plugins(offer);
  } else if (is_one_of(name, {"DIR", "OUT", "SETS", "OUT2"})) {
    offer.shell("directory");
  } else if (name.ends_with(".yaml")) {
    offer.shell("file yaml yml");
  } else if (const std::size_t dot = name.rfind('.'); dot != std::string::npos && name.find('=') == std::string::npos) {
    offer.shell("file " + name.substr(dot + 1));
  } else if (name.find('/') != std::string::npos || is_one_of(name, {"FILE", "SOURCE", "RECORDING", "A", "B", "TABLE"})) {
    offer.shell("file");
  }
}

const OptionEntry* find_option(const CommandTable& table, const std::string& word) {
  for (const OptionEntry& o : table.options) {
    if (word == "--" + o.name || (!o.letter.empty() && word == "-" + o.letter)) return &o;
  }
  return nullptr;
}

/// `words`: those behind the name of the command or action; the last one is at the cursor.
void offer_in_command(Offer& offer, const CommandTable& table, const std::vector<std::string>& words) {
  std::size_t position = 0;
  const OptionEntry* waiting = nullptr;  // for its value
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (waiting != nullptr) {
      waiting = nullptr;
    } else if (words[i].starts_with("-") && words[i].size() > 1) {
      const OptionEntry* option = find_option(table, words[i]);
      if (option != nullptr && !option->value.empty()) waiting = option;
    } else {
      ++position;
    }
  }
  if (waiting != nullptr) return offer_value(offer, waiting->value, waiting->choices);
  if (offer.typed().starts_with("-")) {
    for (const OptionEntry& o : table.options) offer.word("--" + o.name, o.what);
    return;
  }
  if (table.last_takes_all && position >= table.positions.size()) position = table.positions.size() - 1;
  if (position < table.positions.size()) offer_value(offer, table.positions[position].name, table.positions[position].choices);
}

void offer_in_tables(const std::vector<CommandTable>& tables, const std::vector<std::string>& words, const std::string& kept) {
  if (words.size() == 1) {
    Offer offer(words[0], kept);
    for (const CommandTable& t : tables) offer.word(t.name, t.what);
    if (words[0].starts_with("-")) offer.word("--help", "show all commands");
    return;
  }
  for (const CommandTable& t : tables) {
    if (t.name != words[0]) continue;
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    if (!t.actions.empty()) return offer_in_tables(t.actions, rest, kept);
    Offer offer(rest.back(), kept);
    return offer_in_command(offer, t, rest);
  }
}

/// What bash cuts at '=' is joined again, and `--option=value` cut into two words. `kept`: the part of the shell's last word that stands
/// before the last word of the result.
std::vector<std::string> joined_and_cut(const Arguments& arguments, std::string& kept) {
  std::vector<std::string> words;
  bool join = false;
  for (const std::string& a : arguments) {
    if (a == "=" && !words.empty()) {
      words.back() += a;
      join = true;
    } else if (join) {
      words.back() += a;
      join = false;
    } else {
      words.push_back(a);
    }
  }
  if (words.empty()) words.emplace_back();
  const std::string last = words.back();
  const std::size_t equals = last.starts_with("--") ? last.find('=') : std::string::npos;
  if (equals != std::string::npos) {
    words.back() = last.substr(0, equals);
    words.push_back(last.substr(equals + 1));
    if (arguments.back() == last) kept = last.substr(0, equals + 1);
  }
  return words;
}

}  // namespace

int completion(const Arguments& arguments) {
  Options options("completion SHELL",
                  "Prints the script that completes commands, actions, options, plugins and files. 'make install' puts it where the shells "
                  "look; without, for bash, write into ~/.bashrc: source <(millscope completion bash)",
                  "millscope completion bash > millscope.bash");
  options.positional("SHELL", "bash, zsh or fish");
  options.choices("SHELL", {"bash", "zsh", "fish"});
  if (!options.parse(arguments)) return kDone;
  const std::string shell = options.text("SHELL");
  const std::optional<std::string_view> script = shell_script(shell);
  if (!script)
    throw base::UserError(fmt::format("there is no completion for '{}'; {}", shell, base::suggestion(shell, {"bash", "zsh", "fish"})));
  fmt::print("{}", *script);
  return kDone;
}

int complete_line(const Arguments& arguments) {
  const std::size_t skipped = !arguments.empty() && arguments[0] == "--" ? 1 : 0;
  std::string kept;
  const std::vector<std::string> words =
      joined_and_cut(Arguments(arguments.begin() + static_cast<std::ptrdiff_t>(skipped), arguments.end()), kept);
  offer_in_tables(all_tables(), words, kept);
  return kDone;
}

}  // namespace millscope::app
