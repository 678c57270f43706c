#include "studies/calibrate/bead_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "kernel/config/case.hpp"
#include "kernel/output/directory.hpp"
#include "kernel/output/frame_reader.hpp"
#include "studies/camera/camera.hpp"

namespace millscope::calibrate {
namespace {

using base::UserError;

constexpr std::size_t kAtOnce = 1 << 14;  // numbers that are read together

/// At most `wished` of those that may be followed.
std::vector<std::size_t> evenly(const output::FrameBeads& beads, const config::Case& c, int wished) {
  std::vector<std::size_t> all;
  for (std::size_t b = 0; b < beads.size(); ++b) {
    if (c.may_be_followed(beads.radius[b], beads.mass[b])) all.push_back(b);
  }
  const std::size_t n = std::min(all.size(), static_cast<std::size_t>(wished));
  std::vector<std::size_t> chosen(n);
  for (std::size_t i = 0; i < n; ++i) chosen[i] = all[i * all.size() / n];
  return chosen;
}

/// Σ m x of the charge that a recorded mill has, N beads like those beside the tracers, over that of the beads as they are. A bead like
/// which there are in both is of either by their numbers.
double lever_ratio(const output::FrameBeads& beads, const config::Case& c, const std::vector<double>& sum_x) {
  double all = 0, others = 0, count = 0;
  for (std::size_t b = 0; b < beads.size(); ++b) {
    all += beads.mass[b] * sum_x[b];
    const double part = 1 - c.tracer_part(beads.radius[b], beads.mass[b]);
    others += part * beads.mass[b] * sum_x[b];
    count += part;
  }
  // No bead beside the tracers: each is as good as every other.
  return count > 0 && all != 0 ? others * static_cast<double>(beads.size()) / count / all : 1.0;
}

}  // namespace

BeadPaths::BeadPaths(const std::filesystem::path& run, int beads, const AxialPlace& place, const host::Registry& registry)
    : case_file_(run / output::kResolvedCase), mill_(analysis::read_mill_of_case(case_file_, registry)), place_(place) {
  const output::FrameReader reader(run / "frames.h5");
  const config::Case c = config::read_case(case_file_.string());
  const double from = c.time.analyze_from;
  const std::vector<double>& time = reader.scalars().time;
  const auto first = static_cast<std::size_t>(
      std::lower_bound(time.begin(), time.begin() + static_cast<std::ptrdiff_t>(reader.frame_count()), from - 1e-9) - time.begin());
  const std::size_t frames = reader.frame_count() - first;
  if (frames < 4)
    throw UserError(
        fmt::format("{}: has {} frames after {} s, at least 4 are needed; simulate longer", reader.path().string(), frames, from));
  time_.assign(time.begin() + static_cast<std::ptrdiff_t>(first), time.begin() + static_cast<std::ptrdiff_t>(first + frames));
  const std::vector<std::size_t> chosen = evenly(reader.beads(), c, beads);
  if (chosen.empty())
    throw UserError(fmt::format("{}: no bead is of a class with 'tracer: true'; give such a class a larger share", reader.path().string()));
  for (const std::size_t b : chosen) {
    ids_.push_back(reader.beads().id[b]);
    radius_.push_back(reader.beads().radius[b]);
  }
  const std::size_t row = reader.beads().size() * 3, together = std::min(frames, kAtOnce / row + 1);
  std::vector<float> rows(together * row);
  std::vector<double> sum_x(c.has_tracers() ? reader.beads().size() : 0);  // of all beads, where some are set apart
  const auto load = [&](output::BeadField field, std::vector<float>& values) {
    values.resize(frames * chosen.size() * 3);
    for (std::size_t f = 0; f < frames; ++f) {
      const float* const all = rows.data() + f % together * row;
      if (const std::size_t count = std::min(together, frames - f); f % together == 0)
        reader.read(field, first + f, count, std::span(rows).first(count * row));
      for (std::size_t b = 0; field == output::BeadField::position && b < sum_x.size(); ++b) sum_x[b] += static_cast<double>(all[3 * b]);
      for (std::size_t i = 0; i < chosen.size(); ++i)
        std::copy_n(all + 3 * chosen[i], 3, values.begin() + static_cast<std::ptrdiff_t>((i * frames + f) * 3));
    }
  };
  load(output::BeadField::position, position_);
  load(output::BeadField::velocity, velocity_);
  if (c.has_tracers()) lever_ratio_ = lever_ratio(reader.beads(), c, sum_x);
}

output::TrackSamples BeadPaths::path(std::size_t i, double step) const {
  const auto at = [&](const std::vector<float>& values, std::size_t frame, std::size_t axis) {
    return static_cast<double>(values[(i * time_.size() + frame) * 3 + axis]);
  };
  double shift = 0;  // along z, by whole periods
  if (mill_.period > 0 && place_.high - place_.low > mill_.period) {
    const double room = place_.high - place_.low - mill_.period;
    shift = place_.low - mill_.context.mill_low + room * (static_cast<double>(i) + 0.5) / static_cast<double>(ids_.size());
  }
  output::TrackSamples track;
  const auto points = static_cast<std::size_t>((time_.back() - time_.front()) / step * 1.1) + time_.size();
  track.time.reserve(points);
  for (auto& values : track.position) values.reserve(points);
  for (std::size_t f = 0; f + 1 < time_.size(); ++f) {
    const double h = time_[f + 1] - time_[f];
    const int parts = std::max(1, static_cast<int>(std::ceil(h / step - 0.01)));
    const double jump = mill_.period > 0 ? mill_.period * std::round((at(position_, f + 1, 2) - at(position_, f, 2)) / mill_.period) : 0.0;
    const double part = 1.0 / parts;
    for (int k = 0; k < parts; ++k) track.time.push_back(time_[f] + k * part * h);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double from = at(position_, f, axis) + (axis == 2 ? shift : 0.0),
                   to = at(position_, f + 1, axis) + (axis == 2 ? shift - jump : 0.0);
      const double way = to - from, begin = h * at(velocity_, f, axis), end = h * at(velocity_, f + 1, axis);
      const double square = 3 * way - 2 * begin - end, cube = begin + end - 2 * way;
      for (int k = 0; k < parts; ++k) {
        const double s = k * part;
        track.position[axis].push_back(from + s * (begin + s * (square + s * cube)));
      }
    }
    shift -= jump;
  }
  return track;
}

TrackContext BeadPaths::context(std::size_t i, std::uint64_t seed) const {
  const bool part = mill_.period > 0 && place_.high - place_.low > mill_.period;
  TrackContext context{};
  context.seed = camera::bead_seed(seed, ids_[i]);
  context.bead_radius = radius_[i];
  context.mill_radius = mill_.context.mill_radius;
  const double half = 0.5 * (place_.high - place_.low);
  context.mill_low = part ? place_.middle - half : mill_.context.mill_low;
  context.mill_high = part ? place_.middle + half : mill_.context.mill_high;
  context.omega = mill_.context.omega;
  context.period = part ? place_.high - place_.low : mill_.period;
  return context;
}

}  // namespace millscope::calibrate
