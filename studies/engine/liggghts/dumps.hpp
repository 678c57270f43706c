// What LIGGGHTS has written of the beads.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "kernel/run/assembly.hpp"

namespace millscope::engine::liggghts {

/// A text file, line by line, with its place for messages.
class TextFile {
 public:
  /// Throws base::UserError where it cannot be read.
  explicit TextFile(const std::filesystem::path& file);
  /// The next line that is whole; false at the end.
  bool next();
  const std::string& text() const { return text_; }
  [[noreturn]] void fail(const std::string& what) const;
  /// The numbers of the line, exactly so many, all finite.
  std::vector<double> numbers(std::size_t count) const;

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  std::string text_;
  int line_ = 0;
};

/// A bead of beads.data: number from 0 on, m, kg/m³.
struct DataBead {
  std::uint32_t id = 0;
  double diameter = 0, density = 0;
};
std::vector<DataBead> beads_in(const std::filesystem::path& file);

/// frames.h5 of post/frame_*.txt. Returns how many. Throws base::UserError for one that is missing, cut short or of other beads.
std::size_t write_frames(const std::filesystem::path& post, const run::Assembly& a, const std::filesystem::path& to);

/// vtk/ of post/picture_*.txt and the walls; `to`: the folder, which is made. Throws likewise.
void write_pictures(const std::filesystem::path& post, const run::Assembly& a, const std::filesystem::path& to);

/// tracks.h5 of post/tracks.txt. `folder`: that of the exported case. Throws likewise.
void write_tracks(const std::filesystem::path& folder, const run::Assembly& a, const std::filesystem::path& to);

}  // namespace millscope::engine::liggghts
