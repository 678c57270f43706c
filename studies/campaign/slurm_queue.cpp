#include "studies/campaign/slurm_queue.hpp"

#include <fmt/format.h>

#include <sstream>

#include "kernel/base/error.hpp"
#include "kernel/output/child.hpp"
#include "kernel/output/file.hpp"
#include "studies/campaign/cache.hpp"

namespace millscope::campaign {
namespace {

using base::UserError;

std::string shell_quoted(const std::string& text) { return fmt::format("'{}'", replaced(text, "'", "'\\''")); }

/// What a command of Slurm says. Throws UserError where there is none.
output::Answer ask_slurm(const std::vector<std::string>& words) {
  output::Answer answer = output::ask(words);
  if (answer.code != output::kCannotStart) return answer;
  throw UserError(
      fmt::format("runner slurm: '{}' cannot be started ({}); run this where Slurm's commands are installed (Debian: slurm-client) "
                  "or use the runner local",
                  words[0], answer.text));
}

}  // namespace

void require_slurm() {
  for (const char* program : {"sbatch", "squeue"}) {
    const output::Answer answer = ask_slurm({program, "--version"});
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
                                 fmt::format("--ntasks={}", batch.cores),
                                 "--cpus-per-task=1",
                                 "--no-requeue",
                                 "--chdir=" + batch.folder.string(),
                                 "--output=" + (batch.folder / "task_%a.log").string()};
  words.insert(words.end(), batch.sbatch_options.begin(), batch.sbatch_options.end());
  words.push_back(script.string());
  const output::Answer answer = ask_slurm(words);
  if (answer.code != 0) return answer.text.empty() ? fmt::format("sbatch ends with code {}", answer.code) : answer.text;
  output::write_file(batch.folder / "job", answer.text.substr(0, answer.text.find(';')) + "\n");
  return "";
}

std::optional<std::map<std::string, std::string>> queue(std::string& trouble) {
  // %j name, %K index in the array, %T state; --array: one line for each task.
  const output::Answer answer =
      ask_slurm({"squeue", "--noheader", "--array", "--user=" + std::to_string(::getuid()), "--format=%j %K %T|"});
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
