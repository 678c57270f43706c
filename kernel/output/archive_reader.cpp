#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "kernel/base/error.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/hdf5_tools.hpp"
#include "kernel/output/seal.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using base::UserError;
using hdf5::Handle;

namespace {

std::string remedy_for(const fs::path& path) {
  const fs::path directory = path.parent_path();
  const fs::path previous = previous_checkpoint_path(directory);
  std::error_code ignored;
  if (path.filename() == checkpoint_path("").filename() && fs::exists(previous, ignored)) {
    return fmt::format("use the previous checkpoint: 'mv {} {}', then 'millscope resume {}'", previous.string(), path.string(),
                       directory.string());
  }
  return "no earlier checkpoint is left beside it: start the run again";
}

}  // namespace

struct ArchiveReader::Impl {
  fs::path path;
  Handle file;

  Handle open(const std::string& name) const {
    hdf5::prepare();
    Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (set.valid()) return set;
    throw UserError(fmt::format("{}: holds no '{}'; it was written by another version: {}", path.string(), name, remedy_for(path)));
  }

  template <class T>
  void read(const std::string& name, std::span<T> values) const {
    const Handle set = open(name);
    const Handle type(H5Dget_type(set), H5Tclose);
    const Handle space(H5Dget_space(set), H5Sclose);
    const auto count = static_cast<std::uint64_t>(H5Sget_simple_extent_npoints(space));
    if (H5Tequal(type, hdf5::type_of<T>()) <= 0 || count != values.size()) {
      throw UserError(fmt::format("{}: '{}' has {} values where {} of another kind or number are expected; it belongs to another case: {}",
                                  path.string(), name, count, values.size(), remedy_for(path)));
    }
    if (count > 0) hdf5::check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path, "reading '" + name + "'");
  }
};

ArchiveReader::ArchiveReader(fs::path path) : impl_(std::make_unique<Impl>()) {
  hdf5::prepare();
  impl_->path = std::move(path);
  const std::string fault = seal_fault(impl_->path);
  if (!fault.empty()) throw UserError(fmt::format("{}: {}; {}", impl_->path.string(), fault, remedy_for(impl_->path)));
  impl_->file = hdf5::checked({H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose}, impl_->path, "opening the file");
  hdf5::require_schema(impl_->file, impl_->path, "millscope archive", kArchiveSchema);
}

ArchiveReader::~ArchiveReader() = default;

const fs::path& ArchiveReader::path() const { return impl_->path; }

bool ArchiveReader::has(const std::string& name) const {
  hdf5::prepare();
  // H5Lexists wants each group on the way to exist.
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(impl_->file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) > 0;
}

std::size_t ArchiveReader::size(const std::string& name) const {
  const Handle set = impl_->open(name);
  const Handle space(H5Dget_space(set), H5Sclose);
  return H5Sget_simple_extent_npoints(space);
}

void ArchiveReader::read_into(const std::string& name, std::span<double> values) const { impl_->read(name, values); }
void ArchiveReader::read_into(const std::string& name, std::span<std::int32_t> values) const { impl_->read(name, values); }
void ArchiveReader::read_into(const std::string& name, std::span<std::int64_t> values) const { impl_->read(name, values); }
void ArchiveReader::read_into(const std::string& name, std::span<std::uint8_t> values) const { impl_->read(name, values); }
void ArchiveReader::read_into(const std::string& name, std::span<std::uint32_t> values) const { impl_->read(name, values); }
void ArchiveReader::read_into(const std::string& name, std::span<std::uint64_t> values) const { impl_->read(name, values); }

std::string ArchiveReader::read_text(const std::string& name) const {
  std::string text(size(name), '\0');
  impl_->read(name, std::span(reinterpret_cast<std::uint8_t*>(text.data()), text.size()));
  return text;
}

fs::path checkpoint_path(const fs::path& directory) { return directory / "checkpoint.h5"; }
fs::path previous_checkpoint_path(const fs::path& directory) { return directory / "checkpoint.previous.h5"; }

void rotate_checkpoints(const fs::path& directory) {
  const fs::path current = checkpoint_path(directory);
  const fs::path previous = previous_checkpoint_path(directory);
  const fs::path link = temporary_name(previous);
  ::unlink(link.c_str());
  // A second name for the current one; where the file system has no hard links it is renamed instead.
  const bool linked = ::link(current.c_str(), link.c_str()) == 0;
  if (!linked && errno == ENOENT) return;
  if (std::rename(linked ? link.c_str() : current.c_str(), previous.c_str()) != 0) throw_write_error(previous, errno);
  ::unlink(link.c_str());  // rename does nothing when both are names of one file
}

fs::path newest_checkpoint(const fs::path& directory) {
  std::error_code ignored;
  for (const fs::path& path : {checkpoint_path(directory), previous_checkpoint_path(directory)}) {
    if (fs::exists(path, ignored)) return path;
  }
  throw UserError(fmt::format("{}: holds no checkpoint to resume from; start the run with 'millscope run CASE.yaml -o {}'",
                              directory.string(), directory.string()));
}

}  // namespace millscope::output
