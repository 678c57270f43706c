#include "studies/wear/worn_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace millscope::wear {
namespace {

constexpr std::size_t kMostParts = 64;
constexpr double kReach = 4;  // deviations of the Gaussian that count

double distance(const Place& a, const Place& b) { return std::hypot(b.x - a.x, b.y - a.y); }

/// Radius at the border between two rows, where the triangles have their vertices.
Profile at_borders(const Profile& p) {
  Profile b = p;
  b.rows = p.rows + 1;
  b.radius.assign(b.rows * b.columns, 0.0);
  for (std::size_t j = 0; j < b.rows; ++j) {
    const bool inside = 0 < j && j < p.rows;
    const std::size_t below = inside ? j - 1 : p.periodic || j > 0 ? p.rows - 1 : 0;
    const std::size_t above = inside ? j : p.periodic || j == 0 ? 0 : p.rows - 1;
    for (std::size_t c = 0; c < p.columns; ++c) b.at(j, c) = 0.5 * (p.at(below, c) + p.at(above, c));
  }
  return b;
}

void add_triangle(Mesh& m, std::size_t a, std::size_t b, std::size_t c, std::uint32_t material) {
  for (const std::size_t v : {a, b, c}) m.triangles.push_back(static_cast<std::uint32_t>(v));
  m.materials.push_back(material);
}

/// One ring of vertices at z: all stretches of all pitches.
void add_ring(Mesh& m, const Profile& borders, const Stretches& s, std::size_t row, double z) {
  for (int pitch = 0; pitch < borders.pitches; ++pitch) {
    const double turn = kTurn * pitch / borders.pitches, cosine = std::cos(turn), sine = std::sin(turn);
    for (std::size_t c = 0; c < borders.columns; ++c) {
      for (std::size_t part = 0; part < s.parts[c]; ++part) {
        const Place at = place_of(borders, row, c, static_cast<double>(part) / static_cast<double>(s.parts[c]));
        m.vertices.insert(m.vertices.end(), {cosine * at.x - sine * at.y, sine * at.x + cosine * at.y, z});
      }
    }
  }
}

/// A fan from the axis to the ring that begins at vertex `ring`.
void add_face(Mesh& m, const Profile& p, std::size_t ring, std::size_t count, bool upper) {
  const std::size_t centre = m.vertices.size() / 3;
  m.vertices.insert(m.vertices.end(), {0.0, 0.0, upper ? p.high : p.low});
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t here = ring + k, next = ring + (k + 1) % count;
    upper ? add_triangle(m, centre, next, here, p.face_material[1]) : add_triangle(m, centre, here, next, p.face_material[0]);
  }
}

/// Numbers that stand one behind the other: each at the middle of its length.
struct Line {
  std::vector<double> place, length;
  double whole = 0;
  bool closed;  ///< its end joins its beginning; else it ends there, and nothing leaves it
};

Line line_of(std::vector<double> length, bool closed) {
  Line line{{}, std::move(length), 0, closed};
  for (const double l : line.length) {
    line.place.push_back(line.whole + 0.5 * l);
    line.whole += l;
  }
  return line;
}

/// What reaches `to` from `from`, round the line as often as the Gaussian goes. At an end it comes back, so that an even loss stays even.
double share_of(const Line& line, std::size_t from, std::size_t to, double deviation) {
  const auto gaussian = [&](double away) {
    return std::fabs(away) > kReach * deviation ? 0.0 : std::exp(-0.5 * away * away / (deviation * deviation));
  };
  const double a = line.place[from], b = line.place[to], period = line.closed ? line.whole : 2 * line.whole;
  const auto times = static_cast<int>(std::ceil(kReach * deviation / period)) + 1;
  double sum = 0;
  for (int n = -times; n <= times; ++n) {
    sum += gaussian(b - a + n * period);
    if (!line.closed) sum += gaussian(a + b + n * period);
  }
  return line.length[to] * sum;
}

/// Spreads the numbers over the line; their sum stays.
void spread(std::vector<double>& values, const Line& line, double deviation) {
  const std::size_t n = values.size();
  std::vector<double> out(n, 0.0), weight(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!(values[i] > 0)) continue;
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += weight[j] = share_of(line, i, j, deviation);
    for (std::size_t j = 0; j < n; ++j) out[j] += values[i] * weight[j] / sum;
  }
  values = out;
}

}  // namespace

Stretches stretches_of(const Profile& p) {
  Stretches s{std::vector<std::size_t>(p.columns, 1), {0}};
  double radius = 0;
  for (const double r : p.radius) radius += r / static_cast<double>(p.radius.size());
  const double cell = p.step() * radius;
  for (std::size_t c = 0; c < p.columns; ++c) {
    for (std::size_t row = 0; row < p.rows; ++row) {
      const double length = distance(place_of(p, row, c, 0), place_of(p, row, c, 1));
      s.parts[c] = std::max(s.parts[c], std::min(kMostParts, static_cast<std::size_t>(std::lround(length / cell))));
    }
    s.first.push_back(s.first.back() + s.parts[c]);
  }
  return s;
}

Place place_of(const Profile& p, std::size_t row, std::size_t column, double share) {
  const double a = p.step() * static_cast<double>(column), b = p.step() * static_cast<double>(column + 1);
  const double from = (1 - share) * p.at(row, column), to = share * p.at(row, column + 1);
  return {from * std::cos(a) + to * std::cos(b), from * std::sin(a) + to * std::sin(b)};
}

std::vector<double> lengths_of(const Profile& p, const Stretches& s, std::size_t row) {
  std::vector<double> all;
  for (std::size_t c = 0; c < p.columns; ++c) {
    const double chord = distance(place_of(p, row, c, 0), place_of(p, row, c, 1));
    all.insert(all.end(), s.parts[c], chord / static_cast<double>(s.parts[c]));
  }
  return all;
}

Surface Mesh::surface() const { return {vertices.size() / 3, vertices.data(), materials.size(), triangles.data(), materials.data()}; }

Mesh mesh_of(const Profile& p, const Stretches& s) {
  Mesh m;
  const Profile borders = at_borders(p);
  const std::size_t ring = static_cast<std::size_t>(p.pitches) * s.count();
  for (std::size_t j = 0; j <= p.rows; ++j) {
    const double z = j == p.rows ? p.high : p.low + static_cast<double>(j) * p.row_length();
    add_ring(m, borders, s, j, z);
  }
  for (std::size_t row = 0; row < p.rows; ++row) {
    for (std::size_t k = 0; k < ring; ++k) {
      const std::size_t column =
          static_cast<std::size_t>(std::upper_bound(s.first.begin(), s.first.end(), k % s.count()) - s.first.begin()) - 1;
      const std::size_t next = (k + 1) % ring, low = row * ring, high = low + ring;
      add_triangle(m, low + k, high + next, low + next, p.material[column]);
      add_triangle(m, low + k, high + k, high + next, p.material[column]);
    }
  }
  if (p.low_face) add_face(m, p, 0, ring, false);
  if (p.high_face) add_face(m, p, p.rows * ring, ring, true);
  return m;
}

Spot spot_of(std::span<const double> vertices, const std::uint32_t* corners, const Profile& p) {
  double centre[3] = {0, 0, 0}, lowest = p.high, highest = p.low;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* v = vertices.data() + std::size_t{3} * corners[k];
    for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] += v[axis] / 3;
    lowest = std::min(lowest, v[2]), highest = std::max(highest, v[2]);
  }
  if (highest - lowest < 1e-3 * p.row_length()) return {.on_face = true};
  const auto index_in = [](double place, std::size_t count) { return std::min(static_cast<std::size_t>(std::max(place, 0.0)), count - 1); };
  const double turned = std::atan2(centre[1], centre[0]), pitch_angle = kTurn / p.pitches, angle = turned < 0 ? turned + kTurn : turned;
  const std::size_t pitch = index_in(angle / pitch_angle, static_cast<std::size_t>(p.pitches));
  const double across = (angle - static_cast<double>(pitch) * pitch_angle) / p.step();
  const std::size_t column = index_in(across, p.columns);
  return {false, pitch, index_in((centre[2] - p.low) / p.row_length(), p.rows), column,
          std::clamp(across - static_cast<double>(column), 0.0, 1.0)};
}

Loss loss_of(const run::WornSurface& worn, const Profile& p, const Stretches& s) {
  Loss loss;
  loss.of_pitch.assign(static_cast<std::size_t>(p.pitches), std::vector<double>(p.rows * s.count(), 0.0));
  for (std::size_t t = 0; t < worn.worn.size(); ++t) {
    const double rate = worn.worn[t] / worn.time;
    const Spot at = spot_of(worn.vertices, &worn.triangles[3 * t], p);
    if (at.on_face) {
      loss.faces += rate;
      continue;
    }
    const std::size_t parts = s.parts[at.column];
    const std::size_t part = std::min(static_cast<std::size_t>(at.share * static_cast<double>(parts)), parts - 1);
    loss.of_pitch[at.pitch][at.row * s.count() + s.first[at.column] + part] += rate;
  }
  return loss;
}

void smooth(std::vector<double>& loss, const Profile& p, const Stretches& s, double length) {
  const std::size_t n = s.count();
  for (std::size_t row = 0; row < p.rows; ++row) {
    const auto first = loss.begin() + static_cast<std::ptrdiff_t>(row * n);
    std::vector<double> values(first, first + static_cast<std::ptrdiff_t>(n));
    spread(values, line_of(lengths_of(p, s, row), true), length);
    std::copy(values.begin(), values.end(), first);
  }
  if (p.rows == 1) return;
  const Line along = line_of(std::vector<double>(p.rows, p.row_length()), p.periodic);
  std::vector<double> values(p.rows);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t row = 0; row < p.rows; ++row) values[row] = loss[row * n + k];
    spread(values, along, length);
    for (std::size_t row = 0; row < p.rows; ++row) loss[row * n + k] = values[row];
  }
}

}  // namespace millscope::wear
