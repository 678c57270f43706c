// The output directory: never overwritten silently, never shared by two runs, never left half-made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace millscope::output {

/// In the directory of a run: the case with all its values.
inline constexpr const char* kResolvedCase = "case.resolved.yaml";

/// In the directory of a run that another engine makes: its script, its log, its state.
inline constexpr const char* kEngineFolder = "engine";

/// The path without slashes at its end ("out/"), so that its last name is the folder's.
std::filesystem::path without_end_slash(std::filesystem::path path);

/// Its last name, also of "." and of "out/".
std::string name_of_folder(const std::filesystem::path& folder);

enum class Mode {
  fresh,      ///< must be missing or empty
  overwrite,  ///< `--force`: files of an earlier run are removed, foreign files refuse
  resume,     ///< must hold a checkpoint
};

/// Takes hold of OUT. What is wrong is a base::UserError before anything was changed: existing output, a parent that cannot be
/// written, another run in it, too little free disk.
class OutputDirectory {
 public:
  /// `needed_bytes`: estimate of what the run will write; 0: unknown.
  OutputDirectory(std::filesystem::path path, Mode mode, std::uint64_t needed_bytes = 0);
  /// Lets go; without `start` also removes the directories that the constructor made.
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

  /// The run begins: from here on the directory stays. With Mode::overwrite the earlier run's files are removed now,
  /// with Mode::resume those that a kill left half written (*.tmp).
  void start();
  /// The run could not begin: removes what was written since `start`, and the directories that the constructor made. Not with
  /// Mode::resume.
  void undo();
  const std::filesystem::path& path() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Free bytes on the disk that holds `path` (or, where it does not exist yet, its nearest existing parent).
std::uint64_t free_bytes(const std::filesystem::path& path);

}  // namespace millscope::output
