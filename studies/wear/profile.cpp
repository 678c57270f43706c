#include "studies/wear/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "kernel/run/faces_round.hpp"

namespace millscope::wear {
namespace {

using base::UserError;

constexpr int kLook = 7200;  // directions in which the pitches are counted
constexpr int kMostPitches = 120, kSmoothPitches = 60;
constexpr double kFlat = 1e-3;                      // of the radius: relief of a shell without lifters
constexpr double kAlike = 0.02;                     // of the relief: how well pitches repeat
constexpr double kBeside = 3e-4;                    // of a row, beside its middle: rows of vertices may stand there
constexpr double kWholeFace = 0.9, kNoFace = 0.01;  // of the cross-section

void require_axis(const Interior& in, const std::string& name) {
  const double off = std::hypot(in.axis_point[0], in.axis_point[1]);
  if (in.is_bounded != 0 && in.is_cylinder != 0 && std::fabs(in.axis[2]) > 1 - 1e-6 && off < 1e-3 * in.radius) return;
  throw UserError(fmt::format("geometry.{}: wear wants a mill round the z axis; give the mesh 'axis: auto' and 'centre: true'", name));
}

/// Distances in `directions` at z; throws where nothing is seen.
std::vector<run::Facing> look_round(const Surface& s, const Interior& in, double z, int directions, const std::string& name) {
  std::vector<run::Facing> all = run::faces_round(s, in, z, directions);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (std::isfinite(all[k].distance)) continue;
    throw UserError(fmt::format("geometry.{}: no wall at z = {:.6g} m in the direction of {:.4g} deg; wear wants a liner without holes",
                                name, z, 360.0 * static_cast<double>(k) / directions));
  }
  return all;
}

/// Root mean square of r(θ + 2π/n) − r(θ).
double unlike(const std::vector<run::Facing>& r, int n) {
  const auto count = static_cast<double>(r.size());
  double sum = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double to = static_cast<double>(k) + count / n;
    const auto low = static_cast<std::size_t>(to);
    const double part = to - static_cast<double>(low);
    const double there = (1 - part) * r[low % r.size()].distance + part * r[(low + 1) % r.size()].distance;
    sum += (there - r[k].distance) * (there - r[k].distance);
  }
  return std::sqrt(sum / count);
}

double relief_of(const std::vector<run::Facing>& r) {
  const auto [low, high] = std::minmax_element(r.begin(), r.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return high->distance - low->distance;
}

int pitches_of(const std::vector<run::Facing>& r, double radius, int asked, const std::string& name) {
  const double relief = relief_of(r);
  if (asked > 0) {
    const double off = unlike(r, asked);
    if (relief <= kFlat * radius || off <= kAlike * relief) return asked;
    throw UserError(
        fmt::format("geometry.{}: it does not repeat {} times in a turn: the pitches differ by {:.3g} mm; give another --pitches, or 1",
                    name, asked, 1e3 * off));
  }
  if (relief <= kFlat * radius) return kSmoothPitches;
  for (int n = kMostPitches; n > 1; --n) {
    if (unlike(r, n) <= kAlike * relief) return n;
  }
  return 1;
}

/// The part of the cross-section that flat triangles close at the end `z`; `slot` gets theirs.
double closed_part(const Surface& s, double z, double radius, double tolerance, std::uint32_t& slot) {
  double area = 0;
  for (std::uint64_t t = 0; t < s.triangle_count; ++t) {
    std::array<const double*, 3> v{};
    bool flat = true;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = s.vertices + 3 * static_cast<std::uint64_t>(s.triangles[3 * t + k]);
      flat = flat && std::fabs(v[k][2] - z) < tolerance;
    }
    if (!flat) continue;
    area += 0.5 * std::fabs((v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]));
    slot = s.triangle_materials[t];
  }
  return area / (std::numbers::pi * radius * radius);
}

bool has_face(const Surface& s, double z, const Profile& p, std::uint32_t& slot, const std::string& name) {
  double mean_square = 0;
  for (const double r : p.radius) mean_square += r * r / static_cast<double>(p.radius.size());
  const double part = closed_part(s, z, std::sqrt(mean_square), 1e-6 * (p.high - p.low), slot);
  if (part < kNoFace) return false;
  if (part > kWholeFace) return true;
  throw UserError(fmt::format(
      "geometry.{}: its end at z = {:.6g} m is {:.0f} % closed; wear wants an end that is open or a whole flat face", name, z, 100 * part));
}

void add_row(Profile& p, std::size_t row, const std::vector<run::Facing>& seen, const Surface& s) {
  const auto pitches = static_cast<std::size_t>(p.pitches);
  for (std::size_t c = 0; c < p.columns; ++c) {
    for (std::size_t k = 0; k < pitches; ++k) p.at(row, c) += seen[2 * (c + k * p.columns)].distance / static_cast<double>(pitches);
    if (row == 0) p.material.push_back(s.triangle_materials[seen[2 * c + 1].triangle]);
  }
}

}  // namespace

double Profile::step() const { return kTurn / (static_cast<double>(pitches) * static_cast<double>(columns)); }

std::vector<double> Profile::mean_row() const {
  std::vector<double> mean(columns, 0.0);
  for (std::size_t i = 0; i < radius.size(); ++i) mean[i % columns] += radius[i] / static_cast<double>(rows);
  return mean;
}

double Profile::relief() const {
  const std::vector<double> mean = mean_row();
  const auto [low, high] = std::minmax_element(mean.begin(), mean.end());
  return *high - *low;
}

Profile profile_of(const Surface& surface, const Interior& in, const Resolution& resolution, const std::string& name) {
  require_axis(in, name);
  Profile p;
  p.low = p.high = surface.vertices[2];
  for (std::uint64_t v = 0; v < surface.vertex_count; ++v) {
    p.low = std::min(p.low, surface.vertices[3 * v + 2]);
    p.high = std::max(p.high, surface.vertices[3 * v + 2]);
  }
  p.rows = resolution.rows;
  const auto middle_of = [&p](std::size_t row) { return p.low + (static_cast<double>(row) + 0.5 + kBeside) * p.row_length(); };
  p.pitches = pitches_of(look_round(surface, in, middle_of(p.rows / 2), kLook, name), in.radius, resolution.pitches, name);
  p.columns = static_cast<std::size_t>(std::max(8.0, std::ceil(kTurn * in.radius / (p.pitches * resolution.cell))));
  p.radius.assign(p.rows * p.columns, 0.0);
  const int directions = 2 * p.pitches * static_cast<int>(p.columns);
  for (std::size_t row = 0; row < p.rows; ++row) add_row(p, row, look_round(surface, in, middle_of(row), directions, name), surface);
  p.low_face = has_face(surface, p.low, p, p.face_material, name);
  p.high_face = has_face(surface, p.high, p, p.face_material, name);
  return p;
}

}  // namespace millscope::wear
