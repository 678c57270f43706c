#include "studies/engine/liggghts/play.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <thread>

#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/child.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/file.hpp"
#include "kernel/run/progress.hpp"
#include "studies/engine/liggghts/folder.hpp"
#include "studies/engine/liggghts/obstacles.hpp"
#include "studies/engine/liggghts/results.hpp"
#include "studies/engine/liggghts/script.hpp"

namespace millscope::engine::liggghts {
namespace {

namespace fs = std::filesystem;
using base::UserError;
using output::Child;
using output::Ended;

constexpr const char* kLog = "log.liggghts";
constexpr const char* kMessages = "messages.txt";

/// What a program says. Throws where it is not installed, or, `version` not being "", another version of it.
std::string require_program(const std::vector<std::string>& question, const std::string& package, const std::string& version) {
  const output::Answer answer = output::ask(question);
  if (answer.code == output::kCannotStart)
    throw UserError(
        fmt::format("{}: not found on this machine ({}); install it (Debian: apt install {})", question[0], answer.text, package));
  if (answer.text.find(version) == std::string::npos)
    throw UserError(fmt::format("{}: '{}', but version {} is needed (Debian: apt install {})", question[0], answer.text.substr(0, 80),
                                version, package));
  return answer.text;
}

void require_programs(const run::Assembly& a) {
  installed_version();
  if (a.c.run.ranks > 1) require_program({"mpirun", "--version"}, "openmpi-bin", "");
}

/// One line for a bead that got lost, and what helps.
std::string remedy_for(const std::string& error) {
  for (const char* sign : {"Lost atoms", "Non-numeric", "non-numeric", "out of range", "bad atom"}) {
    if (error.find(sign) != std::string::npos) return "beads ran away; take a smaller time step (--set time.step_fraction=…)";
  }
  if (error.find("Processor") != std::string::npos || error.find("rocessor grid") != std::string::npos) return "give fewer --ranks";
  return "the file says more";
}

/// The last bytes of a file that another process writes; "" where there is none yet.
std::string end_of(const fs::path& file) {
  constexpr std::streamoff kBytes = 1 << 14;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const std::streamoff size = in.tellg();
  in.seekg(std::max<std::streamoff>(0, size - kBytes));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What to start, in the folder of the case.
std::vector<std::string> command_for(const run::Assembly& a, const std::string& script) {
  const int ranks = a.c.run.ranks;
  std::vector<std::string> words;
  if (ranks > 1) {
    words = {"mpirun", "-np", std::to_string(ranks), "--oversubscribe", "--bind-to", "none"};  // runs beside each other share all cores
    if (::geteuid() == 0) words.emplace_back("--allow-run-as-root");
  }
  const Bounds z = bounds_of(a, 2);
  const RankGrid grid = rank_grid(ranks, z.high - z.low, a.c.largest_diameter());
  // By lines: before it aborts it does not write out what it holds back, its error among it.
  words.insert(words.end(), {"stdbuf", "-oL", "liggghts", "-in", script});
  for (const auto& [name, count] : {std::pair("px", grid.x), std::pair("py", grid.y), std::pair("pz", grid.z)})
    words.insert(words.end(), {"-var", name, std::to_string(count)});
  return words;
}

fs::path restart_file(const fs::path& post, std::int64_t step) { return post / fmt::format("restart.{}", step); }

/// LIGGGHTS goes on where it cannot write: the newest restart file may be cut, and those behind it empty.
void drop_restarts_of_full_disk(const fs::path& post) {
  const std::vector<std::int64_t> steps = steps_of_files(post, "restart");
  for (std::size_t k = steps.size(); k-- > 0;) {
    const bool empty = fs::file_size(restart_file(post, steps[k])) == 0;
    fs::remove(restart_file(post, steps[k]));
    if (!empty) break;
  }
}

/// Throws with what LIGGGHTS said where it did not come to its end.
void require_success(const Ended& ended, const fs::path& folder, std::int64_t steps_done, std::int64_t steps) {
  const bool whole = ended.signal == 0 && ended.exit_code == 0 && steps_done >= steps;
  if (!whole && output::free_bytes(folder) < 1'000'000) {  // of which it may say nothing
    drop_restarts_of_full_disk(folder / "post");
    throw UserError(fmt::format("{}: the disk is full; make room, then 'millscope resume {}' lets it go on", folder.string(),
                                folder.parent_path().string()),
                    output::kExitDisk);
  }
  for (const char* name : {kLog, kMessages}) {
    const std::string error = state_of_log(base::text_if_readable(folder / name).value_or("")).error;
    if (!error.empty()) throw UserError(fmt::format("{}: {}; {}", (folder / name).string(), error, remedy_for(error)));
  }
  if (whole) return;
  if (ended.signal == 0 && ended.exit_code == 0 && steps_done > 0)
    throw UserError(fmt::format("LIGGGHTS was stopped from outside after step {} of {}; 'millscope resume {}' lets it go on", steps_done,
                                steps, folder.parent_path().string()));
  const std::string how =
      ended.signal != 0 ? fmt::format("was ended by signal {}", ended.signal) : fmt::format("ended with code {}", ended.exit_code);
  throw UserError(fmt::format(
      "LIGGGHTS {} after step {} of {}, without an error of its own; {} may say more. Out of memory? 'millscope resume {}' lets it go on",
      how, steps_done, steps, (folder / kMessages).string(), folder.parent_path().string()));
}

/// Where LIGGGHTS begins: its script, and the case's step.
struct Begin {
  std::string script;
  std::int64_t step = 0;
  std::optional<std::int64_t> restart = {};  ///< the file that it reads
};

/// All but the last two with something in them: the last may be half written, and on a full disk those behind it are empty.
void drop_old_restarts(const fs::path& post) {
  const std::vector<std::int64_t> steps = steps_of_files(post, "restart");
  int kept = 0;
  for (std::size_t k = steps.size(); k-- > 0;) {
    const fs::path file = restart_file(post, steps[k]);
    if (kept == 2)
      fs::remove(file);
    else
      kept += fs::file_size(file) > 0 ? 1 : 0;
  }
}

/// The newest that is whole: LIGGGHTS has told of that step or a later one, which it does when the file is written; has written another
/// behind it; or has begun from it before.
std::optional<std::int64_t> sound_restart(const fs::path& folder) {
  const std::vector<std::int64_t> steps = steps_of_files(folder / "post", "restart");
  if (steps.empty()) return {};
  const auto told = state_of_log(base::text_if_readable(folder / kLog).value_or("")).step;
  const bool begun = fs::exists(folder / "post" / name_of_session("series", steps.back()));
  if (begun || (told && *told >= steps.back())) return steps.back();
  return steps.size() > 1 ? std::optional(steps[steps.size() - 2]) : std::nullopt;
}

/// Lets it run to its end, or until a stop is asked for.
run::Outcome wait(const run::Assembly& a, const run::RunOptions& options, const fs::path& folder, const Begin& begin) {
  const std::string stopped = "stopped; continue with: millscope resume " + folder.parent_path().string();
  run::Progress progress(a, options.quiet, options.terminal);
  if (run::is_stop_requested()) {
    progress.finish(stopped);
    return run::Outcome::interrupted;
  }
  fs::remove(folder / kLog);
  Child child(command_for(a, begin.script), folder / kMessages, folder);
  std::int64_t step = begin.step;
  bool has_told = false;
  for (;;) {
    const std::optional<Ended> ended = child.poll();
    if (const auto told = state_of_log(end_of(folder / kLog)).step; told && !(has_told && *told - zero_step(a) == step)) {
      step = std::max(begin.step, *told - zero_step(a)), has_told = true;
      drop_old_restarts(folder / "post");  // a folder of many frames is not listed more often
    }
    if (ended) {
      progress.finish("");
      // A restart file that cannot be read: the next resume takes the one before.
      if (begin.restart && !has_told) fs::remove(restart_file(folder / "post", *begin.restart));
      require_success(*ended, folder, step - a.first_step, a.end_step - a.first_step);
      return run::Outcome::finished;
    }
    if (run::is_stop_requested()) {
      progress.finish(stopped);
      return run::Outcome::interrupted;
    }
    progress.update(step, begin.step);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// From where it begins to the files of a run.
run::Outcome finish(const run::Assembly& a, const host::Registry& registry, const run::RunOptions& options, const Begin& begin) {
  const fs::path out = output::without_end_slash(options.output), folder = out / output::kEngineFolder;
  const auto started = std::chrono::steady_clock::now();
  if (wait(a, options, folder, begin) == run::Outcome::interrupted) return run::Outcome::interrupted;
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  read_results(folder, out, registry, {options.command_line, a.c.run.ranks, wall});
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "post")) {
    // frames.h5, vtk/ and tracks.h5 have them; there is nothing to go on to.
    for (const char* name : {"frame_", "picture_", "tracks.", "restart."}) {
      if (entry.path().filename().string().starts_with(name)) fs::remove(entry);
    }
  }
  return run::Outcome::finished;
}

}  // namespace

RankGrid rank_grid(int ranks, double length, double largest_diameter) {
  RankGrid grid;
  for (int z = 1; z <= ranks; ++z) {
    if (ranks % z == 0 && length / z >= 4 * largest_diameter) grid.z = z;
  }
  grid.x = ranks / grid.z;
  return grid;
}

LogState state_of_log(const std::string& text) {
  LogState state;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;  // not whole yet
    const std::string line = base::trimmed(std::string_view(text).substr(begin, end - begin), " \t\r");
    begin = end + 1;
    if (state.error.empty() && line.starts_with("ERROR")) state.error = line;
    std::int64_t step = 0;
    std::size_t words = 1;
    for (std::size_t i = 1; i < line.size(); ++i) words += line[i] != ' ' && line[i - 1] == ' ';
    const auto [behind, failed] = std::from_chars(line.data(), line.data() + line.size(), step);
    if (failed == std::errc{} && words == kThermoWords && behind != line.data() + line.size() && *behind == ' ') state.step = step;
  }
  return state;
}

fs::path newest_restart(const fs::path& folder) {
  const std::vector<std::int64_t> steps = steps_of_files(folder / "post", "restart");
  return steps.empty() ? fs::path() : restart_file(folder / "post", steps.back());
}

std::string installed_version() {
  static const std::string version = [] {
    const std::string said = require_program({"liggghts", "-h", "-log", "none"}, "liggghts", "LIGGGHTS-PUBLIC 3.8");
    const std::size_t begin = std::min(said.size(), said.find("LIGGGHTS (Version"));
    return said.substr(begin, said.find(';', begin) - begin);
  }();
  return version;
}

run::Outcome play_case(const std::string& case_file, const host::Registry& registry, const run::RunOptions& options) {
  run::Assembly a = run::assemble(config::read_case(case_file, options.overrides), registry);
  require_playable(a, registry);
  require_programs(a);
  run::insert_beads(a);  // whether they fit is known before an earlier run is touched
  output::OutputDirectory directory(options.output, options.force ? output::Mode::overwrite : output::Mode::fresh);
  directory.start();
  const fs::path folder = directory.path() / output::kEngineFolder;
  try {
    write_case(a, registry, folder);
  } catch (...) {
    directory.undo();
    throw;
  }
  return finish(a, registry, options, {"in.liggghts", a.first_step});
}

run::Outcome resume_case(const host::Registry& registry, const run::RunOptions& options) {
  const fs::path out = output::without_end_slash(options.output), folder = out / output::kEngineFolder;
  if (fs::exists(out / "summary.json")) throw UserError(fmt::format("{}: is finished; there is nothing to continue", out.string()));
  if (!options.overrides.empty()) throw UserError("resume: a run of another engine goes on as it is; leave --set out");
  run::Assembly a = run::assemble(config::read_case((folder / output::kResolvedCase).string()), registry);
  require_programs(a);
  output::OutputDirectory directory(out, output::Mode::resume);
  directory.start();
  const std::optional<std::int64_t> restart = sound_restart(folder);
  if (!restart) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "post")) fs::remove_all(entry);
    return finish(a, registry, options, {"in.liggghts", a.first_step});
  }
  for (const std::int64_t later : steps_of_files(folder / "post", "restart")) {
    if (later > *restart) fs::remove(restart_file(folder / "post", later));
  }
  for (const char* what : {"series", "tracks"}) {
    for (const std::int64_t later : steps_of_files(folder / "post", what)) {
      if (later > *restart) fs::remove(folder / "post" / name_of_session(what, later));
    }
  }
  run::insert_beads(a);  // which of them are followed
  output::write_file(folder / "in.resume", script_of(a, physics_of(a, registry), meshes_of(a), restart));
  return finish(a, registry, options, {"in.resume", *restart - zero_step(a), restart});
}

}  // namespace millscope::engine::liggghts
