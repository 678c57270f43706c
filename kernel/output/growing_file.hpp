// HDF5 files that grow during a run and survive its end by kill -9.
//
// They are written in HDF5's single-writer-multiple-reader mode, whose order of writes keeps the file whole at every moment. HDF5 marks
// such a file as "open for writing", which would lock ordinary readers out after a kill; `flush` clears that mark each time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernel/output/hdf5_tools.hpp"

namespace millscope::output::hdf5 {

/// A dataset [rows, shape…] with unlimited rows.
class Column {
 public:
  Column() = default;
  Column(Handle set, std::filesystem::path path);

  hsize_t rows() const { return extent_.front(); }
  /// Values per row.
  hsize_t row_size() const;
  /// Appends `count` rows from `values` (of the type T that the dataset was made with).
  template <class T>
  void append(const T* values, hsize_t count) {
    append_raw(type_of<T>(), values, count);
  }
  void truncate(hsize_t rows);
  /// All values of a column of doubles without shape.
  std::vector<double> read_doubles() const;

 private:
  void append_raw(hid_t type, const void* values, hsize_t count);
  Handle set_;
  std::filesystem::path path_;
  std::vector<hsize_t> extent_;
};

/// A column and its rows that wait to be written.
template <class T>
class WaitingRows {
 public:
  WaitingRows() = default;
  explicit WaitingRows(Column column) : column_(std::move(column)) {}

  /// Takes values of one row or more, rounded to T.
  template <class From>
  void add(std::span<const From> values) {
    const std::size_t before = values_.size();
    values_.resize(before + values.size());
    std::transform(values.begin(), values.end(), values_.begin() + static_cast<std::ptrdiff_t>(before),
                   [](From value) { return static_cast<T>(value); });
  }
  void write() {
    column_.append(values_.data(), waiting());
    values_.clear();
  }
  hsize_t waiting() const { return values_.size() / column_.row_size(); }
  /// Those in the file and those that wait.
  hsize_t rows() const { return column_.rows() + waiting(); }
  hsize_t row_size() const { return column_.row_size(); }

 private:
  Column column_;
  std::vector<T> values_;
};

/// What a column is made of.
struct ColumnSpec {
  std::string name;
  std::string unit;
  std::vector<hsize_t> shape;  ///< of one row; empty: one value
  hsize_t chunk_rows = 1024;
  bool checksum = false;  ///< Fletcher32: only for chunks that are written once
};

void make_column_raw(hid_t parent, const ColumnSpec& spec, hid_t type, const std::filesystem::path& path);
/// Makes an empty column in `parent`.
template <class T>
void make_column(hid_t parent, const ColumnSpec& spec, const std::filesystem::path& path) {
  make_column_raw(parent, spec, type_of<T>(), path);
}

/// Writes a dataset that never changes.
void write_fixed(hid_t parent, const std::string& name, hid_t type, hsize_t count, const void* values);

class GrowingFile {
 public:
  /// Makes the file aside with `build` (which creates every object) and renames it. An existing file is a UserError.
  static void create(const std::filesystem::path& path, const std::function<void(hid_t)>& build);
  /// Opens it for `trim` (which may read and shrink), after clearing the mark of a killed writer. UserError when it is damaged.
  static void reopen(const std::filesystem::path& path, const std::function<void(hid_t)>& trim);
  /// Opens it for appending.
  explicit GrowingFile(std::filesystem::path path);

  Column column(const std::string& name) const;
  /// Writes rows of several columns, then their times: what is listed there is complete. Once that has failed, columns have unlike lengths;
  /// then it is a logic_error.
  template <class Rows, class Times>
  void write_rows(const Rows& rows, const Times& times) {
    if (failed_) throw std::logic_error(path_.string() + ": goes on after a write that failed");
    failed_ = true;
    rows();
    flush();
    times();
    flush();
    failed_ = false;
  }
  /// To the operating system, and lets ordinary readers in.
  void flush();
  /// To the disk.
  void sync();
  /// False when something could not be written.
  bool close();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Handle file_;
  bool failed_ = false;
};

}  // namespace millscope::output::hdf5
