// What the readers of growing HDF5 files share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernel/output/hdf5_tools.hpp"

namespace millscope::output::hdf5 {

/// Opens for reading, also while a run writes it or after a kill. `remedy`: what to do when it is not there.
Handle open_for_reading(const std::filesystem::path& path, const std::string& remedy);

/// A dataset and its extent.
struct Dataset {
  Handle id;
  std::vector<hsize_t> extent;
};

/// Throws base::UserError when it is missing or has not `rank` dimensions.
Dataset open_dataset(hid_t parent, const std::string& name, int rank, const std::filesystem::path& path);
bool has(hid_t parent, const std::string& name);

/// Rows first … first + count − 1 into `values` (of type T, converted by HDF5 where the file's type differs).
void read_rows_raw(const Dataset& set, hsize_t first, hsize_t count, hid_t type, void* values, const std::filesystem::path& path);
template <class T>
std::vector<T> read_rows(const Dataset& set, hsize_t count, const std::filesystem::path& path) {
  hsize_t size = count;
  for (std::size_t axis = 1; axis < set.extent.size(); ++axis) size *= set.extent[axis];
  std::vector<T> values(size);
  if (size > 0) read_rows_raw(set, 0, count, type_of<T>(), values.data(), path);
  return values;
}

/// A text-list attribute; empty when absent.
std::vector<std::string> get_texts(hid_t object, const char* name);
/// The f64 attribute, or `missing`.
double get_number(hid_t object, const char* name, double missing);

}  // namespace millscope::output::hdf5
