#include "studies/wear/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"

namespace millscope::wear {
namespace {

using base::UserError;

constexpr int kLook = 7200;  // directions in which the pitches are counted
constexpr int kMostPitches = 120, kSmoothPitches = 60;
constexpr double kFlat = 1e-3;                      // of the radius: relief of a shell without lifters
constexpr double kAlike = 0.02;                     // of the relief: less is the same place
constexpr double kOddDirections = 0.04;             // upright faces may be seen at their foot or at their top
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

/// The share of directions in which two looks differ by more than a small part of the relief.
double unlike(const std::vector<run::Facing>& a, const std::vector<run::Facing>& b, std::size_t turned, double relief) {
  std::size_t off = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    off += std::fabs(a[k].distance - b[(k + turned) % b.size()].distance) > kAlike * relief ? 1 : 0;
  return static_cast<double>(off) / static_cast<double>(a.size());
}

double relief_of(const std::vector<run::Facing>& r) {
  const auto [low, high] = std::minmax_element(r.begin(), r.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  return high->distance - low->distance;
}

/// Looked at in a multiple of n directions, so that a pitch is a whole number of them.
bool repeats(const Surface& s, const Interior& in, double z, int n, double relief) {
  const int each = (kLook + n - 1) / n;
  const std::vector<run::Facing> seen = run::faces_round(s, in, z, n * each);
  return unlike(seen, seen, static_cast<std::size_t>(each), relief) <= kOddDirections;
}

int pitches_of(const Surface& s, const Interior& in, double z, int asked, const std::string& name) {
  const double relief = relief_of(look_round(s, in, z, kLook, name));
  const bool smooth = relief <= kFlat * in.radius;
  if (asked > 0) {
    if (smooth || repeats(s, in, z, asked, relief)) return asked;
    throw UserError(fmt::format("geometry.{}: it does not repeat {} times in a turn; give another --pitches, or 1", name, asked));
  }
  if (smooth) return kSmoothPitches;
  for (int n = kMostPitches; n > 1; --n) {
    if (repeats(s, in, z, n, relief)) return n;
  }
  return 1;
}

/// One row stands for all of the mill only where the liner is the same along it.
void require_straight(const Surface& s, const Interior& in, const Profile& p, const std::string& name) {
  if (p.rows > 1) return;
  const auto look = [&](double share) { return look_round(s, in, p.low + share * (p.high - p.low), kLook, name); };
  const std::vector<run::Facing> middle = look(0.5 + kBeside);
  const double relief = std::max(relief_of(middle), kFlat * in.radius);
  for (const double share : {0.2, 0.8}) {
    if (unlike(middle, look(share + kBeside), 0, relief) <= kOddDirections) continue;
    throw UserError(fmt::format(
        "geometry.{}: it is not the same along the mill, as helical lifters and bolt holes are not; give --rows, e.g. 8", name));
  }
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
  p.periodic = resolution.period.has_value();
  if (p.periodic) p.low = (*resolution.period)[0], p.high = (*resolution.period)[1];
  const auto middle_of = [&p](std::size_t row) { return p.low + (static_cast<double>(row) + 0.5 + kBeside) * p.row_length(); };
  p.pitches = pitches_of(surface, in, middle_of(p.rows / 2), resolution.pitches, name);
  require_straight(surface, in, p, name);
  p.columns = static_cast<std::size_t>(std::max(8.0, std::ceil(kTurn * in.radius / (p.pitches * resolution.cell))));
  p.radius.assign(p.rows * p.columns, 0.0);
  const int directions = 2 * p.pitches * static_cast<int>(p.columns);
  for (std::size_t row = 0; row < p.rows; ++row) add_row(p, row, look_round(surface, in, middle_of(row), directions, name), surface);
  if (p.periodic) return p;
  p.low_face = has_face(surface, p.low, p, p.face_material[0], name);
  p.high_face = has_face(surface, p.high, p, p.face_material[1], name);
  return p;
}

}  // namespace millscope::wear
