// The places of the cache and what task.json says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "studies/campaign/campaign.hpp"
#include "studies/campaign/identity.hpp"

namespace millscope::campaign {

/// How far a simulation of the cache is.
enum class Stage { waiting, running, interrupted, done, failed };

/// task.json.
struct TaskRecord {
  Stage stage = Stage::waiting;
  std::string label;
  std::string message;              ///< why it failed
  int attempts = 0;                 ///< sessions that were begun
  double wall_s = 0;                ///< of all sessions, s; known when it is done
  std::string host;                 ///< where the last session ran
  base::ProgramParts program = {};  ///< Identity::program
};

/// CACHE/<key>.
class Entry {
 public:
  explicit Entry(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Entry(const std::filesystem::path& cache, const std::string& key) : folder_(cache / key) {}

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path case_file() const { return folder_ / "case.yaml"; }
  std::filesystem::path run() const { return folder_ / "run"; }
  std::filesystem::path messages() const { return folder_ / "messages.txt"; }

  /// Writes case.yaml, copies the files that it names into CACHE/files, and begins task.json; what is there stays.
  void prepare(const Identity& identity, const std::string& label) const;

  /// Says in case.yaml at the end of which simulation of the same cache this one begins; "": of none.
  void begin_from(const std::string& donor_key, double develop_s) const;

  /// What is known of it. A run with a summary is done, whatever task.json says: its head may have died between the two.
  TaskRecord read() const;
  void write(const TaskRecord& record) const;

  /// Modification time of the newest checkpoint, or of the newest restart file of another engine, ns; 0: none.
  std::int64_t checkpoint_time() const;

 private:
  std::filesystem::path folder_;
};

/// The outcome that a done or failed record tells.
Outcome outcome_of(const Entry& entry, const TaskRecord& record);

/// Last line of what a process printed, without "millscope: "; "" when there is none.
std::string last_line(const std::filesystem::path& file);

/// Host name of this machine.
std::string host_name();

/// Makes a directory with its parents. UserError when that fails.
void make_directory(const std::filesystem::path& directory);

}  // namespace millscope::campaign
