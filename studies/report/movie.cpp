#include "studies/report/movie.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kernel/base/statistics.hpp"
#include "kernel/config/values.hpp"
#include "kernel/host/objects.hpp"
#include "studies/report/packed.hpp"

namespace millscope::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kBytesPerBead = 7;  // three u16 and a u8
constexpr double kMostPosition = 65535, kMostSpeed = 255;
constexpr double kHighSpeedQuantile = 0.995;  // single fast beads must not darken all others

/// Which frames and beads are shown.
struct Choice {
  std::vector<std::size_t> frames;
  std::size_t stride = 1;  ///< every stride-th bead
  std::size_t beads = 0;
};

Choice choose(std::size_t frames, std::size_t beads, std::uint64_t bytes) {
  Choice c;
  const std::uint64_t most = std::max<std::uint64_t>(bytes / kBytesPerBead, 1);
  c.stride = (beads + most - 1) / most;
  c.beads = (beads + c.stride - 1) / c.stride;
  const std::size_t count = std::clamp<std::size_t>(static_cast<std::size_t>(most / c.beads), 1, frames);
  for (std::size_t i = 0; i < count; ++i) c.frames.push_back(count == 1 ? frames - 1 : i * (frames - 1) / (count - 1));
  return c;
}

/// The chosen beads of the chosen frames, [frames][beads][3].
std::vector<float> gathered(const output::FrameReader& reader, const Choice& choice, output::BeadField field) {
  std::vector<float> all(3 * reader.beads().size()), chosen;
  chosen.reserve(3 * choice.beads * choice.frames.size());
  for (const std::size_t frame : choice.frames) {
    reader.read(field, frame, 1, all);
    for (std::size_t b = 0; b < reader.beads().size(); b += choice.stride)
      for (std::size_t k = 0; k < 3; ++k) chosen.push_back(all[3 * b + k]);
  }
  return chosen;
}

/// 0 where frames were imported that say no velocities.
std::vector<double> speeds_of(const std::vector<float>& velocity) {
  std::vector<double> speed(velocity.size() / 3);
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const double size = std::hypot(double{velocity[3 * i]}, double{velocity[3 * i + 1]}, double{velocity[3 * i + 2]});
    speed[i] = std::isnan(size) ? 0 : size;
  }
  return speed;
}

/// Of the chosen beads those that are in every chosen frame: in frames that were imported others may come and go, at NaN.
std::vector<char> always_there(const std::vector<float>& position, std::size_t beads) {
  std::vector<char> there(beads, 1);
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (std::isnan(position[i])) there[i / 3 % beads] = 0;
  }
  return there;
}

/// values of `width` numbers for each bead, bead after bead, frame after frame: those of the others leave.
template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<char>& there, std::size_t width) {
  std::vector<T> left;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (there[i / width % there.size()] != 0) left.push_back(values[i]);
  }
  return left;
}

double high_of(std::vector<double> speed) { return std::max(base::quantile_below(speed, kHighSpeedQuantile), 1e-9); }

template <class T>
T scaled(double value, double most) {
  return static_cast<T>(std::lround(std::clamp(value, 0.0, 1.0) * most));
}

}  // namespace

Json movie_of(const output::FrameReader& reader, std::uint64_t bytes) {
  if (reader.frame_count() == 0 || reader.beads().size() == 0) return nullptr;
  const Choice choice = choose(reader.frame_count(), reader.beads().size(), bytes);
  const std::vector<float> gathered_places = gathered(reader, choice, output::BeadField::position);
  const std::vector<char> there = always_there(gathered_places, choice.beads);
  const auto shown = static_cast<std::size_t>(std::count(there.begin(), there.end(), 1));
  if (shown == 0) return nullptr;
  const std::vector<float> position = kept(gathered_places, there, 3);
  const std::vector<double> speed = kept(speeds_of(gathered(reader, choice, output::BeadField::velocity)), there, 1);
  std::array<double, 3> low{}, high{};
  for (std::size_t k = 0; k < 3; ++k) {
    low[k] = high[k] = double{position[k]};
    for (std::size_t i = k; i < position.size(); i += 3) {
      low[k] = std::min(low[k], double{position[i]});
      high[k] = std::max(high[k], double{position[i]});
    }
    if (!(high[k] > low[k])) high[k] = low[k] + 1e-6;
  }
  std::vector<std::uint16_t> places(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    places[i] = scaled<std::uint16_t>((double{position[i]} - low[i % 3]) / (high[i % 3] - low[i % 3]), kMostPosition);
  }
  const double fastest = high_of(speed);
  std::vector<std::uint8_t> shades(speed.size());
  std::transform(speed.begin(), speed.end(), shades.begin(), [&](double v) { return scaled<std::uint8_t>(v / fastest, kMostSpeed); });
  std::vector<float> radius;
  for (std::size_t b = 0; b < reader.beads().size(); b += choice.stride) radius.push_back(static_cast<float>(reader.beads().radius[b]));
  radius = kept(radius, there, 1);
  Json times = Json::array(), angles = Json::array();
  for (const std::size_t frame : choice.frames) {
    times.push_back(reader.scalars().time[frame]);
    angles.push_back(reader.scalars().wall_angle[frame]);
  }
  return {{"frames", choice.frames.size()},
          {"beads", shown},
          {"beads_left_out", reader.beads().size() - shown},
          {"time_s", times},
          {"wall_angle_rad", angles},
          {"low_m", low},
          {"high_m", high},
          {"speed_high_m_per_s", fastest},
          {"radius_m", packed<float>(radius)},
          {"position", packed<std::uint16_t>(places)},
          {"speed", packed<std::uint8_t>(shades)}};
}

Json liner_of(const config::Case& c, const host::Registry& registry, Json& notes) {
  Json bodies = Json::array();
  for (const config::GeometryCase& g : c.geometry) {
    const host::Loaded& plugin = registry.find(Kind::geometry, g.plugin.kind, g.plugin.where);
    const config::ResolvedValues values = config::resolve(*plugin.descriptor, g.plugin.node, Scope::instance);
    const auto object = host::GeometryObject::create(plugin, values.view(), g.plugin.where);
    Surface surface{};
    object.table().surface(object.self(), &surface);
    if (surface.triangle_count == 0) continue;
    const auto& turning = g.motion.rotation;
    const bool turns = turning && turning->follows_mill && turning->axis == config::Vector3{0, 0, 1};
    if (!turns && (turning || g.motion.translation)) {
      notes.push_back(fmt::format("'{}' is drawn where it starts: it moves otherwise than the mill turns", g.plugin.name));
    }
    const std::vector<float> vertices(surface.vertices, surface.vertices + 3 * surface.vertex_count);
    bodies.push_back({{"name", g.plugin.name},
                      {"turns", turns},
                      {"vertices_m", packed<float>(vertices)},
                      {"triangles", packed<std::uint32_t>({surface.triangles, static_cast<std::size_t>(3 * surface.triangle_count)})}});
  }
  if (bodies.empty()) return nullptr;
  return {{"bodies", bodies}};
}

}  // namespace millscope::report
