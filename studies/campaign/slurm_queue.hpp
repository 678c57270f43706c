// Talking to Slurm: sbatch, squeue.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace millscope::campaign {

/// An array job: task i of it carries out entries[i].
struct Batch {
  std::filesystem::path folder;                ///< CACHE/slurm/<name>
  std::vector<std::filesystem::path> entries;  ///< CACHE/<key>
  std::vector<std::string> command;            ///< what a task runs; the entry's folder is appended
  int cores = 1;                               ///< processes of each task, which its own mpirun starts in its allocation
  std::vector<std::string> sbatch_options;

  std::string job_name() const { return "millscope-" + folder.filename().string(); }
};

/// Writes list and script into the batch's folder and hands it to sbatch; the job's number is kept in the file `job`. Returns "", or
/// what sbatch says against it.
std::string submit(const Batch& batch);

/// "<job name> <task index>" → PENDING, RUNNING, … of this user's array tasks that Slurm still has. Nothing when squeue fails.
std::optional<std::map<std::string, std::string>> queue(std::string& trouble);

/// Throws UserError where sbatch or squeue is missing.
void require_slurm();

}  // namespace millscope::campaign
