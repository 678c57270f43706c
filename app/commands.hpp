// The commands of `millscope`, each in a file of its own. Each takes what follows its name and returns the exit code.
#pragma once

#include <boost/program_options.hpp>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kernel/host/registry.hpp"

namespace millscope::app {

/// Exit codes, as `millscope --help` documents them.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;       ///< a programming error or a crash of the system's
inline constexpr int kBadInput = 2;     ///< something the user can put right
inline constexpr int kInterrupted = 3;  ///< stopped by a signal after writing a checkpoint
inline constexpr int kCannotWrite = 4;  ///< disk full, no permission

struct ExitCode {
  int code;
  const char* means;
};
inline constexpr ExitCode kExitCodes[] = {
    {kDone, "done"},
    {kFailed, "internal error"},
    {kBadInput, "bad input, the one line on stderr says what and how to put it right"},
    {kInterrupted, "stopped by a signal after writing a checkpoint"},
    {kCannotWrite, "the output cannot be written (disk full, no permission); what was written before is whole"},
};

using Arguments = std::vector<std::string>;

struct Command {
  const char* name;
  const char* what;  ///< nullptr: not for people
  int (*call)(const Arguments&);
};

/// All commands in the order of the overview, in main.cpp.
std::span<const Command> all_commands();

int run(const Arguments& arguments);
int resume(const Arguments& arguments);
int check(const Arguments& arguments);
int export_case(const Arguments& arguments);
int import_case(const Arguments& arguments);
int crosscheck_engines(const Arguments& arguments);
int wear_liner(const Arguments& arguments);
int analyze(const Arguments& arguments);
int compare(const Arguments& arguments);
int report_page(const Arguments& arguments);
int watch(const Arguments& arguments);
int design_of_experiments(const Arguments& arguments);
int calibrate_study(const Arguments& arguments);
int validate(const Arguments& arguments);
int diagnose_study(const Arguments& arguments);
int bank(const Arguments& arguments);
int challenge_sets(const Arguments& arguments);
int run_campaign(const Arguments& arguments);
int campaign_task(const Arguments& arguments);
int pept(const Arguments& arguments);
int pept_camera(const Arguments& arguments);
int pept_synthesize(const Arguments& arguments);
int describe(const Arguments& arguments);
int plugins(const Arguments& arguments);
int schema(const Arguments& arguments);
int geometry(const Arguments& arguments);
int plugin(const Arguments& arguments);
int new_mill(const Arguments& arguments);
int completion(const Arguments& arguments);
int complete_line(const Arguments& arguments);
int manual(const Arguments& arguments);

/// One command's options: declared, parsed and explained in one place.
class Options {
 public:
  /// `usage`: "run CASE.yaml -o OUT"; `what`: one sentence; `example`: a command that runs as it stands.
  Options(std::string usage, std::string what, std::string example);

  boost::program_options::options_description_easy_init add() { return visible_.add_options(); }
  /// A positional argument, in order; `last_takes_all` for lists.
  void positional(const std::string& name, const std::string& what, bool takes_all = false);
  /// The words that an option or a positional argument may be, for completion and the manual; `parse` does not hold it to them.
  void choices(const std::string& name, std::vector<std::string> words) { choices_[name] = std::move(words); }
  /// --plugin-dir, --instruction-set: what every command that loads plugins has.
  void with_plugins();
  /// --set path=value. `what`: what it replaces, with an example.
  void with_overrides(const char* what = "replace a value of the case (may be repeated), e.g. --set time.end_s=2");

  /// False when --help was asked for and printed. Throws UserError for what does not parse, with the nearest option.
  bool parse(const Arguments& arguments);

  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::string text(const std::string& name) const;  ///< throws UserError when it was not given
  std::vector<std::string> list(const std::string& name) const;
  int integer(const std::string& name) const { return values_[name].as<int>(); }
  double number(const std::string& name) const { return values_[name].as<double>(); }
  std::uint64_t seed(const std::string& name) const;  ///< declared as text; throws UserError for what is no whole number of 64 bits
  host::Registry registry() const;

 private:
  void print_help() const;
  void note_down(struct CommandTable& table) const;
  std::string usage_, what_, example_;
  boost::program_options::options_description visible_, hidden_;
  boost::program_options::positional_options_description positions_;
  std::vector<std::pair<std::string, std::string>> position_help_;
  std::map<std::string, std::vector<std::string>> choices_;
  bool takes_all_ = false;  ///< the last positional argument
  boost::program_options::variables_map values_;
};

/// The command line as it was given, for the provenance.
extern std::vector<std::string> command_line;

}  // namespace millscope::app
