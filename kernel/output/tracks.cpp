#include "kernel/output/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/growing_file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using hdf5::Column;
using hdf5::GrowingFile;
using hdf5::Handle;
using hdf5::WaitingRows;

namespace {

constexpr std::size_t kBufferRows = 1024;

void build_track(hid_t file, const TrackInfo& info, const fs::path& path) {
  const Handle group = hdf5::checked({H5Gcreate2(file, info.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose}, path,
                                     fmt::format("creating the track '{}'", info.name));
  hdf5::set_attribute(group, "bead", info.bead);
  hdf5::set_attribute(group, "diameter", info.diameter);
  hdf5::set_attribute(group, "density", info.density);
  hdf5::set_attribute(group, "source", info.source);
  hdf5::make_column<double>(group, {"t", "s", {}, kBufferRows}, path);
  hdf5::make_column<double>(group, {"position", "m", {3}, kBufferRows}, path);
}

void trim_track(hid_t file, const TrackInfo& info, const fs::path& path, double time) {
  const Handle group(H5Gopen2(file, info.name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.valid() || hdf5::get_attribute(group, "bead", info.bead + 1) != info.bead) {
    throw base::UserError(fmt::format("{}: has no track '{}' of bead {}; it belongs to another run: move it away or use another -o",
                                      path.string(), info.name, info.bead));
  }
  const auto open = [&](const char* name) {
    return Column(hdf5::checked({H5Dopen2(group, name, H5P_DEFAULT), H5Dclose}, path, fmt::format("opening '{}'", name)), path);
  };
  Column t = open("t");
  const std::vector<double> times = t.read_doubles();
  const auto kept = static_cast<hsize_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  open("position").truncate(kept);
  t.truncate(kept);
}

}  // namespace

struct TrackWriter::Impl {
  struct Track {
    WaitingRows<double> t, position;
  };

  Impl(const fs::path& path, std::span<const TrackInfo> infos) : file(path) {
    for (const TrackInfo& info : infos) {
      tracks.push_back({WaitingRows<double>(file.column(info.name + "/t")), WaitingRows<double>(file.column(info.name + "/position"))});
    }
    file.flush();
  }

  void append(Track& track, double time, const double* position) {
    track.t.add(std::span<const double>(&time, 1));
    track.position.add(std::span<const double>(position, 3));
    full = full || track.t.waiting() >= kBufferRows;
  }
  void write_through();
  bool close() {
    tracks.clear();
    return file.close();
  }

  GrowingFile file;
  std::vector<Track> tracks;
  bool full = false;
};

void TrackWriter::Impl::write_through() {
  hdf5::prepare();
  std::uint64_t bytes = 0;
  for (const Track& track : tracks) bytes += 32 * track.t.waiting();
  require_space(file.path(), bytes + 64 * kBufferRows);
  const auto positions = [&] {
    for (Track& track : tracks) track.position.write();
  };
  const auto times = [&] {
    for (Track& track : tracks) track.t.write();
  };
  file.write_rows(positions, times);
  full = false;
}

TrackWriter::TrackWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrackWriter::TrackWriter(TrackWriter&&) noexcept = default;
TrackWriter& TrackWriter::operator=(TrackWriter&&) noexcept = default;

TrackWriter::~TrackWriter() {
  if (!impl_) return;
  try {
    impl_->write_through();
  } catch (const std::exception&) {
    // A destructor cannot report; `flush` and `close` do.
  }
  impl_->close();
}

TrackWriter TrackWriter::create(const fs::path& path, std::span<const TrackInfo> tracks) {
  std::set<std::string> names;
  for (const TrackInfo& info : tracks) {
    if (info.name.empty() || info.name.find('/') != std::string::npos || !names.insert(info.name).second) {
      throw std::logic_error("TrackWriter: a track's name is empty, has a '/' or stands twice: " + info.name);
    }
  }
  GrowingFile::create(path, [&](hid_t file) {
    hdf5::stamp_schema(file, "millscope tracks", kTracksSchema);
    for (const TrackInfo& info : tracks) build_track(file, info, path);
  });
  return TrackWriter(std::make_unique<Impl>(path, tracks));
}

TrackWriter TrackWriter::resume(const fs::path& path, std::span<const TrackInfo> tracks, double time) {
  GrowingFile::reopen(path, [&](hid_t file) {
    hdf5::require_schema(file, path, "millscope tracks", kTracksSchema);
    for (const TrackInfo& info : tracks) trim_track(file, info, path, time);
  });
  return TrackWriter(std::make_unique<Impl>(path, tracks));
}

void TrackWriter::append(double time, std::span<const double> position) {
  if (position.size() != 3 * impl_->tracks.size()) throw std::logic_error("TrackWriter: one position per track is needed");
  for (std::size_t k = 0; k < impl_->tracks.size(); ++k) impl_->append(impl_->tracks[k], time, position.data() + 3 * k);
  if (impl_->full) impl_->write_through();
}

void TrackWriter::append_one(std::size_t track, double time, std::span<const double, 3> position) {
  impl_->append(impl_->tracks.at(track), time, position.data());
  if (impl_->full) impl_->write_through();
}

void TrackWriter::flush() {
  impl_->write_through();
  impl_->file.sync();
}

void TrackWriter::close() {
  if (!impl_) return;
  flush();
  const fs::path path = impl_->file.path();
  const bool closed = impl_->close();
  impl_.reset();
  if (!closed) hdf5::fail(path, "closing the file");
}

}  // namespace millscope::output
