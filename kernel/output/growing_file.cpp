#include "kernel/output/growing_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/superblock.hpp"

namespace millscope::output::hdf5 {

namespace fs = std::filesystem;

namespace {

// SWMR needs the newest file format; locks are taken where the file system has them.
Handle access_list() {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(list, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  H5Pset_file_locking(list, true, true);
  return list;
}

// Space in pages of the operating system's size: a small piece of metadata never lies across two of them. A kill may fall between the
// two halves of such a write, and HDF5 then refuses the piece for its checksum.
Handle creation_list() {
  Handle list(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_file_space_strategy(list, H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(list, 4096);
  return list;
}

}  // namespace

Column::Column(Handle set, fs::path path) : set_(std::move(set)), path_(std::move(path)) {
  const Handle space(H5Dget_space(set_), H5Sclose);
  extent_.resize(std::max(1, H5Sget_simple_extent_ndims(space)));
  check(H5Sget_simple_extent_dims(space, extent_.data(), nullptr), path_, "reading a dataset's shape");
}

hsize_t Column::row_size() const {
  hsize_t size = 1;
  for (std::size_t axis = 1; axis < extent_.size(); ++axis) size *= extent_[axis];
  return size;
}

void Column::append_raw(hid_t type, const void* values, hsize_t count) {
  if (count == 0) return;
  std::vector<hsize_t> start(extent_.size(), 0), block = extent_;
  start.front() = extent_.front();
  block.front() = count;
  extent_.front() += count;
  check(H5Dset_extent(set_, extent_.data()), path_, "extending a dataset");
  const Handle in_file(H5Dget_space(set_), H5Sclose);
  const Handle in_memory(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  check(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr), path_, "selecting rows");
  check(H5Dwrite(set_, type, in_memory, in_file, H5P_DEFAULT, values), path_, "writing");
}

void Column::truncate(hsize_t rows) {
  if (rows > extent_.front()) {
    throw base::UserError(fmt::format("{}: a dataset has only {} of {} rows; the file is damaged: move it away and start the run again",
                                      path_.string(), extent_.front(), rows));
  }
  if (rows == extent_.front()) return;
  extent_.front() = rows;
  check(H5Dset_extent(set_, extent_.data()), path_, "dropping rows");
}

std::vector<double> Column::read_doubles() const {
  std::vector<double> values(rows());
  if (!values.empty()) check(H5Dread(set_, H5T_IEEE_F64LE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path_, "reading");
  return values;
}

void make_column_raw(hid_t parent, const ColumnSpec& spec, hid_t type, const fs::path& path) {
  std::vector<hsize_t> extent{0}, largest{H5S_UNLIMITED}, chunk{spec.chunk_rows};
  for (std::vector<hsize_t>* list : {&extent, &largest, &chunk}) list->insert(list->end(), spec.shape.begin(), spec.shape.end());
  const int rank = static_cast<int>(extent.size());
  const Handle space(H5Screate_simple(rank, extent.data(), largest.data()), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_chunk(creation, rank, chunk.data()), path, "choosing chunks of '" + spec.name + "'");
  if (spec.checksum) H5Pset_fletcher32(creation);
  const Handle set = checked({H5Dcreate2(parent, spec.name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose}, path,
                             "creating '" + spec.name + "'");
  set_attribute(set, "unit", spec.unit);
}

void write_fixed(hid_t parent, const std::string& name, hid_t type, hsize_t count, const void* values) {
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle set(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (count > 0) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void GrowingFile::create(const fs::path& path, const std::function<void(hid_t)>& build) {
  prepare();
  refuse_existing(path);
  const fs::path temporary = reserve_temporary(path);
  try {
    require_space(temporary, 0);
    Handle file =
        checked({H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, creation_list(), access_list()), H5Fclose}, path, "creating the file");
    build(file);
    check(H5Fflush(file, H5F_SCOPE_GLOBAL), path, "writing");
    if (!file.close()) fail(path, "closing the file");
    publish(temporary, path);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void GrowingFile::reopen(const fs::path& path, const std::function<void(hid_t)>& trim) {
  prepare();
  if (::access(path.c_str(), F_OK) != 0) {
    throw base::UserError(
        fmt::format("{}: is missing, the run cannot be continued; put it back or start the run again with another -o", path.string()));
  }
  if (::access(path.c_str(), W_OK) != 0) throw_write_error(path, errno);
  if (!repair_superblock(path)) {
    throw base::UserError(fmt::format("{}: is damaged at its start; move it away and start the run again", path.string()));
  }
  Handle file = checked({H5Fopen(path.c_str(), H5F_ACC_RDWR, access_list()), H5Fclose}, path, "opening the file");
  trim(file);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), path, "writing");
  if (!file.close()) fail(path, "closing the file");
}

GrowingFile::GrowingFile(fs::path path) : path_(std::move(path)) {
  prepare();
  file_ = checked({H5Fopen(path_.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, access_list()), H5Fclose}, path_, "opening the file");
}

Column GrowingFile::column(const std::string& name) const {
  return {checked({H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose}, path_, "opening '" + name + "'"), path_};
}

void GrowingFile::flush() {
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL), path_, "writing");
  clear_writer_mark(path_);
}

void GrowingFile::sync() {
  flush();
  File(path_, O_RDONLY).sync();
}

bool GrowingFile::close() {
  prepare();
  if (!file_.valid()) return true;
  const bool flushed = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = file_.close();
  clear_writer_mark(path_);
  return flushed && closed;
}

}  // namespace millscope::output::hdf5
