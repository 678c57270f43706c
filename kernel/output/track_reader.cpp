#include "kernel/output/track_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernel/base/error.hpp"
#include "kernel/output/reading.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using hdf5::Dataset;
using hdf5::Handle;

struct TrackReader::Impl {
  fs::path path;
  Handle file;
  std::vector<TrackInfo> tracks;

  Handle group(const std::string& name) const {
    return hdf5::checked({H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose}, path, fmt::format("opening the track '{}'", name));
  }
  void list();
};

namespace {

herr_t note_group(hid_t parent, const char* name, const H5L_info_t*, void* into) {
  if (H5Lexists(parent, (std::string(name) + "/t").c_str(), H5P_DEFAULT) > 0)
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
  return 0;
}

}  // namespace

void TrackReader::Impl::list() {
  std::vector<std::string> names;
  hdf5::check(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_group, &names), path, "listing the tracks");
  for (const std::string& name : names) {
    const Handle g = group(name);
    tracks.push_back({name, hdf5::get_attribute(g, "bead", 0), hdf5::get_number(g, "diameter", 0), hdf5::get_number(g, "density", 0),
                      hdf5::get_text_attribute(g, "source")});
  }
  std::sort(tracks.begin(), tracks.end(),
            [](const TrackInfo& a, const TrackInfo& b) { return std::tie(a.bead, a.name) < std::tie(b.bead, b.name); });
  if (tracks.empty())
    throw base::UserError(fmt::format("{}: holds no track; write it with 'output: {{tracks: {{}}}}' in the case", path.string()));
}

TrackReader::TrackReader(fs::path path) : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  impl_->file = hdf5::open_for_reading(impl_->path, "give a directory that 'millscope run' wrote from a case with 'output: {tracks: {}}'");
  hdf5::require_schema(impl_->file, impl_->path, "millscope tracks", kTracksSchema);
  impl_->list();
}

TrackReader::~TrackReader() = default;
TrackReader::TrackReader(TrackReader&&) noexcept = default;
TrackReader& TrackReader::operator=(TrackReader&&) noexcept = default;

const fs::path& TrackReader::path() const { return impl_->path; }
const std::vector<TrackInfo>& TrackReader::tracks() const { return impl_->tracks; }

std::size_t TrackReader::sample_count(std::size_t track) const {
  return hdf5::open_dataset(impl_->file, impl_->tracks.at(track).name + "/t", 1, impl_->path).extent[0];
}

TrackSamples TrackReader::read(std::size_t track) const {
  const std::string& name = impl_->tracks.at(track).name;
  TrackSamples samples;
  const Dataset t = hdf5::open_dataset(impl_->file, name + "/t", 1, impl_->path);
  samples.time = hdf5::read_rows<double>(t, t.extent[0], impl_->path);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples.time[i] > samples.time[i - 1]) continue;
    throw base::UserError(fmt::format("{}: the times of track '{}' do not increase at sample {}; the file is damaged: write it again",
                                      impl_->path.string(), name, i));
  }
  const Dataset p = hdf5::open_dataset(impl_->file, name + "/position", 2, impl_->path);
  if (p.extent[1] != 3 || p.extent[0] < samples.size()) {
    throw base::UserError(fmt::format("{}: the positions of track '{}' do not fit its {} times; the file is damaged: write it again",
                                      impl_->path.string(), name, samples.size()));
  }
  const std::vector<double> position = hdf5::read_rows<double>(p, samples.size(), impl_->path);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    samples.position[axis].resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) samples.position[axis][i] = position[3 * i + axis];
  }
  return samples;
}

void unwrap(std::vector<double>& coordinate, double period) {
  double shift = 0, before = coordinate.empty() ? 0.0 : coordinate.front();
  for (double& value : coordinate) {
    shift -= period * std::round((value - before) / period);
    before = value;
    value += shift;
  }
}

bool is_track_file(const fs::path& path) {
  hdf5::prepare();
  if (H5Fis_hdf5(path.c_str()) <= 0) return false;
  try {
    return hdf5::get_text_attribute(hdf5::open_for_reading(path, ""), "format") == "millscope tracks";
  } catch (const base::UserError&) {
    return false;
  }
}

}  // namespace millscope::output
