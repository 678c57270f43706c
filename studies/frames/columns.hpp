// What the columns and arrays of other programs hold, by their names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/frames/frame.hpp"

namespace millscope::frames {

/// One column of numbers; `to_si` is a factor.
struct Column {
  std::optional<Quantity> quantity;  ///< nothing: passed over
  double to_si = 1;
  bool has_unit = false;  ///< of its own
  bool scaled = false;    ///< a coordinate of 0 … 1 over the box (`xs` of a dump)
};

/// "Particle Position X (mm)", "vx", "omegaz", "Q02 : Particle ID:", "Points:0". A unit in brackets goes before `options`. Throws
/// std::invalid_argument for a unit that is unknown or of another kind.
Column column_of(std::string_view name, const ReadOptions& options);

/// An array of three components: "v", "Velocity", "omega". Its first component, or nothing.
Column vector_column_of(std::string_view name, const ReadOptions& options);

/// Which columns a frame has, of which three coordinates are needed; gathered row by row.
class Columns {
 public:
  /// Throws std::invalid_argument as `column_of`, and where two columns hold the same quantity.
  Columns(const std::vector<std::string>& names, const ReadOptions& options);

  std::size_t size() const { return columns_.size(); }
  const Column& operator[](std::size_t i) const { return columns_[i]; }
  bool has(Quantity quantity) const;
  /// "" where x, y and z are there; else a sentence that says which lack.
  std::string lacking() const;
  /// Empties the frame and says what was passed over.
  void begin(Frame& frame) const;
  void add(Frame& frame, std::size_t column, double number) const {
    if (columns_[column].quantity) frame.value[*columns_[column].quantity].push_back(number * columns_[column].to_si);
  }

 private:
  std::vector<std::string> names_;
  std::vector<Column> columns_;
};

/// "Particle ID" of "Q01 : Particle ID", as EDEM numbers its queries; any other name as it is.
std::string_view without_number(std::string_view name);

}  // namespace millscope::frames
