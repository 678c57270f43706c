#include <fcntl.h>
#include <unistd.h>

#include <stdexcept>

#include "kernel/output/archive.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/hdf5_tools.hpp"
#include "kernel/output/seal.hpp"

namespace millscope::output {

using hdf5::check;
using hdf5::checked;
using hdf5::Handle;

struct ArchiveWriter::Impl {
  std::filesystem::path path, temporary;
  Handle file;
  bool pending = false;  // sealed (or failed to be) and not yet renamed

  // Gives the disk back first, so that HDF5 finds room for what it insists on writing when it closes the file.
  void abandon() {
    if (!file.valid() && !pending) return;
    if (file.valid()) static_cast<void>(!::truncate(temporary.c_str(), 0));
    file.close();
    ::unlink(temporary.c_str());
    pending = false;
  }

  template <class T>
  void write(const std::string& name, std::span<const T> values);
};

template <class T>
void ArchiveWriter::Impl::write(const std::string& name, std::span<const T> values) {
  if (!file.valid()) throw std::logic_error("ArchiveWriter: write after commit or after a failure");
  hdf5::prepare();
  const std::string doing = "writing '" + name + "'";
  try {
    require_space(temporary, values.size_bytes());
    const hsize_t count = values.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const hid_t type = hdf5::type_of<T>();
    Handle set = checked({H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose}, path, doing);
    if (count > 0) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path, doing);
    if (!set.close()) hdf5::fail(path, doing);
  } catch (...) {
    abandon();
    throw;
  }
}

ArchiveWriter::ArchiveWriter(std::filesystem::path path) : impl_(std::make_unique<Impl>()) {
  hdf5::prepare();
  impl_->path = std::move(path);
  impl_->temporary = temporary_name(impl_->path);
  File(impl_->temporary, O_WRONLY | O_CREAT | O_TRUNC);  // says plainly what HDF5 would say badly
  require_space(impl_->temporary, 0);
  impl_->file =
      checked({H5Fcreate(impl_->temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose}, impl_->path, "creating the file");
  hdf5::stamp_schema(impl_->file, "millscope archive", kArchiveSchema);
}

ArchiveWriter::~ArchiveWriter() { impl_->abandon(); }

void ArchiveWriter::write(const std::string& name, std::span<const double> values) { impl_->write(name, values); }
void ArchiveWriter::write(const std::string& name, std::span<const std::int32_t> values) { impl_->write(name, values); }
void ArchiveWriter::write(const std::string& name, std::span<const std::int64_t> values) { impl_->write(name, values); }
void ArchiveWriter::write(const std::string& name, std::span<const std::uint8_t> values) { impl_->write(name, values); }
void ArchiveWriter::write(const std::string& name, std::span<const std::uint32_t> values) { impl_->write(name, values); }
void ArchiveWriter::write(const std::string& name, std::span<const std::uint64_t> values) { impl_->write(name, values); }

void ArchiveWriter::write_text(const std::string& name, const std::string& text) {
  impl_->write(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void ArchiveWriter::seal() {
  if (!impl_->file.valid()) throw std::logic_error("ArchiveWriter: seal or commit after the end or after a failure");
  hdf5::prepare();
  try {
    check(H5Fflush(impl_->file, H5F_SCOPE_GLOBAL), impl_->path, "writing");
  } catch (...) {
    impl_->abandon();
    throw;
  }
  impl_->pending = true;
  if (!impl_->file.close()) hdf5::fail(impl_->path, "closing the file");
  append_seal(impl_->temporary);
}

void ArchiveWriter::commit() {
  if (!impl_->pending) seal();
  publish(impl_->temporary, impl_->path);
  impl_->pending = false;
}

}  // namespace millscope::output
