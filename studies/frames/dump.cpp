// `dump custom` and `dump atom` (LAMMPS manual, "dump command"; LIGGGHTS has the same):
//
//   ITEM: TIMESTEP                     also before it: ITEM: UNITS, ITEM: TIME
//   1804000
//   ITEM: NUMBER OF ATOMS
//   21992
//   ITEM: BOX BOUNDS ff ff pp          of a tilted box: xy xz yz ff ff pp, with a third number a line
//   -0.05 0.05                         three lines
//   ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius
//   1 1 0.01 0.02 0.03 …               as many lines as atoms
#include "studies/frames/dump.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "kernel/base/text.hpp"
#include "studies/frames/columns.hpp"

namespace millscope::frames {
namespace {

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

class Dump : public FrameStream {
 public:
  Dump(const std::filesystem::path& file, const ReadOptions& options) : in_(file), options_(options) {}

  bool next(Frame& frame) override {
    frame.begin(in_.file());
    count_.reset(), box_.reset(), tilted_ = false;
    std::string_view line;
    bool any = false;
    while (in_.line(line)) {
      if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
      any = true;
      if (!line.starts_with("ITEM:"))
        in_.fail(fmt::format(
            "'{}' stands where an ITEM is expected: the frame before holds more lines than its number of atoms says; the file is damaged",
            line.substr(0, 60)));
      const std::string item(line.substr(5));
      if (item.starts_with(" ATOMS")) {
        read_atoms(item.substr(6), frame);
        return true;
      }
      read_item(item, frame);
    }
    if (any)
      in_.fail(
          "the frame is cut short: no ITEM: ATOMS follows; take the file again from the program, or delete what stands behind the last "
          "whole frame");
    return false;
  }

 private:
  [[noreturn]] void cut_short(std::size_t read) {
    in_.fail(fmt::format("the frame is cut short after {} of {} atoms; take the file again from the program, or delete this frame", read,
                         *count_));
  }

  double one_number(const char* what) {
    std::string_view line;
    double value = 0;
    if (!in_.line(line)) in_.fail(fmt::format("the frame is cut short where {} is expected; delete this frame", what));
    if (!parse_number(line, value))
      in_.fail(fmt::format("'{}' stands where {} is expected; the file is damaged", line.substr(0, 60), what));
    return value;
  }

  void read_item(const std::string& item, Frame& frame) {
    std::string_view line;
    if (item.starts_with(" TIMESTEP")) {
      if (frame.step)
        in_.fail(
            fmt::format("a second TIMESTEP stands here, and the atoms of step {} do not: that frame is cut short; delete it", *frame.step));
      frame.step = std::llround(one_number("the time step"));
    } else if (item.starts_with(" TIME")) {
      frame.time = one_number("the time");
    } else if (item.starts_with(" NUMBER OF ATOMS")) {
      const double count = one_number("the number of atoms");
      if (!(count >= 0 && count < 4e9 && count == std::floor(count)))
        in_.fail(fmt::format("{} is no number of atoms; the file is damaged", count));
      count_ = static_cast<std::size_t>(count);
    } else if (item.starts_with(" BOX BOUNDS")) {
      read_box(item);
    } else if (item.starts_with(" UNITS")) {
      if (!in_.line(line)) in_.fail("the frame is cut short; delete it");
      require_units(base::trimmed(line));
    } else if (item.starts_with(" ENTRIES") || item.starts_with(" NUMBER OF ENTRIES")) {
      in_.fail(
          "holds entries of 'dump local' (contacts), no beads; give the dump of the atoms: dump custom … id type x y z vx vy vz radius");
    } else {
      in_.fail(fmt::format("'ITEM:{}' is not known here; known are TIMESTEP, TIME, UNITS, NUMBER OF ATOMS, BOX BOUNDS, ATOMS", item));
    }
  }

  /// "units" of LAMMPS: those of all numbers in the file.
  void require_units(const std::string& units) {
    const bool cgs = std::fabs(options_.length - 0.01) < 1e-12 && std::fabs(options_.speed - 0.01) < 1e-12;
    if (units == "si" || (units == "cgs" && cgs)) return;
    if (units == "cgs") in_.fail("the units are cgs; add 'length_unit: cm' to mill.yaml, and state 'beads: {density: …}'");
    in_.fail(fmt::format("the units are '{}', which are none of a mill; run the program in si, or scale the file to si", units));
  }

  void read_box(const std::string& item) {
    tilted_ = item.find("xy") != std::string::npos || item.find("abc") != std::string::npos;
    box_.emplace();
    for (auto& side : *box_) {
      std::string_view line;
      if (!in_.line(line)) in_.fail("the frame is cut short in the bounds of its box; delete it");
      const std::vector<std::string> words = words_of(line);
      if (words.size() < 2 || !parse_number(words[0], side[0]) || !parse_number(words[1], side[1]))
        in_.fail(fmt::format("'{}' is no pair of bounds; the file is damaged", line.substr(0, 60)));
    }
  }

  void read_atoms(const std::string& head, Frame& frame) {
    if (!count_) in_.fail("no ITEM: NUMBER OF ATOMS stands before the atoms; the file is damaged");
    std::optional<Columns> columns;
    try {
      columns.emplace(words_of(head), options_);
    } catch (const std::invalid_argument& e) {
      in_.fail(e.what());
    }
    if (const std::string lack = columns->lacking(); !lack.empty()) in_.fail(lack);
    columns->begin(frame);
    frame.first_line = in_.line_number() + 1;
    std::string_view line;
    for (; frame.count < *count_; ++frame.count) {
      if (!in_.line(line)) cut_short(frame.count);
      read_row(line, *columns, frame);
    }
  }

  void read_row(std::string_view line, const Columns& columns, Frame& frame) {
    std::size_t at = 0, column = 0;
    for (; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos; ++column) {
      const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
      if (column < columns.size() && columns[column].quantity) {
        double number = 0;
        const std::string_view word = line.substr(at, end - at);
        if (word.starts_with("ITEM:")) cut_short(frame.count);
        if (!parse_number(word, number)) in_.fail(fmt::format("'{}' is no number; the file is damaged", word.substr(0, 60)));
        columns.add(frame, column, columns[column].scaled ? unscaled(*columns[column].quantity, number) : number);
      }
      at = end;
    }
    if (line.starts_with("ITEM:")) cut_short(frame.count);
    if (column != columns.size())
      in_.fail(fmt::format("holds {} words, its head {}: the line is cut short or damaged; take the file again from the program", column,
                           columns.size()));
  }

  double unscaled(Quantity quantity, double number) const {
    if (!box_ || tilted_) in_.fail("coordinates are scaled (xs ys zs) by a box that is tilted or not told; dump x y z");
    const auto& side = (*box_)[quantity - kX];
    return options_.length * (side[0] + number * (side[1] - side[0]));
  }

  Input in_;
  ReadOptions options_;
  std::optional<std::size_t> count_;
  std::optional<std::array<std::array<double, 2>, 3>> box_;
  bool tilted_ = false;
};

}  // namespace

std::unique_ptr<FrameStream> open_dump(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<Dump>(file, options);
}

}  // namespace millscope::frames
