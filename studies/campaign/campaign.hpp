// Many simulations, each computed once: cached by what its result depends on, on this machine or through Slurm.
//
// CACHE/<key>/         one simulation
//   case.yaml          the resolved case, with meshes as copies in CACHE/files: what is run, whatever becomes of the user's files; and from
//                      which other simulation's end it begins, once that is known
//   task.json          state, message, wall time, label
//   run/               what `millscope run` writes
//   lock               the head that works on it (host, process); taken over when that head is dead
//   messages.txt       what the simulation printed
// CACHE/files/         meshes and other files that cases name, by content
// CACHE/slurm/         batches handed to Slurm: script, list, job number
//
// A finished simulation is never computed again; a half-finished one goes on from its checkpoint; a failed one is reported with its
// message and tried again only when asked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernel/base/error.hpp"

namespace millscope::campaign {

/// One simulation to have.
struct Simulation {
  std::filesystem::path case_file;
  std::vector<std::string> settings;  ///< "path.to.key=value", as `--set`
  std::string label;                  ///< for people: progress, tables, task.json

  /// The simulation at whose end this one begins, of the same mill at the same speed; null: from a filling at rest. It is run, too, where
  /// it has not been. Where it fails, its own donor takes its place, and so on; where none is left, this one is filled in and settled.
  std::shared_ptr<const Simulation> donor = {};
  double develop_s = 0;  ///< s, with a donor: from the start to time.analyze_from_s
};

enum class State { done, failed };

/// What became of a simulation.
struct Outcome {
  State state = State::failed;
  std::filesystem::path folder;  ///< the run's output directory; empty when the case could not even be read
  std::string message;           ///< why it failed, one line
  bool cached = false;           ///< nothing was computed for it in this call
  double wall_s = 0;             ///< of the simulation, over all sessions, s
  std::string key;               ///< of the cache; empty when the case could not be read
};

struct Options {
  std::filesystem::path cache;
  std::string runner = "local";  ///< local or slurm
  int slots = 0;                 ///< simulations at once; 0: local: the cores that this process may use; slurm: no limit
  std::vector<std::filesystem::path> plugin_directories;  ///< as --plugin-dir
  bool quiet = false;
  std::function<void(std::size_t index, const Outcome&)> finished;  ///< called once for each simulation, as it ends
  std::function<void(const std::string&)> say = {};                 ///< one line on what is used again, and why something is not
  bool say_of_other_programs = true;                                ///< that what they computed is not used; costs reading the whole cache
  bool retry_failed = false;                                        ///< compute failed ones again
  std::uint64_t memory_bytes = 0;          ///< that simulations may use together (local); 0: what the machine has free
  std::filesystem::path program;           ///< the millscope command to run; empty: this very program
  std::vector<std::string> slurm_options;  ///< further words for sbatch, e.g. "--partition=long"
  double poll_s = 5;                       ///< between two looks at Slurm's queue, s
};

/// Stopped by SIGINT or SIGTERM: the simulations have been asked to write a checkpoint and to stop. The same call goes on from there.
class Interrupted : public base::UserError {
 public:
  explicit Interrupted(const std::string& message) : UserError(message, 3) {}
};

/// Runs what is not in the cache and returns an outcome for each, in their order; blocks. One thread per simulation. A simulation that
/// fails is an outcome. Throws Interrupted; UserError when the cache cannot be written or the runner does not work.
std::vector<Outcome> run(std::span<const Simulation> simulations, const Options& options);

/// 32 hexadecimal digits over the case, a hyphen, and 16 over the program. The case: resolved, with what it writes (not its name, threads
/// or checkpoint interval) and the contents of the files it names, and the donor's key. The program: the code of the kernel, compiler,
/// flags and libraries, and the code of every build of the libraries of the case's plugins. Throws UserError when the case cannot be read.
std::string key(const Simulation& simulation, const Options& options);

}  // namespace millscope::campaign
