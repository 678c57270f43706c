#include "kernel/output/frame_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/output/frames.hpp"
#include "kernel/output/reading.hpp"
#include "millscope/element.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using hdf5::Dataset;
using hdf5::Handle;

namespace {

constexpr std::array<const char*, 3> kFields{"position", "velocity", "spin"};
constexpr const char* kRemedy = "give a directory that 'millscope run' wrote from a case with 'output: {frames: {}}'";

}  // namespace

struct FrameReader::Impl {
  fs::path path;
  Handle file;
  FrameBeads beads;
  FrameScalars scalars;
  std::array<Dataset, 3> fields;

  template <class T>
  std::vector<T> whole(const char* name) const {
    const Dataset set = hdf5::open_dataset(file, name, 1, path);
    return hdf5::read_rows<T>(set, set.extent[0], path);
  }
  /// The first `frames` rows of a column of doubles.
  std::vector<double> column(const char* name, int rank) const {
    return hdf5::read_rows<double>(hdf5::open_dataset(file, name, rank, path), scalars.time.size(), path);
  }
  std::vector<double> named(const char* name, std::vector<std::string>& names) const;
  void read_beads();
  void read_scalars();
  void read_impacts();
  [[noreturn]] void damaged(const std::string& what) const {
    throw base::UserError(fmt::format("{}: {}; it is damaged: write it again with 'millscope run'", path.string(), what));
  }
};

std::vector<double> FrameReader::Impl::named(const char* name, std::vector<std::string>& names) const {
  if (!hdf5::has(file, name)) return {};
  const Dataset set = hdf5::open_dataset(file, name, 2, path);
  names = hdf5::get_texts(set.id, "columns");
  if (names.size() != set.extent[1]) damaged(fmt::format("'{}' has {} columns and {} names", name, set.extent[1], names.size()));
  return hdf5::read_rows<double>(set, scalars.time.size(), path);
}

void FrameReader::Impl::read_beads() {
  beads.id = whole<std::uint32_t>("beads/id");
  beads.radius = whole<double>("beads/radius");
  beads.mass = whole<double>("beads/mass");
  beads.material = whole<std::uint32_t>("beads/material");
  beads.material_names = hdf5::get_texts(hdf5::open_dataset(file, "beads/material", 1, path).id, "names");
  const std::size_t count = beads.id.size();
  if (count == 0 || beads.radius.size() != count || beads.mass.size() != count || beads.material.size() != count) {
    damaged("its bead table is empty, or its arrays differ in length");
  }
}

void FrameReader::Impl::read_scalars() {
  scalars.time = whole<double>("time");
  for (std::size_t i = 1; i < scalars.time.size(); ++i) {
    if (!(scalars.time[i] > scalars.time[i - 1])) damaged(fmt::format("its times do not increase at frame {}", i));
  }
  scalars.wall_angle = column("wall_angle", 1);
  scalars.angular_velocity = column("angular_velocity", 1);
  if (hdf5::has(file, "mass_there")) scalars.mass_there = column("mass_there", 1);
  scalars.wall_work = named("wall_work", scalars.wall_names);
  scalars.dissipation = named("dissipation", scalars.dissipation_names);
  read_impacts();
}

void FrameReader::Impl::read_impacts() {
  if (!hdf5::has(file, "impacts")) return;
  const Dataset set = hdf5::open_dataset(file, "impacts", 3, path);
  scalars.impact_pairs = hdf5::get_texts(set.id, "pairs");
  scalars.impact_edges = whole<double>("impact_energy_edge");
  if (scalars.impact_pairs.size() != set.extent[1] || scalars.impact_edges.size() != set.extent[2] + 1) {
    damaged("'impacts' does not fit its pairs and energies");
  }
  scalars.impacts = hdf5::read_rows<double>(set, scalars.time.size(), path);
}

FrameReader::FrameReader(fs::path path) : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  impl_->file = hdf5::open_for_reading(impl_->path, kRemedy);
  hdf5::require_schema(impl_->file, impl_->path, "millscope frames", kFramesSchema);
  impl_->read_beads();
  impl_->read_scalars();
  for (std::size_t k = 0; k < kFields.size(); ++k) {
    impl_->fields[k] = hdf5::open_dataset(impl_->file, kFields[k], 3, impl_->path);
    const std::vector<hsize_t>& extent = impl_->fields[k].extent;
    if (extent[0] < frame_count() || extent[1] != impl_->beads.size() || extent[2] != 3) {
      impl_->damaged(fmt::format("'{}' is [{}, {}, {}] for {} frames of {} beads", kFields[k], extent[0], extent[1], extent[2],
                                 frame_count(), impl_->beads.size()));
    }
  }
}

FrameReader::~FrameReader() = default;
FrameReader::FrameReader(FrameReader&&) noexcept = default;
FrameReader& FrameReader::operator=(FrameReader&&) noexcept = default;

const fs::path& FrameReader::path() const { return impl_->path; }
const FrameBeads& FrameReader::beads() const { return impl_->beads; }
const FrameScalars& FrameReader::scalars() const { return impl_->scalars; }
std::size_t FrameReader::frame_count() const { return impl_->scalars.time.size(); }

void FrameReader::read(BeadField field, std::size_t first, std::size_t count, std::span<float> values) const {
  if (first + count > frame_count() || values.size() != 3 * count * impl_->beads.size()) {
    throw std::logic_error("FrameReader: frames outside the file, or a buffer of another size");
  }
  if (count > 0) hdf5::read_rows_raw(element(impl_->fields, field), first, count, H5T_IEEE_F32LE, values.data(), impl_->path);
}

}  // namespace millscope::output
