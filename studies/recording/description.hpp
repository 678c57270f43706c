// recording.yaml as plain data. For the files of this room; docs/recordings.md explains the keys.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernel/config/document.hpp"
#include "kernel/config/units.hpp"
#include "studies/recording/recording.hpp"
#include "studies/recording/table.hpp"

namespace millscope::recording {

enum class Format { automatic, ctrack, table, tracks };

/// A unit and the way to SI: SI value = number · multiplier / divisor.
struct ColumnUnit {
  std::string text;
  double multiplier = 1, divisor = 1;
};

/// One entry of `columns`.
struct ColumnEntry {
  std::optional<Quantity> quantity;  ///< nothing: a column that is skipped, or the label
  bool label = false;                ///< it says whose row it is
  ColumnUnit unit;
  std::optional<int> number;  ///< from 0; nothing: named by its head, not found yet
  std::string header;         ///< of the column
  bool placed = false;        ///< the user said where it stands
};

/// Where a coordinate of the mill's frame comes from: `x: -z`.
struct AxisSource {
  std::size_t axis;
  double sign;
};

struct RecordingFile {
  std::filesystem::path path;
  base::Location where;  ///< where it was named; line 0: by the caller
};

struct Description {
  std::vector<RecordingFile> files;
  Format format = Format::automatic;
  std::optional<std::vector<ColumnEntry>> columns;
  base::Location columns_place;
  std::optional<char> separator;
  base::Location separator_place;
  std::size_t skip_lines = 0;
  base::Location skip_lines_place;
  std::array<AxisSource, 3> axes{{{0, 1}, {1, 1}, {2, 1}}};
  Condition condition;
  std::optional<MillFrame> frame;
  std::optional<double> gap_limit;
  std::vector<std::string> labels;  ///< whose rows are read; empty: all
  base::Location labels_place;
};

/// Reads a recording.yaml; throws base::UserError.
Description read_description(const std::filesystem::path& file);

/// What `gap_limit` may be, s.
config::Range gap_limit_range();

/// The section `condition`.
Condition read_condition(const config::Node& section);

/// The unit of a quantity, e.g. "mm"; throws std::invalid_argument where it is none, or of the wrong kind.
ColumnUnit column_unit(Quantity quantity, std::string_view text);

/// The quantity of a column's name: t, time, timestamp; x, xpos, position x; error, e, u, residual; events, n; whatever its capitals,
/// blanks and underscores. Nothing for others.
std::optional<Quantity> quantity_of(std::string_view name);

/// The unit that a column without one has: ms, mm, none.
const char* usual_unit(Quantity quantity);

}  // namespace millscope::recording
