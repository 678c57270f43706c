#include "studies/frames/beads.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <numbers>

#include "kernel/output/file.hpp"

namespace millscope::frames {

std::string material_name(long long type) { return "type_" + std::to_string(type); }
namespace {

template <class T>
void write(std::fstream& stream, const std::vector<T>& values) {
  const std::uint64_t count = values.size();
  stream.write(reinterpret_cast<const char*>(&count), sizeof count);
  stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

template <class T>
void read(std::fstream& stream, std::vector<T>& values) {
  std::uint64_t count = 0;
  stream.read(reinterpret_cast<char*>(&count), sizeof count);
  values.resize(count);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

}  // namespace

Spool::Spool(const std::filesystem::path& file)
    : file_(file), stream_(file, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc) {
  if (!stream_) output::throw_write_error(file_, errno);
}

Spool::~Spool() {
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void Spool::add(const Beads& beads) {
  output::require_space(file_, beads.size() * 80);
  places_.push_back(stream_.tellp());
  times_.push_back(beads.time);
  write(stream_, beads.id);
  write(stream_, beads.position);
  write(stream_, beads.velocity);
  write(stream_, beads.spin);
  stream_.flush();
  if (!stream_) output::throw_write_error(file_, errno);
}

void Spool::read(std::size_t frame, Beads& beads) {
  stream_.seekg(places_.at(frame));
  beads.time = times_[frame];
  frames::read(stream_, beads.id);
  frames::read(stream_, beads.position);
  frames::read(stream_, beads.velocity);
  frames::read(stream_, beads.spin);
  if (!stream_) output::throw_write_error(file_, EIO);
}

double BeadKind::mass() const { return density * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3); }

std::size_t Census::row(std::uint32_t id, bool& known) {
  const auto [at, added] = rows_.emplace(id, beads_.size());
  known = !added;
  if (added) beads_.push_back({.id = id});
  return at->second;
}

void Census::sort() {
  std::sort(beads_.begin(), beads_.end(), [](const BeadKind& a, const BeadKind& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < beads_.size(); ++i) rows_[beads_[i].id] = i;
}

}  // namespace millscope::frames
