#include "kernel/output/reading.hpp"

#include <fmt/format.h>

#include "kernel/base/error.hpp"

namespace millscope::output::hdf5 {

namespace {

[[noreturn]] void damaged(const std::filesystem::path& path, const std::string& what) {
  throw base::UserError(fmt::format("{}: {}; it is damaged or was not written by millscope: write it again", path.string(), what));
}

}  // namespace

Handle open_for_reading(const std::filesystem::path& path, const std::string& remedy) {
  prepare();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw base::UserError(fmt::format("{}: there is no such file; {}", path.string(), remedy));
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw base::UserError(fmt::format("{}: is no HDF5 file, or cannot be read; {}", path.string(), remedy));
  const Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Beside a writer HDF5 reads metadata anew until it is whole, waiting twice as long each time: 16 ms in all, then it is damaged.
  H5Pset_metadata_read_attempts(list, 24);
  // As a reader beside a writer first: that also opens what a killed writer has left marked as open.
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, list), H5Fclose);
  if (file.valid()) return file;
  return checked({H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}, path, "opening the file");
}

bool has(hid_t parent, const std::string& name) {
  prepare();
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(parent, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0;
}

Dataset open_dataset(hid_t parent, const std::string& name, int rank, const std::filesystem::path& path) {
  if (!has(parent, name)) damaged(path, fmt::format("it has no dataset '{}'", name));
  Dataset set{checked({H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose}, path, fmt::format("opening '{}'", name)), {}};
  const Handle space(H5Dget_space(set.id), H5Sclose);
  const int found = H5Sget_simple_extent_ndims(space);
  if (found != rank) damaged(path, fmt::format("its dataset '{}' has {} dimensions instead of {}", name, found, rank));
  set.extent.resize(rank);
  if (rank > 0) check(H5Sget_simple_extent_dims(space, set.extent.data(), nullptr), path, "reading a dataset's shape");
  return set;
}

void read_rows_raw(const Dataset& set, hsize_t first, hsize_t count, hid_t type, void* values, const std::filesystem::path& path) {
  prepare();
  std::vector<hsize_t> start(set.extent.size(), 0), block = set.extent;
  if (block.empty()) return check(H5Dread(set.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path, "reading");
  if (first + count > block.front()) damaged(path, fmt::format("a dataset has {} rows, {} are needed", block.front(), first + count));
  start.front() = first;
  block.front() = count;
  const Handle in_file(H5Dget_space(set.id), H5Sclose);
  const Handle in_memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  check(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr), path, "selecting rows");
  check(H5Dread(set.id, type, in_memory, in_file, H5P_DEFAULT, values), path, "reading");
}

std::vector<std::string> get_texts(hid_t object, const char* name) {
  std::vector<std::string> texts;
  if (H5Aexists(object, name) <= 0) return texts;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count <= 0) return texts;
  std::vector<char*> raw(count, nullptr);
  if (H5Aread(attribute, text_type(), raw.data()) < 0) return texts;
  for (char* text : raw) {
    texts.emplace_back(text == nullptr ? "" : text);
    if (text != nullptr) H5free_memory(text);
  }
  return texts;
}

double get_number(hid_t object, const char* name, double missing) {
  if (H5Aexists(object, name) <= 0) return missing;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  double value = missing;
  return H5Aread(attribute, H5T_IEEE_F64LE, &value) < 0 ? missing : value;
}

}  // namespace millscope::output::hdf5
