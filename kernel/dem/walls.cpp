// Beads at the walls: candidates at each list rebuild, contacts in each step.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/config/error.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

constexpr std::int64_t kBeadsPerQuery = kBatch / kMaxWallContacts;

using Row = std::array<double, 3>;

Row to_body(const Pose& p, const Row& x) {
  const Row d{x[0] - p.offset[0], x[1] - p.offset[1], x[2] - p.offset[2]};
  Row r{};
  for (std::size_t a = 0; a < 3; ++a) r[a] = p.rotation[0][a] * d[0] + p.rotation[1][a] * d[1] + p.rotation[2][a] * d[2];
  return r;
}

Row to_world(const Pose& p, const Row& n) {
  Row r{};
  for (std::size_t a = 0; a < 3; ++a) r[a] = p.rotation[a][0] * n[0] + p.rotation[a][1] * n[1] + p.rotation[a][2] * n[2];
  return r;
}

Row cross(const Row& a, const Row& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double dot(const Row& a, const Row& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Centre of a bead. Periodic coordinates are wrapped at list rebuilds only: wrapped here, a bead that crosses the boundary would jump away
/// from the features that were listed for it. A surface must therefore reach a skin beyond the box (mesh: `period`).
Row centre(const PositionLine& x) { return {x.x, x.y, x.z}; }

struct CarriedContact {
  std::uint32_t bead, feature;  // bead: new index
  Row normal;
  std::vector<double> history;
};

/// The last contact of a bead with this feature whose normal is nearest; −1: a new contact. It is used up.
std::ptrdiff_t take_match(WallContacts& old, std::size_t& cursor, std::uint32_t bead, std::uint32_t feature, const Row& normal) {
  while (cursor < old.bead.size() && old.bead[cursor] < bead) ++cursor;
  std::ptrdiff_t best = -1;
  double best_dot = -2;
  for (std::size_t q = cursor; q < old.bead.size() && old.bead[q] == bead; ++q) {
    if (old.feature[q] != feature) continue;
    const double d = dot(old.normal[q], normal);
    if (d > best_dot) {
      best_dot = d;
      best = static_cast<std::ptrdiff_t>(q);
    }
  }
  if (best >= 0) old.feature[static_cast<std::size_t>(best)] = std::numeric_limits<std::uint32_t>::max();
  return best;
}

}  // namespace

void WallContacts::clear() { resize(0); }

void WallContacts::resize(std::size_t n) {
  bead.resize(n);
  feature.resize(n);
  normal.resize(n);
  for (auto& h : history) h.resize(n);
}

/// Rewrites the bead of each lasting contact as its new index; the near lists are made anew after this.
void System::extract_wall_history() {
  for (const auto& slab : slabs_) {
    for (WallSlab& wall : slab->walls) {
      for (std::uint32_t& b : wall.active.bead) b = new_index_[wall.bead[b]];
    }
  }
}

/// Asks every geometry for the features near each bead, and hands the lasting contacts to the slabs that own the beads now.
void System::build_walls() {
  const std::int64_t n = particles.count();
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> near;
  // reaches_ holds half of the laws' reach, for two beads share it; a wall has none of its own.
  double law_reach = 0;
  for (const PairPhysics& p : physics_) law_reach = std::max(law_reach, p.reach);
  wall_speed_ = 0;
  for (const Body& body : bodies) {
    const double rotation = std::abs(body.motion.speed) * (1 + std::abs(body.motion.ripple_amplitude));
    double translation = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      translation += std::abs(body.motion.velocity[a]) +
                     std::abs(body.motion.oscillation_amplitude[a]) * 6.2831853071795865 * body.motion.oscillation_frequency;
    }
    wall_speed_ = std::max(wall_speed_, rotation * body.greatest_distance + translation);
  }
  // The walls may move this far before the lists must be made anew.
  wall_moved_ = 0;
  wall_margin_ = wall_speed_ * 1.1 * settings_.skin_steps * settings_.time_step;
  for (std::size_t body_index = 0; body_index < bodies.size(); ++body_index) {
    const Body& body = bodies[body_index];
    const Pose pose = pose_at(body.motion, time());
    workers_->run(settings_.partitions, [&](int slab, int) {
      for (std::size_t k = static_cast<std::size_t>(slab_begin(slab)); k < static_cast<std::size_t>(slab_begin(slab + 1)); ++k) {
        const Row x = to_body(pose, centre(particles.position[k]));
        for (std::size_t a = 0; a < 3; ++a) wall_coordinates_[a][k] = x[a];
        wall_coordinates_[3][k] = reaches_[k].radius + 0.5 * law_reach;
      }
    });
    const GeometryBeads beads{
        n, {wall_coordinates_[0].data(), wall_coordinates_[1].data(), wall_coordinates_[2].data()}, wall_coordinates_[3].data()};
    near.clear();
    const CandidateSink sink{&near, [](void* host, std::int64_t bead, std::uint32_t feature) {
                               static_cast<decltype(near)*>(host)->emplace_back(static_cast<std::uint32_t>(bead), feature);
                             }};
    Failure failure{};
    if (body.table->candidates(body.self, &beads, wall_margin_, &sink, &failure) != 0) {
      throw config::UserError(std::string("geometry '") + body.name + "': " + failure.message);
    }
    if (!std::is_sorted(near.begin(), near.end())) std::sort(near.begin(), near.end());

    std::vector<CarriedContact> carried;
    for (const auto& slab : slabs_) {
      WallContacts& active = slab->walls[body_index].active;
      for (std::size_t c = 0; c < active.bead.size(); ++c) {
        carried.push_back({active.bead[c], active.feature[c], active.normal[c], std::vector<double>(slots)});
        for (std::size_t h = 0; h < slots; ++h) carried.back().history[h] = active.history[h][c];
      }
      active.clear();
    }
    std::stable_sort(carried.begin(), carried.end(), [](const CarriedContact& a, const CarriedContact& b) { return a.bead < b.bead; });

    std::size_t at = 0, from = 0;
    for (int s = 0; s < settings_.partitions; ++s) {
      WallSlab& wall = slabs_[static_cast<std::size_t>(s)]->walls[body_index];
      wall.bead.clear();
      wall.first.assign(1, 0);
      wall.candidates.clear();
      const std::uint32_t end = static_cast<std::uint32_t>(slab_begin(s + 1));
      while (at < near.size() && near[at].first < end) {
        const std::uint32_t bead = near[at].first;
        const std::uint32_t local = static_cast<std::uint32_t>(wall.bead.size());
        wall.bead.push_back(bead);
        for (; at < near.size() && near[at].first == bead; ++at) wall.candidates.push_back(near[at].second);
        wall.first.push_back(static_cast<std::int64_t>(wall.candidates.size()));
        while (from < carried.size() && carried[from].bead < bead) ++from;
        for (; from < carried.size() && carried[from].bead == bead; ++from) {
          wall.active.bead.push_back(local);
          wall.active.feature.push_back(carried[from].feature);
          wall.active.normal.push_back(carried[from].normal);
          for (std::size_t h = 0; h < slots; ++h) wall.active.history[h].push_back(carried[from].history[h]);
        }
      }
    }
  }
}

/// All contacts of a slab's beads with one body.
void System::walls(int slab, int worker, std::size_t body_index) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  WallSlab& wall = state.walls[body_index];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(worker)];
  BatchArrays& b = scratch.batch;
  const Body& body = bodies[body_index];
  const Pose& pose = poses_[body_index];
  BodyLedger& book = state.ledger.bodies[body_index];
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  const double dt = settings_.time_step;
  double reach = 0;
  for (const PairPhysics& p : physics_) {
    if (p.wall) reach = std::max(reach, p.reach);
  }
  std::size_t cursor = 0;
  wall.next.clear();
  const std::int64_t near_count = static_cast<std::int64_t>(wall.bead.size());
  for (std::int64_t begin = 0; begin < near_count; begin += kBeadsPerQuery) {
    const std::int64_t count = std::min(kBeadsPerQuery, near_count - begin);
    for (std::int64_t k = 0; k < count; ++k) {
      const PositionLine& line = particles.position[wall.bead[static_cast<std::size_t>(begin + k)]];
      const Row x = to_body(pose, centre(line));
      for (std::size_t a = 0; a < 3; ++a) scratch.query_position[a][k] = x[a];
      scratch.query_radius[k] = line.radius;
      scratch.query_first[static_cast<std::size_t>(k)] = wall.first[static_cast<std::size_t>(begin + k)];
    }
    scratch.query_first[static_cast<std::size_t>(count)] = wall.first[static_cast<std::size_t>(begin + count)];
    const GeometryQuery query{
        {count, {scratch.query_position[0], scratch.query_position[1], scratch.query_position[2]}, scratch.query_radius},
        scratch.query_first.data(),
        wall.candidates.data(),
        reach};
    GeometryContacts& found = scratch.wall;
    found.count = 0;
    body.table->contacts(body.self, &query, &found);

    const std::size_t base = wall.next.bead.size();
    wall.next.resize(base + static_cast<std::size_t>(found.count));
    std::uint64_t present = 0;  // bit p: some contact of physics p
    for (std::int64_t c = 0; c < found.count; ++c) {
      const std::size_t k = static_cast<std::size_t>(c);
      const std::uint32_t local = static_cast<std::uint32_t>(begin + found.bead[c]);
      const Row normal{found.normal[0][c], found.normal[1][c], found.normal[2][c]};
      scratch.normal[k] = to_world(pose, normal);
      scratch.pair[k] = pair_index(particles.material[wall.bead[local]], body.material_of_slot[found.material[c]], true);
      if (found.overlap[c] + physics_[static_cast<std::size_t>(scratch.pair[k])].reach <= 0) scratch.pair[k] = -1;
      if (scratch.pair[k] >= 0) present |= std::uint64_t{1} << (scratch.pair[k] % 64);
      wall.next.bead[base + k] = local;
      wall.next.feature[base + k] = scratch.pair[k] >= 0 ? found.feature[c] : std::numeric_limits<std::uint32_t>::max();
      wall.next.normal[base + k] = normal;
      const std::ptrdiff_t match = scratch.pair[k] < 0 ? -1 : take_match(wall.active, cursor, local, found.feature[c], normal);
      b.fresh[c] = match < 0;
      for (std::size_t h = 0; h < slots; ++h)
        wall.next.history[h][base + k] = match < 0 ? 0.0 : wall.active.history[h][static_cast<std::size_t>(match)];
    }
    std::vector<std::uint8_t>& fresh = scratch.fresh;
    fresh.assign(b.fresh, b.fresh + found.count);

    for (std::size_t p = 0; p < physics_.size(); ++p) {
      if (!physics_[p].wall || !(present >> (p % 64) & 1)) continue;
      std::int64_t m = 0;
      for (std::int64_t c = 0; c < found.count; ++c) {
        const std::size_t k = static_cast<std::size_t>(c);
        if (scratch.pair[k] != static_cast<std::int32_t>(p)) continue;
        const std::uint32_t bead = wall.bead[wall.next.bead[base + k]];
        const MotionLine& motion = particles.motion[bead];
        const Row position = centre(particles.position[bead]);
        const double radius = particles.position[bead].radius;
        const Row& n = scratch.normal[k];
        const double arm = radius - 0.5 * found.overlap[c];
        const Row contact{position[0] - arm * n[0] - pose.centre[0], position[1] - arm * n[1] - pose.centre[1],
                          position[2] - arm * n[2] - pose.centre[2]};
        const Row turning = cross(pose.omega, contact);
        const Row surface = cross({motion.w[0], motion.w[1], motion.w[2]}, n);
        b.slot[m] = static_cast<std::uint32_t>(c);
        b.owner[m] = bead;
        b.fresh[m] = fresh[k];
        b.overlap[m] = found.overlap[c];
        b.radius[m] = b.radius_i[m] = radius;
        b.radius_j[m] = 0.0;
        b.mass[m] = 1.0 / motion.inverse_mass;
        b.arm_i[m] = arm;
        for (std::size_t a = 0; a < 3; ++a) {
          b.normal[a][m] = n[a];
          b.difference[a][m] = contact[a];
          b.spin_sum[a][m] = pose.velocity[a] + turning[a];  // the wall's velocity here
          b.velocity[a][m] = motion.v[a] - arm * surface[a] - b.spin_sum[a][m];
          b.spin_i[a][m] = motion.w[a];
          b.spin_j[a][m] = pose.omega[a];
        }
        for (std::size_t h = 0; h < slots; ++h) b.history[h][m] = wall.next.history[h][base + k];
        ++m;
      }
      for (std::int64_t k = m; k < (m + 7) / 8 * 8; ++k) {
        b.overlap[k] = -1.0;
        b.radius[k] = b.mass[k] = b.radius_i[k] = 1.0;
        b.radius_j[k] = 0.0;
        for (int a = 0; a < 3; ++a) {
          b.normal[a][k] = a == 0 ? 1.0 : 0.0;
          b.velocity[a][k] = b.spin_i[a][k] = b.spin_j[a][k] = 0.0;
        }
        for (std::size_t h = 0; h < slots; ++h) b.history[h][k] = 0.0;
      }
      PairLedger& ledger = state.ledger.pairs[p];
      count_collisions(m, b, ledger);
      if (step_ % 16 == 0) note_overlap(m, b, ledger);
      ledger.contacts += m;
      evaluate({&physics_[p], dt, m, body.per_triangle}, b, ledger);
      const bool post = physics_[p].has_post();
      for (std::int64_t k = 0; k < m; ++k) {
        const Row f{b.force[0][k], b.force[1][k], b.force[2][k]};
        const Row n{b.normal[0][k], b.normal[1][k], b.normal[2][k]};
        const Row contact{b.difference[0][k], b.difference[1][k], b.difference[2][k]};
        const Row turn = cross(f, n), reaction = cross(contact, f);
        ForceLine& line = particles.force[b.owner[k]];
        double power = 0;
        for (std::size_t a = 0; a < 3; ++a) {
          const double moment_i = post ? b.moment_i[a][k] : 0.0, moment_j = post ? b.moment_j[a][k] : 0.0;
          line.f[a] += f[a];
          line.t[a] += b.arm_i[k] * turn[a] + moment_i;
          book.force[a] -= f[a];
          book.torque[a] += moment_j - reaction[a];
          power += f[a] * b.spin_sum[a][k] - moment_j * pose.omega[a];
        }
        book.power += power;
        book.work += power * dt;
        const std::size_t c = b.slot[k];
        for (std::size_t h = 0; h < slots; ++h) wall.next.history[h][base + c] = b.history[h][k];
        const std::uint32_t triangle = found.triangle[c];
        if (body.per_triangle && triangle < body.triangle_count) {
          for (std::size_t channel = 0; channel < physics_[p].law.table->info.channel_count; ++channel) {
            auto& kind = normal_channel_[channel] ? state.impact : state.shear;
            kind[body_index][triangle] += b.power[channel][k] * dt;
          }
        }
      }
    }
  }
  std::swap(wall.active, wall.next);
}

}  // namespace millscope::dem
