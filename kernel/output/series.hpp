// series.csv: one row per instant, for spreadsheets and pandas.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace millscope::output {

/// Writes a CSV whose first column is the time in seconds. Numbers are written so that reading them gives the same bits.
/// Throws base::UserError when the disk is full or the file cannot be written.
class SeriesWriter {
 public:
  /// `columns`: names with units, e.g. "time_s", "kinetic_energy_J". An existing file is a UserError.
  static SeriesWriter create(const std::filesystem::path& path, std::span<const std::string> columns);
  /// Drops the rows later than `time` (s) and a last row that was cut short. UserError when the columns are not the file's.
  static SeriesWriter resume(const std::filesystem::path& path, std::span<const std::string> columns, double time);
  ~SeriesWriter();
  SeriesWriter(SeriesWriter&&) noexcept;
  SeriesWriter& operator=(SeriesWriter&&) noexcept;

  /// One row; values[columns], the time first. Buffered: about 64 KiB may be lost by kill -9.
  void append(std::span<const double> values);
  /// Onto the disk.
  void flush();
  void close();

 private:
  struct Impl;
  explicit SeriesWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// series.csv, column by column.
struct Series {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< NaN where no number stands

  /// Throws base::UserError when no column has the name.
  const std::vector<double>& column(const std::string& name) const;
};

/// All whole rows: one that is just being written is left out; a cell that is no number is NaN. Throws base::UserError when the file
/// cannot be read or its rows differ in length.
Series read_series(const std::filesystem::path& path);

}  // namespace millscope::output
