// Frames in the mill's own frame, and the beads that they are of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace millscope::frames {

/// What the run calls the material of a type of that program: "type_2".
std::string material_name(long long type);

/// One instant; arrays in one order. [n,3] is x0 y0 z0 x1 …
struct Beads {
  double time = 0;
  std::vector<std::uint32_t> id;
  std::vector<double> position, velocity, spin;  ///< m, m/s, rad/s; velocity, spin empty: not in the files
  std::size_t size() const { return id.size(); }
};

/// All frames of an import, in a file of its own while it goes on: each is read once from the text, however large, and what is common to
/// all (which beads there are, how long a frame lasts) is known before the first is written.
class Spool {
 public:
  explicit Spool(const std::filesystem::path& file);
  ~Spool();  ///< removes the file
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Throws base::UserError where the disk is full.
  void add(const Beads& beads);
  std::size_t size() const { return places_.size(); }
  double time(std::size_t frame) const { return times_[frame]; }
  void read(std::size_t frame, Beads& beads);

 private:
  std::filesystem::path file_;
  std::fstream stream_;
  std::vector<std::streamoff> places_;
  std::vector<double> times_;
};

/// What does not change of a bead.
struct BeadKind {
  std::uint32_t id = 0;
  long long type = 0;          ///< 0 where the files say none
  double radius = 0;           ///< m
  double density = 0;          ///< kg/m³
  std::size_t frames = 0;      ///< in which it is there
  std::size_t last_frame = 0;  ///< in which it was seen last
  double mass() const;         ///< kg
};

/// Every bead that is in any frame.
class Census {
 public:
  /// The bead's row; a new one where it was not there before. `known`: whether it was.
  std::size_t row(std::uint32_t id, bool& known);
  BeadKind& operator[](std::size_t row) { return beads_[row]; }
  const std::vector<BeadKind>& beads() const { return beads_; }
  std::size_t row(std::uint32_t id) const { return rows_.at(id); }
  /// Brings the beads into the order of their ids; rows change.
  void sort();

 private:
  std::vector<BeadKind> beads_;
  std::unordered_map<std::uint32_t, std::size_t> rows_;
};

}  // namespace millscope::frames
