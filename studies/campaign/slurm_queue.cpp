#include "studies/campaign/slurm_queue.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "studies/campaign/cache.hpp"

extern char** environ;

namespace millscope::campaign {
namespace {

using base::UserError;

std::string shell_quoted(const std::string& text) { return fmt::format("'{}'", replaced(text, "'", "'\\''")); }

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> part{};
  for (;;) {
    const ssize_t n = ::read(descriptor, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text;
    text.append(part.data(), n);
  }
}

/// Messages of this program are one line.
std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return replaced(std::move(text), "\n", "; ");
}

}  // namespace

Answer ask(const std::vector<std::string>& words) {
  std::vector<std::string> copy = words;
  std::vector<char*> arguments;
  for (std::string& word : copy) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw UserError(fmt::format("{}: no pipe can be opened: {}", words[0], std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  posix_spawnattr_t attributes;  // a group of its own: Ctrl-C is for this program
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int trouble = ::posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(pipe[1]);
  Answer answer;
  if (trouble == 0) answer.text = one_line(read_all(pipe[0]));
  ::close(pipe[0]);
  if (trouble != 0) {
    throw UserError(
        fmt::format("runner slurm: '{}' cannot be started ({}); run this where Slurm's commands are installed (Debian: slurm-client) "
                    "or use the runner local",
                    words[0], std::strerror(trouble)));
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  return answer;
}

void require_slurm() {
  for (const char* program : {"sbatch", "squeue"}) {
    const Answer answer = ask({program, "--version"});
    if (answer.code != 0)
      throw UserError(fmt::format("runner slurm: '{} --version' says: {}; repair Slurm or use the runner local", program, answer.text));
  }
}

std::string submit(const Batch& batch) {
  make_directory(batch.folder);
  std::string list, command;
  for (const std::filesystem::path& entry : batch.entries) list += entry.string() + "\n";
  for (const std::string& word : batch.command) command += shell_quoted(word) + " ";
  const std::filesystem::path entries = batch.folder / "entries.txt", script = batch.folder / "task.sh";
  output::write_file(entries, list);
  output::write_file(script, fmt::format("#!/bin/sh\n# One simulation of a millscope campaign for each task of the array.\n"
                                         "entry=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\nexec {}\"$entry\"\n",
                                         shell_quoted(entries.string()), command));
  std::vector<std::string> words{"sbatch",
                                 "--parsable",
                                 "--job-name=" + batch.job_name(),
                                 "--ntasks=1",
                                 "--cpus-per-task=1",
                                 "--no-requeue",
                                 "--chdir=" + batch.folder.string(),
                                 "--output=" + (batch.folder / "task_%a.log").string()};
  words.insert(words.end(), batch.sbatch_options.begin(), batch.sbatch_options.end());
  words.push_back(script.string());
  const Answer answer = ask(words);
  if (answer.code != 0) return answer.text.empty() ? fmt::format("sbatch ends with code {}", answer.code) : answer.text;
  output::write_file(batch.folder / "job", answer.text.substr(0, answer.text.find(';')) + "\n");
  return "";
}

std::optional<std::map<std::string, std::string>> queue(std::string& trouble) {
  // %j name, %K index in the array, %T state; --array: one line for each task.
  const Answer answer = ask({"squeue", "--noheader", "--array", "--user=" + std::to_string(::getuid()), "--format=%j %K %T|"});
  if (answer.code != 0) {
    trouble = answer.text;
    return {};
  }
  std::map<std::string, std::string> tasks;
  std::istringstream rows(answer.text);
  for (std::string row; std::getline(rows, row, '|');) {
    std::istringstream cells(row);
    std::string name, index, state;
    if (cells >> name && name == ";") cells >> name;  // between two rows
    if (cells >> index >> state) tasks[fmt::format("{} {}", name, index)] = state;
  }
  return tasks;
}

}  // namespace millscope::campaign
