// A folder that is there in full or not at all.
#pragma once

#include <filesystem>

namespace millscope::output {

/// Throws UserError when the folder cannot be made: it exists, or the one that it shall stand in does not.
void refuse_folder(const std::filesystem::path& folder);

/// A folder beside `target`, removed unless it is published.
class NewFolder {
 public:
  /// Throws as `refuse_folder`.
  explicit NewFolder(const std::filesystem::path& target);
  ~NewFolder();
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Renames it to its target.
  void publish();

 private:
  std::filesystem::path target_, path_;
  bool published_ = false;
};

}  // namespace millscope::output
