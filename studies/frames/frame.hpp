// Frames that other simulation programs wrote, one after the other, whatever the format.
//
//   const auto frames = read_frames(files, options);
//   Frame frame;
//   while (frames->next(frame)) …
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace millscope::frames {

/// What a program may say of a bead.
enum Quantity : std::size_t {
  kId,
  kType,
  kX,
  kY,
  kZ,
  kVelocityX,
  kVelocityY,
  kVelocityZ,
  kSpinX,
  kSpinY,
  kSpinZ,
  kRadius,
  kMass,
  kDensity,
  kTime,
  kQuantities
};

/// The beads at one instant, in the order of the file and the axes of the file. Lengths are in m and speeds in m/s: the reader turns them.
struct Frame {
  std::filesystem::path file;
  std::size_t first_line = 0;                          ///< where the first bead stands; 0: not one bead a line
  std::optional<double> time;                          ///< s, where the file says it
  bool time_of_picture = false;                        ///< `time` is of VTK, where it may be no more than the number of the picture
  bool spin_without_unit = false;                      ///< a table, which might have named it
  std::optional<std::int64_t> step;                    ///< time step of that program, from the file or its name
  std::size_t count = 0;                               ///< beads
  std::array<std::vector<double>, kQuantities> value;  ///< [count], SI; empty: the file does not say it
  std::vector<std::string> passed_over;                ///< columns and arrays that are nothing of the above

  /// Empty, and of that file.
  void begin(const std::filesystem::path& from);
  /// Without beads, and what was passed over.
  void clear();
  bool has(std::size_t quantity) const { return !value[quantity].empty(); }
  /// "file:line" of a bead, or "file: point 17".
  std::string place(std::size_t bead) const;
};

/// Types that are words: each has one number in all files, from 1 on as they come.
class TypeWords {
 public:
  int number(std::string_view word);
  /// "" of a number that is no word's.
  std::string word(long long number) const;
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::vector<std::string> words_;
  std::map<std::string, int, std::less<>> numbers_;
};

struct ReadOptions {
  double length = 1;  ///< m for each unit of length, in files that do not name units themselves
  double speed = 1;   ///< m/s for each unit of speed, likewise
  double spin = 1;    ///< rad/s for each unit of spin, likewise
  std::shared_ptr<TypeWords> types = std::make_shared<TypeWords>();
};

class FrameStream {
 public:
  virtual ~FrameStream() = default;
  /// The next frame; false behind the last one. `frame` keeps its memory from call to call. Throws base::UserError: "file:line: …".
  virtual bool next(Frame& frame) = 0;
};

/// The frames of one file: dumps of LIGGGHTS and LAMMPS, tables and EDEM's exports as text, VTK (legacy, .vtp, .vtu), each also gzipped.
/// The format is known by the first bytes. Throws base::UserError for what is none of them.
std::unique_ptr<FrameStream> open_frames(const std::filesystem::path& file, const ReadOptions& options);

/// A name for the format of a file: "LIGGGHTS/LAMMPS dump", …
std::string format_of(const std::filesystem::path& file);

/// The frames of several files, in the order of the numbers in their names. A .pvd stands for the files that it lists, and says their
/// times.
std::unique_ptr<FrameStream> read_frames(const std::vector<std::filesystem::path>& files, const ReadOptions& options);

}  // namespace millscope::frames
