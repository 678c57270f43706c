#include "kernel/output/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

namespace millscope::output {

namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

// The new name survives a power cut only when its directory is synced too; file systems that cannot do that are left alone.
void sync_directory(const std::filesystem::path& directory) {
  const int descriptor = ::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

File::File(std::filesystem::path path, int flags) : path_(std::move(path)), descriptor_(::open(path_.c_str(), flags | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw_write_error(path_, errno);
}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

File::File(File&& other) noexcept : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void File::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(descriptor_, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) throw_write_error(path_, errno);
    bytes.remove_prefix(done);
  }
}

void File::sync() {
  // Pipes and some devices cannot be synced (EINVAL): nothing is lost by that.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) throw_write_error(path_, errno);
}

void File::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) throw_write_error(path_, errno);
}

void File::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (descriptor >= 0 && ::close(descriptor) != 0 && errno != EINTR) throw_write_error(path_, errno);
}

std::filesystem::path temporary_name(const std::filesystem::path& path) { return path.string() + ".tmp"; }

std::filesystem::path reserve_temporary(const std::filesystem::path& path) {
  constexpr int kAttempts = 100;
  for (int attempt = 0;; ++attempt) {
    const std::filesystem::path name = attempt == 0 ? temporary_name(path) : temporary_name(path.string() + "." + std::to_string(attempt));
    const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      return name;
    }
    if (errno != EEXIST || attempt == kAttempts) throw_write_error(name, errno);
  }
}

bool is_temporary_of(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  const std::string name = temporary.string(), wanted = path.string(), end = ".tmp";
  if (name.size() < wanted.size() + end.size() || !name.starts_with(wanted) || !name.ends_with(end)) return false;
  const std::string number = name.substr(wanted.size(), name.size() - wanted.size() - end.size());
  return number.empty() || (number.size() > 1 && number[0] == '.' && number.find_first_not_of("0123456789", 1) == std::string::npos);
}

void publish(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  File file(temporary, O_RDONLY);
  file.sync();
  file.close();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) throw_write_error(path, errno);
  sync_directory(path.parent_path());
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), file_(reserve_temporary(path_), O_WRONLY | O_NOFOLLOW) {}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(file_.path().c_str());
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferBytes) write_through();
}

void AtomicFile::commit() {
  write_through();
  file_.close();
  publish(file_.path(), path_);
  committed_ = true;
}

void AtomicFile::write_through() {
  file_.write(buffer_);
  buffer_.clear();
}

void write_file(const std::filesystem::path& path, std::string_view bytes, bool overwrite) {
  if (!overwrite) refuse_existing(path);
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace millscope::output
