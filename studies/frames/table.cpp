// Three layouts, with commas, semicolons or tabs between the cells, behind lines of text that say something else ("EXTRACTED DATA"):
//
//   one bead a line                one quantity a line             one quantity below the other
//   TIME:,0.5                      TIME:,0.5                       TIME:,0.5
//   Particle ID,Position X (m),…   Q01 : Particle ID:,1,2,3        Q01 : Particle ID:
//   1,0.01,…                       Q02 : Particle Position X:,…    ,1
//                                                                  ,2
// EDEM writes the last two ("Output Data in Columns" off and on), each block under its time. In the first, the time may be a column, or
// be said nowhere (a file for each time step).
#include "studies/frames/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "kernel/base/text.hpp"
#include "studies/frames/columns.hpp"
#include "studies/frames/input.hpp"

namespace millscope::frames {
namespace {

constexpr std::size_t kMostPreamble = 1000;  // lines before the first head

class Table : public FrameStream {
 public:
  Table(const std::filesystem::path& file, const ReadOptions& options) : in_(file), options_(options) {}

  bool next(Frame& frame) override {
    frame.begin(in_.file());
    if (in_rows_) return read_rows(frame, false);
    if (time_ || find_block()) {
      frame.time = time_;
      time_.reset();
      if (read_block(frame)) return true;
    }
    if (seen_any_) return false;
    in_.fail(
        "no head names the places of beads: a line such as 'Particle ID,Position X (m),Position Y (m),Position Z (m),…', or queries "
        "'Q01 : Particle Position X:' is needed (docs/import.md); export with the texts");
  }

 private:
  // -------- lines and cells
  bool line() {
    if (again_) return again_ = false, true;
    std::string_view text;
    if (!in_.line(text)) return false;
    if (in_.line_number() == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    text_ = text;
    split();
    return true;
  }

  void split() {
    if (separator_ == 0 || first_cell_is_text()) {
      const std::string_view text(text_);
      const bool tab = text.find('\t') != std::string_view::npos, semicolon = text.find(';') != std::string_view::npos;
      if (tab || semicolon || text.find(',') != std::string_view::npos) separator_ = semicolon ? ';' : tab ? '\t' : ',';
    }
    cells_.clear();
    const std::string_view text(text_);
    const char separator = separator_ == 0 ? ',' : separator_;
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t end = std::min(text.find(separator, at), text.size());
      std::string_view cell = text.substr(at, end - at);
      while (!cell.empty() && (cell.front() == ' ' || cell.front() == '"')) cell.remove_prefix(1);
      while (!cell.empty() && (cell.back() == ' ' || cell.back() == '"')) cell.remove_suffix(1);
      cells_.push_back(cell);
      at = end + 1;
    }
    written_ = cells_.size();
    while (!cells_.empty() && cells_.back().empty()) cells_.pop_back();  // a comma at the end of the line
  }

  bool first_cell_is_text() const {
    const std::size_t at = text_.find_first_not_of(" \"");
    return at != std::string::npos && std::isalpha(static_cast<unsigned char>(text_[at])) != 0;
  }

  bool number_in(std::string_view cell, double& value) const {
    if (separator_ != ',' && cell.find(',') != std::string_view::npos && cell.find('.') == std::string_view::npos) {
      std::string point(cell);
      std::replace(point.begin(), point.end(), ',', '.');
      return parse_number(point, value);
    }
    return parse_number(cell, value);
  }

  double number_of(std::string_view cell, Quantity quantity) {
    double number = 0;
    if (number_in(cell, number)) return number;
    if (quantity != kType || cell.empty()) in_.fail(fmt::format("'{}' is no number; correct it, or export it again", cell.substr(0, 60)));
    return options_.types->number(cell);
  }

  bool is_number(std::string_view cell) const {
    double ignored = 0;
    return number_in(cell, ignored);
  }

  /// "TIME:,0.5", "Time: 0.5 s", "Simulation Time (ms),500". s.
  bool is_time(double& value) {
    if (cells_.empty() || cells_.size() > 3 || !first_cell_is_text() || is_query()) return false;
    std::string name(cells_[0]), number, unit;
    if (cells_.size() == 1) {
      const std::size_t colon = name.find_first_of(":=");
      if (colon == std::string::npos) return false;
      number = base::trimmed(name.substr(colon + 1));
      name.resize(colon);
    } else {
      number = cells_[1];
      if (cells_.size() == 3) unit = cells_[2];
    }
    if (const std::size_t letter = number.find_last_not_of("abcdefghijklmnopqrstuvwxyz"); unit.empty() && letter + 1 < number.size()) {
      unit = number.substr(letter + 1);
      number.resize(letter + 1);
    }
    if (!unit.empty()) name = name.substr(0, name.find_first_of("(:=")) + fmt::format("({})", unit);
    if (!number_in(number, value)) return false;
    try {
      const Column column = column_of(name, options_);
      value *= column.to_si;
      return column.quantity == kTime;
    } catch (const std::invalid_argument& e) {
      if (cells_[0].size() < 4 || !known_as_time(name)) return false;
      in_.fail(e.what());
    }
  }

  bool known_as_time(const std::string& name) const {
    return column_of(name.substr(0, name.find_first_of("([{")), options_).quantity == kTime;
  }

  // -------- blocks
  /// Goes to the first time or head; false at the end of the file.
  bool find_block() {
    for (std::size_t passed = 0; line(); ++passed) {
      double time = 0;
      if (is_time(time)) {
        time_ = time;
        return true;
      }
      if (is_head() || is_query()) {
        again_ = true;
        return true;
      }
      if (passed > kMostPreamble) break;
    }
    return false;
  }

  bool is_head() const {
    if (cells_.size() < 3 || is_number(cells_[0])) return false;
    std::size_t known = 0;
    for (const std::string_view cell : cells_) {
      if (is_number(cell)) return false;
      try {
        const Column c = column_of(cell, options_);
        known += c.quantity && *c.quantity >= kX && *c.quantity <= kZ ? 1 : 0;
      } catch (const std::invalid_argument&) {
        ++known;  // a known quantity in a unit that is not
      }
    }
    return known > 0;
  }

  /// "Q01 : Particle ID:" and its like: a title alone, or before numbers. Before another title it is the head of a table.
  bool is_query() const { return !cells_.empty() && is_numbered(cells_[0]) && (cells_.size() == 1 || !is_numbered(cells_[1])); }

  static bool is_numbered(std::string_view cell) { return without_number(cell).size() < cell.size(); }

  /// What stands under one time.
  bool read_block(Frame& frame) {
    bool queried = false;
    while (line()) {
      double time = 0;
      if (cells_.empty()) continue;
      if (is_time(time)) {
        if (frame.time && (frame.count > 0 || queried || columns_)) {  // known what numbers would be: none are no beads
          time_ = time;
          return end_block(frame);
        }
        if (frame.time) in_.fail(fmt::format("no bead stands under the time {} s; export the queries of the particles", *frame.time));
        frame.time = time;
      } else if (is_query()) {
        read_query(frame);
        queried = true;
      } else if (is_head()) {
        begin_rows();
        return read_rows(frame, true);
      } else if (columns_ && is_number(cells_[0])) {  // under each time the same columns, named once
        again_ = in_rows_ = true;
        return read_rows(frame, false);
      } else if (is_number(cells_[0]) || (cells_[0].empty() && cells_.size() > 1)) {
        in_.fail("numbers stand here without a head that says what they are; export with the texts, the queries' names");
      }
    }
    if (frame.count == 0 && frame.time && !queried)
      in_.fail(fmt::format("no bead stands under the time {} s; export the queries of the particles", *frame.time));
    return (frame.count > 0 || frame.time) && end_block(frame);
  }

  bool end_block(const Frame& frame) {
    if (frame.count > 0) require_places(frame);
    return seen_any_ = true;
  }

  void require_places(const Frame& frame) {
    for (const Quantity q : {kX, kY, kZ}) {
      if (!frame.has(q)) in_.fail(fmt::format("no query above holds {} of the beads; export Position X, Y and Z", "xyz"[q - kX]));
    }
  }

  // -------- queries
  void read_query(Frame& frame) {
    const std::string title(cells_[0]);
    Column column;
    try {
      column = column_of(title, options_);
    } catch (const std::invalid_argument& e) {
      in_.fail(e.what());
    }
    std::vector<double> values;
    if (cells_.size() > 1) {
      take_cells(title, column, values);
    } else {
      while (line()) {
        if ((again_ = is_query() || first_cell_is_text())) break;
        take_cells(title, column, values);
      }
    }
    if (!column.quantity) return frame.passed_over.push_back(title);
    note_unit(column, frame);
    if (frame.has(*column.quantity))
      in_.fail(fmt::format("'{}' holds a quantity that another query of this time holds; export one of them", title));
    if (frame.count > 0 && values.size() != frame.count)
      in_.fail(fmt::format("'{}' holds {} numbers, the queries before it {}: the file is cut short, or they are of other particles", title,
                           values.size(), frame.count));
    frame.count = values.size();
    frame.value[*column.quantity] = std::move(values);
  }

  void take_cells(const std::string& title, const Column& column, std::vector<double>& values) {
    if (cells_.empty() || !column.quantity) return;
    for (std::size_t i = cells_[0] == title || cells_[0].empty() ? 1 : 0; i < cells_.size(); ++i)
      values.push_back(column.to_si * number_of(cells_[i], *column.quantity));
  }

  // -------- a bead a line
  void begin_rows() {
    std::vector<std::string> names;
    for (const std::string_view cell : cells_) names.emplace_back(without_number(cell));
    try {
      columns_.emplace(names, options_);
    } catch (const std::invalid_argument& e) {
      in_.fail(e.what());
    }
    if (const std::string lack = columns_->lacking(); !lack.empty()) in_.fail(lack);
    in_rows_ = true;
  }

  void note_unit(const Column& column, Frame& frame) const {
    if (column.quantity >= kSpinX && column.quantity <= kSpinZ && !column.has_unit) frame.spin_without_unit = true;
  }

  /// Up to another time, another head or the end. `begun`: the head stands just before, so that no row is no bead.
  bool read_rows(Frame& frame, bool begun) {
    columns_->begin(frame);
    for (std::size_t i = 0; i < columns_->size(); ++i) note_unit((*columns_)[i], frame);
    while (line()) {
      double time = 0;
      if (cells_.empty()) continue;
      if (is_time(time)) {
        if (frame.count == 0 && begun && !frame.time) {  // a head before the first time
          frame.time = time;
          continue;
        }
        in_rows_ = false, time_ = time;
        break;
      }
      if (is_head()) {
        in_rows_ = false, again_ = true;
        break;
      }
      if (columns_->has(kTime) && frame.count > 0 && is_other_time(frame)) {
        again_ = true;
        break;
      }
      if (frame.count == 0) frame.first_line = in_.line_number();
      read_row(frame);
    }
    if (frame.has(kTime)) frame.time = frame.value[kTime].front();
    if (frame.count == 0 && !begun) return in_rows_ = false, false;
    return seen_any_ = true;
  }

  bool is_other_time(const Frame& frame) {
    for (std::size_t i = 0; i < columns_->size(); ++i) {
      double number = 0;
      if ((*columns_)[i].quantity == kTime && i < cells_.size() && number_in(cells_[i], number))
        return number * (*columns_)[i].to_si != frame.value[kTime].front();
    }
    return false;
  }

  void read_row(Frame& frame) {
    const std::size_t shift = cells_.size() == columns_->size() + 1 && cells_[0].empty() ? 1 : 0;
    while (cells_.size() < written_ && cells_.size() - shift < columns_->size()) cells_.emplace_back();  // blank, but there
    if (cells_.size() - shift != columns_->size())
      in_.fail(fmt::format("holds {} cells, its head {}: the line is cut short or damaged; export it again", cells_.size() - shift,
                           columns_->size()));
    for (std::size_t i = 0; i < columns_->size(); ++i) {
      if (!(*columns_)[i].quantity) continue;
      columns_->add(frame, i, number_of(cells_[i + shift], *(*columns_)[i].quantity));
    }
    ++frame.count;
  }

  Input in_;
  ReadOptions options_;
  std::string text_;
  std::vector<std::string_view> cells_;  ///< of text_
  std::size_t written_ = 0;              ///< cells of the line, with the blank ones at its end
  char separator_ = 0;
  bool again_ = false;          ///< the line was looked at and belongs to what comes next
  std::optional<double> time_;  ///< under which the next block stands
  std::optional<Columns> columns_;
  bool in_rows_ = false, seen_any_ = false;
};

}  // namespace

std::unique_ptr<FrameStream> open_table(const std::filesystem::path& file, const ReadOptions& options) {
  return std::make_unique<Table>(file, options);
}

}  // namespace millscope::frames
