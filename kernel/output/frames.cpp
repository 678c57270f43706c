#include "kernel/output/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

#include "kernel/base/error.hpp"
#include "kernel/output/file.hpp"
#include "kernel/output/growing_file.hpp"

namespace millscope::output {

namespace fs = std::filesystem;
using hdf5::Column;
using hdf5::ColumnSpec;
using hdf5::GrowingFile;
using hdf5::Handle;
using hdf5::WaitingRows;

namespace {

constexpr std::array<const char*, 3> kBeadColumns{"position", "velocity", "spin"};
constexpr std::array<const char*, 3> kBeadUnits{"m", "m/s", "rad/s"};

using Clock = std::chrono::steady_clock;

// Frames wait for each other: to bring a small one alone to the operating system costs as much as hundreds of steps of its beads.
constexpr std::size_t kWaiting = 256 << 10;          // bytes
constexpr std::chrono::milliseconds kPatience{250};  // of who looks on

template <class T>
void write_fixed(hid_t parent, const char* name, std::span<const T> values, const char* unit) {
  hdf5::write_fixed(parent, name, hdf5::type_of<T>(), values.size(), values.data());
  const Handle set(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  hdf5::set_attribute(set, "unit", std::string(unit));
}

void name_columns(hid_t file, const char* column, const std::vector<std::string>& names) {
  const Handle set(H5Dopen2(file, column, H5P_DEFAULT), H5Dclose);
  hdf5::set_attribute(set, "columns", names);
}

void write_bead_table(hid_t file, const BeadTable& table) {
  const Handle beads(H5Gcreate2(file, "beads", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  write_fixed(beads, "id", table.id, "1");
  write_fixed(beads, "radius", table.radius, "m");
  write_fixed(beads, "mass", table.mass, "kg");
  write_fixed(beads, "material", table.material, "1");
  const Handle set(H5Dopen2(beads, "material", H5P_DEFAULT), H5Dclose);
  hdf5::set_attribute(set, "names", table.material_names);
}

void build(hid_t file, const BeadTable& table, const fs::path& path) {
  hdf5::stamp_schema(file, "millscope frames", kFramesSchema);
  write_bead_table(file, table);
  hdf5::make_column<double>(file, {"time", "s", {}}, path);
  hdf5::make_column<double>(file, {"wall_angle", "rad", {}}, path);
  hdf5::make_column<double>(file, {"angular_velocity", "rad/s", {}}, path);
  if (table.beads_vary) hdf5::make_column<double>(file, {"mass_there", "kg", {}}, path);
  const auto make_named = [&](const char* name, const std::vector<std::string>& columns) {
    if (columns.empty()) return;
    hdf5::make_column<double>(file, {name, "J", {columns.size()}, 256}, path);
    name_columns(file, name, columns);
  };
  make_named("wall_work", table.wall_names);
  make_named("dissipation", table.dissipation_names);
  if (!table.impact_pairs.empty()) {
    hdf5::make_column<std::uint64_t>(file, {"impacts", "1", {table.impact_pairs.size(), table.impact_edges.size() - 1}, 64}, path);
    const Handle set(H5Dopen2(file, "impacts", H5P_DEFAULT), H5Dclose);
    hdf5::set_attribute(set, "pairs", table.impact_pairs);
    write_fixed(file, "impact_energy_edge", std::span<const double>(table.impact_edges), "J");
  }
  for (std::size_t k = 0; k < kBeadColumns.size(); ++k) {
    hdf5::make_column<float>(file, {kBeadColumns[k], kBeadUnits[k], {table.id.size(), 3}, 1, true}, path);
  }
}

std::span<const double> one(const double& value) { return {&value, 1}; }

bool has(hid_t file, const char* name) { return H5Lexists(file, name, H5P_DEFAULT) > 0; }

Column open_column(hid_t file, const char* name, const fs::path& path) {
  return {hdf5::checked({H5Dopen2(file, name, H5P_DEFAULT), H5Dclose}, path, fmt::format("opening '{}'", name)), path};
}

void check_bead_count(hid_t file, const fs::path& path, std::size_t bead_count) {
  const hsize_t found = open_column(file, "beads/id", path).rows();
  if (found == bead_count) return;
  throw base::UserError(fmt::format("{}: holds {} beads, the checkpoint {}; it belongs to another run: move it away or use another -o",
                                    path.string(), found, bead_count));
}

}  // namespace

struct FrameWriter::Impl {
  explicit Impl(const fs::path& path) : file(path), time(file.column("time")) {}

  GrowingFile file;
  WaitingRows<double> time;
  std::vector<WaitingRows<double>> scalars;         // wall_angle, angular_velocity
  std::vector<WaitingRows<float>> beads;            // kBeadColumns
  std::vector<WaitingRows<double>> ledger;          // wall_work, dissipation: 0 or 1 column each
  std::vector<WaitingRows<std::uint64_t>> impacts;  // 0 or 1 column
  std::vector<WaitingRows<double>> masses;          // 0 or 1 column
  std::size_t bead_count = 0, wall_count = 0, dissipation_count = 0;
  double last_time = 0;
  Clock::time_point last_write{};

  static std::unique_ptr<Impl> open(const fs::path& path, std::size_t bead_count, std::size_t walls, std::size_t dissipations,
                                    bool with_impacts);
  void write_through();
  bool close();
};

std::unique_ptr<FrameWriter::Impl> FrameWriter::Impl::open(const fs::path& path, std::size_t bead_count, std::size_t walls,
                                                           std::size_t dissipations, bool with_impacts) {
  auto impl = std::make_unique<Impl>(path);
  impl->bead_count = bead_count;
  impl->wall_count = walls;
  impl->dissipation_count = dissipations;
  for (const char* name : {"wall_angle", "angular_velocity"}) impl->scalars.emplace_back(impl->file.column(name));
  for (const char* name : kBeadColumns) impl->beads.emplace_back(impl->file.column(name));
  if (walls > 0) impl->ledger.emplace_back(impl->file.column("wall_work"));
  if (dissipations > 0) impl->ledger.emplace_back(impl->file.column("dissipation"));
  if (with_impacts) impl->impacts.emplace_back(impl->file.column("impacts"));
  impl->file.flush();
  return impl;
}

void FrameWriter::Impl::write_through() {
  if (time.waiting() == 0) return;
  hdf5::prepare();
  const auto write = [](auto& columns) {
    for (auto& column : columns) column.write();
  };
  const auto rows = [&] {
    write(beads);
    write(scalars);
    write(masses);
    write(ledger);
    write(impacts);
  };
  file.write_rows(rows, [&] { time.write(); });
  last_write = Clock::now();
}

bool FrameWriter::Impl::close() {
  scalars.clear();
  beads.clear();
  ledger.clear();
  impacts.clear();
  masses.clear();
  time = {};
  return file.close();
}

FrameWriter::FrameWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameWriter::FrameWriter(FrameWriter&&) noexcept = default;
FrameWriter& FrameWriter::operator=(FrameWriter&&) noexcept = default;

FrameWriter::~FrameWriter() {
  if (!impl_) return;
  try {
    impl_->write_through();
  } catch (const std::exception&) {
    // A destructor cannot report; `flush` and `close` do.
  }
  impl_->close();
}

FrameWriter FrameWriter::create(const fs::path& path, const BeadTable& table) {
  const std::size_t count = table.id.size();
  if (count == 0 || table.radius.size() != count || table.mass.size() != count || table.material.size() != count) {
    throw std::logic_error("FrameWriter: the bead table is empty or its arrays differ in length");
  }
  GrowingFile::create(path, [&](hid_t file) { build(file, table, path); });
  if (!table.impact_pairs.empty() && table.impact_edges.size() < 2) throw std::logic_error("FrameWriter: impacts need bins");
  FrameWriter writer(Impl::open(path, count, table.wall_names.size(), table.dissipation_names.size(), !table.impact_pairs.empty()));
  if (table.beads_vary) writer.impl_->masses.emplace_back(writer.impl_->file.column("mass_there"));
  return writer;
}

FrameWriter FrameWriter::resume(const fs::path& path, std::size_t bead_count, double time) {
  std::size_t widths[2] = {0, 0};
  bool with_impacts = false;
  double last_time = 0;
  GrowingFile::reopen(path, [&](hid_t file) {
    hdf5::require_schema(file, path, "millscope frames", kFramesSchema);
    check_bead_count(file, path, bead_count);
    const std::vector<double> times = open_column(file, "time", path).read_doubles();
    const auto kept = static_cast<hsize_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (kept > 0) last_time = times[kept - 1];
    std::vector<const char*> names{"time", "wall_angle", "angular_velocity", "wall_work", "dissipation", "impacts"};
    names.insert(names.end(), kBeadColumns.begin(), kBeadColumns.end());
    for (const char* name : names) {
      if (!has(file, name) && std::string_view("wall_work dissipation impacts").find(name) != std::string_view::npos) continue;
      Column column = open_column(file, name, path);
      column.truncate(kept);
      if (std::string_view(name) == "wall_work") widths[0] = column.row_size();
      if (std::string_view(name) == "dissipation") widths[1] = column.row_size();
      if (std::string_view(name) == "impacts") with_impacts = true;
    }
  });
  FrameWriter writer(Impl::open(path, bead_count, widths[0], widths[1], with_impacts));
  writer.impl_->last_time = last_time;
  return writer;
}

void FrameWriter::append(const FrameView& frame) {
  Impl& f = *impl_;
  const std::size_t size = 3 * f.bead_count;
  if (frame.position.size() != size || frame.velocity.size() != size || frame.spin.size() != size ||
      frame.wall_work.size() != f.wall_count || frame.dissipation.size() != f.dissipation_count ||
      (!f.impacts.empty() && frame.impacts.size() != f.impacts.front().row_size())) {
    throw std::logic_error("FrameWriter: the frame's arrays do not have the lengths of the bead table");
  }
  if (frame_count() > 0 && !(frame.time > f.last_time)) throw std::logic_error("FrameWriter: times must increase");
  require_space(f.file.path(), (f.time.waiting() + 1) * frame_bytes(f.bead_count));  // with those that wait: these still come into the file
  f.beads[0].add(frame.position);
  f.beads[1].add(frame.velocity);
  f.beads[2].add(frame.spin);
  f.scalars[0].add(one(frame.wall_angle));
  f.scalars[1].add(one(frame.angular_velocity));
  if (!f.masses.empty()) f.masses.front().add(one(frame.mass));
  if (f.wall_count > 0) f.ledger.front().add(frame.wall_work);
  if (f.dissipation_count > 0) f.ledger.back().add(frame.dissipation);
  // A file of an earlier version, which is continued, may have no counts of impacts.
  if (!f.impacts.empty()) f.impacts.front().add(frame.impacts);
  f.time.add(one(frame.time));
  f.last_time = frame.time;
  if (f.time.waiting() * frame_bytes(f.bead_count) >= kWaiting || Clock::now() - f.last_write >= kPatience) f.write_through();
}

std::size_t FrameWriter::frame_count() const { return impl_->time.rows(); }

void FrameWriter::flush() {
  impl_->write_through();
  impl_->file.sync();
}

void FrameWriter::close() {
  if (!impl_) return;
  const fs::path path = impl_->file.path();
  flush();
  const bool closed = impl_->close();
  impl_.reset();
  if (!closed) hdf5::fail(path, "closing the file");
}

std::uint64_t frame_bytes(std::size_t bead_count) { return 36 * static_cast<std::uint64_t>(bead_count) + 4096; }

}  // namespace millscope::output
