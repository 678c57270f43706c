// The `millscope` command.
#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "app/commands.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/program.hpp"
#include "kernel/config/document.hpp"

namespace millscope::app {
namespace {

constexpr Command kCommands[] = {
    {"new", "start a mill of your own", new_mill},
    {"run", "simulate a case", run},
    {"resume", "continue a run from its newest checkpoint", resume},
    {"check", "check a case and predict its cost", check},
    {"export", "a case for another engine", export_case},
    {"import", "what another engine made, as a run", import_case},
    {"crosscheck", "whether another engine says the same", crosscheck_engines},
    {"wear", "how a liner wears away in hours of running", wear_liner},
    {"calibrate", "contact parameters from recordings", calibrate_study},
    {"validate", "whether what was calibrated holds elsewhere", validate},
    {"diagnose", "which physics a base case has left out", diagnose_study},
    {"bank", "the simulations that diagnose answers from", bank},
    {"challenge", "sets with hidden physics, made, diagnosed and scored", challenge_sets},
    {"campaign", "run many simulations, each once", run_campaign},
    {"campaign-task", nullptr, campaign_task},
    {"analyze", "measure a simulation or a recording", analyze},
    {"compare", "what differs between two results of analyze", compare},
    {"report", "one page of everything that was found", report_page},
    {"watch", "the same page while a run goes on", watch},
    {"doe", "plan runs, and what planned runs tell", design_of_experiments},
    {"pept", "how good a recording of a tracer is", pept},
    {"describe", "what a plugin does and which parameters it takes", describe},
    {"plugins", "list the plugins", plugins},
    {"schema", "JSON Schema of case files, for editors", schema},
    {"geometry", "export a liner as STL, or report on one", geometry},
    {"plugin", "start a plugin of your own", plugin},
    {"completion", "completion of commands and files for bash, zsh, fish", completion},
    {"complete", nullptr, complete_line},
    {"manual", nullptr, manual},
};

void print_help() {
  fmt::print("millscope {}: see inside a tumbling mill\n\nusage: millscope COMMAND …\n\n", base::version());
  for (const Command& c : kCommands) {
    if (c.what != nullptr) fmt::print("  {:<10} {}\n", c.name, c.what);
  }
  fmt::print(
      "\n'millscope COMMAND --help' explains one, with an example.\n\nExample:\n  millscope run configs/demo.yaml -o demo-out\n\n"
      "Exit codes:");
  const char* before = " ";
  for (const ExitCode& e : kExitCodes) {
    fmt::print("{}{} {}", before, e.code, e.means);
    before = " · ";
  }
  fmt::print("\n\nParticles are spheres; other shapes are not modelled yet.\n");
}

int dispatch(const Arguments& all) {
  if (all.empty() || all[0] == "--help" || all[0] == "-h" || all[0] == "help") {
    print_help();
    return all.empty() ? kBadInput : kDone;
  }
  if (all[0] == "--version") {
    fmt::print("millscope {}\n", base::version_and_commit());
    return kDone;
  }
  std::vector<std::string> names;
  for (const Command& c : kCommands) {
    if (all[0] == c.name) return c.call(Arguments(all.begin() + 1, all.end()));
    if (c.what != nullptr) names.emplace_back(c.name);
  }
  throw base::UserError(fmt::format("'{}' is no command; {}", all[0], base::suggestion(all[0], names)));
}

}  // namespace

std::span<const Command> all_commands() { return kCommands; }

}  // namespace millscope::app

int main(int count, char** words) {
  using namespace millscope;
  app::command_line.assign(words, words + count);
  try {
    const int code = app::dispatch(app::Arguments(words + 1, words + count));
    if (std::fflush(stdout) != 0)
      throw base::UserError(fmt::format("standard output cannot be written ({}); send it elsewhere", std::strerror(errno)),
                            app::kCannotWrite);
    return code;
  } catch (const base::UserError& e) {
    fmt::print(stderr, "millscope: {}\n", e.what());
    return e.exit_code();
  } catch (const std::filesystem::filesystem_error& e) {
    fmt::print(stderr, "millscope: {}: {}; check the path, its permissions and the room on its disk\n", e.path1().string(),
               e.code().message());
    return app::kCannotWrite;
  } catch (const std::system_error& e) {  // standard output, or a thread
    fmt::print(stderr, "millscope: {}; check the room on the disk and this session's limits (ulimit -a)\n", e.what());
    return e.code() == std::errc::resource_unavailable_try_again ? app::kBadInput : app::kCannotWrite;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "millscope: out of memory; close other programs, take a smaller case or less data at once, or a larger machine\n");
    return app::kBadInput;
  } catch (const std::exception& e) {
    fmt::print(stderr, "millscope: internal error: {}; please report it with the case\n", e.what());
    return app::kFailed;
  }
}
