// Beads at the walls, in each step: the geometry finds the contacts of the beads near it, the physics is run pair by pair of materials.
#include <algorithm>
#include <limits>

#include "kernel/dem/rows.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

constexpr std::int64_t kBeadsPerQuery = kBatch / kMaxWallContacts;
constexpr std::uint32_t kUsedUp = std::numeric_limits<std::uint32_t>::max();

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
  if (best >= 0) old.feature[static_cast<std::size_t>(best)] = kUsedUp;
  return best;
}

/// Contacts [0, count) of a batch are real; the padding behind them is a gap of 1 m at rest.
void pad_wall_batch(std::int64_t count, std::size_t histories, WallBatch& b) {
  for (std::int64_t k = count; k < padded_count(count); ++k) {
    b.overlap[k] = -1.0;
    b.radius[k] = b.mass[k] = b.radius_i[k] = 1.0;
    b.radius_j[k] = 0.0;
    for (int a = 0; a < 3; ++a) {
      b.normal[a][k] = a == 0 ? 1.0 : 0.0;
      b.velocity[a][k] = b.spin_i[a][k] = b.spin_j[a][k] = 0.0;
    }
    for (std::size_t h = 0; h < histories; ++h) b.history[h][k] = 0.0;
  }
}

}  // namespace

void System::begin_walls(int slab) {
  for (WallSlab& wall : slabs_[static_cast<std::size_t>(slab)]->walls) {
    wall.next.clear();
    wall.swept = 0;
    wall.matched = 0;
  }
}

void System::end_walls(int slab) {
  for (WallSlab& wall : slabs_[static_cast<std::size_t>(slab)]->walls) std::swap(wall.active, wall.next);
}

/// The contacts of the slab's beads before `end` that have not been through this step yet.
void System::walls(int slab, int worker, std::int64_t end) {
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    WallSlab& wall = slabs_[static_cast<std::size_t>(slab)]->walls[body];
    for (;;) {
      WallChunk chunk{slab, worker, body, static_cast<std::int64_t>(wall.swept), 0, 0, 0};
      const std::int64_t near = static_cast<std::int64_t>(wall.bead.size());
      while (chunk.count < kBeadsPerQuery && chunk.begin + chunk.count < near &&
             wall.bead[static_cast<std::size_t>(chunk.begin + chunk.count)] < end) {
        ++chunk.count;
      }
      if (chunk.count == 0) break;
      wall.swept += static_cast<std::size_t>(chunk.count);
      find_wall_contacts(chunk);
      for (std::size_t p = 0; p < physics_.size(); ++p) {
        if (!physics_[p].wall || (chunk.present >> (p % 64) & 1) == 0) continue;
        const std::int64_t count = gather_wall_batch(chunk, p);
        if (count == 0) continue;
        WallBatch& b = scratch_[static_cast<std::size_t>(worker)]->walls;
        PairLedger& ledger = slabs_[static_cast<std::size_t>(slab)]->ledger.pairs[p];
        count_collisions(count, b, ledger);
        if (step_ % 16 == 0) note_overlap(count, b, ledger);
        ledger.contacts += count;
        evaluate({&physics_[p], settings_.time_step, count, bodies[body].per_triangle}, b, ledger);
        scatter_wall_batch(chunk, p, count);
      }
    }
  }
}

/// Asks the geometry; notes for each contact found its physics (−1: out of reach), its normal and its history.
void System::find_wall_contacts(WallChunk& chunk) {
  WallSlab& wall = slabs_[static_cast<std::size_t>(chunk.slab)]->walls[chunk.body];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(chunk.worker)];
  const Body& body = bodies[chunk.body];
  const Pose& pose = poses_[chunk.body];
  const std::size_t histories = static_cast<std::size_t>(layout_.history_count());
  for (std::int64_t k = 0; k < chunk.count; ++k) {
    const PositionLine& line = particles.position[wall.bead[static_cast<std::size_t>(chunk.begin + k)]];
    const Row x = to_body(pose, centre(line));
    for (std::size_t a = 0; a < 3; ++a) scratch.query_position[a][k] = x[a];
    scratch.query_radius[k] = line.radius;
  }
  const GeometryQuery query{
      {chunk.count, {scratch.query_position[0], scratch.query_position[1], scratch.query_position[2]}, scratch.query_radius},
      wall.first.data() + chunk.begin,
      wall.candidates.data(),
      wall_reach_};
  GeometryContacts& found = scratch.found;
  found.count = 0;
  body.table->contacts(body.self, &query, &found);

  chunk.base = wall.next.bead.size();
  wall.next.resize(chunk.base + static_cast<std::size_t>(found.count));
  scratch.contacts.resize(static_cast<std::size_t>(found.count));
  for (std::int64_t c = 0; c < found.count; ++c) {
    const std::size_t k = static_cast<std::size_t>(c), at = chunk.base + k;
    const std::uint32_t local = static_cast<std::uint32_t>(chunk.begin + found.bead[c]);
    const Row normal{found.normal[0][c], found.normal[1][c], found.normal[2][c]};
    int p = pair_index(particles.material[wall.bead[local]], body.material_of_slot[found.material[c]], true);
    if (found.overlap[c] + physics_[static_cast<std::size_t>(p)].reach <= 0) p = FoundContact::kOutOfReach;
    const bool acts = p != FoundContact::kOutOfReach;
    if (acts) chunk.present |= std::uint64_t{1} << (p % 64);
    wall.next.bead[at] = local;
    wall.next.feature[at] = acts ? found.feature[c] : kUsedUp;
    wall.next.normal[at] = normal;
    const std::ptrdiff_t match = !acts ? -1 : take_match(wall.active, wall.matched, local, found.feature[c], normal);
    scratch.contacts[k] = {p, match < 0, to_world(pose, normal)};
    for (std::size_t h = 0; h < histories; ++h) {
      wall.next.history[h][at] = match < 0 ? 0.0 : wall.active.history[h][static_cast<std::size_t>(match)];
    }
  }
}

/// Fills the batch with the chunk's contacts of one physics. Returns their number.
std::int64_t System::gather_wall_batch(const WallChunk& chunk, std::size_t physics) {
  const WallSlab& wall = slabs_[static_cast<std::size_t>(chunk.slab)]->walls[chunk.body];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(chunk.worker)];
  WallBatch& b = scratch.walls;
  const Pose& pose = poses_[chunk.body];
  const GeometryContacts& found = scratch.found;
  const std::size_t histories = static_cast<std::size_t>(layout_.history_count());
  std::int64_t m = 0;
  for (std::int64_t c = 0; c < found.count; ++c) {
    const std::size_t k = static_cast<std::size_t>(c);
    if (scratch.contacts[k].physics_index != static_cast<int>(physics)) continue;
    const std::uint32_t bead = wall.bead[wall.next.bead[chunk.base + k]];
    const MotionLine& motion = particles.motion[bead];
    const Row position = centre(particles.position[bead]);
    const double radius = particles.position[bead].radius;
    const Row& n = scratch.contacts[k].normal;
    const double arm = radius - 0.5 * found.overlap[c];
    const Row lever{position[0] - arm * n[0] - pose.centre[0], position[1] - arm * n[1] - pose.centre[1],
                    position[2] - arm * n[2] - pose.centre[2]};
    const Row turning = cross(pose.omega, lever);
    const Row surface = cross({motion.w[0], motion.w[1], motion.w[2]}, n);
    b.contact[m] = static_cast<std::uint32_t>(c);
    b.bead[m] = bead;
    b.fresh[m] = scratch.contacts[k].fresh;
    b.overlap[m] = found.overlap[c];
    b.radius[m] = b.radius_i[m] = radius;
    b.radius_j[m] = 0.0;
    b.mass[m] = 1.0 / motion.inverse_mass;
    b.arm[m] = arm;
    for (std::size_t a = 0; a < 3; ++a) {
      b.normal[a][m] = n[a];
      b.lever[a][m] = lever[a];
      b.wall_velocity[a][m] = pose.velocity[a] + turning[a];
      b.velocity[a][m] = motion.v[a] - arm * surface[a] - b.wall_velocity[a][m];
      b.spin_i[a][m] = motion.w[a];
      b.spin_j[a][m] = pose.omega[a];
    }
    for (std::size_t h = 0; h < histories; ++h) b.history[h][m] = wall.next.history[h][chunk.base + k];
    ++m;
  }
  if (m > 0) pad_wall_batch(m, histories, b);
  return m;
}

/// Forces on the beads and on the body, work, histories.
void System::scatter_wall_batch(const WallChunk& chunk, std::size_t physics, std::int64_t count) {
  SlabState& state = *slabs_[static_cast<std::size_t>(chunk.slab)];
  WallSlab& wall = state.walls[chunk.body];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(chunk.worker)];
  const WallBatch& b = scratch.walls;
  const Body& body = bodies[chunk.body];
  const Pose& pose = poses_[chunk.body];
  BodyLedger& book = state.ledger.bodies[chunk.body];
  const double dt = settings_.time_step;
  const bool post = physics_[physics].has_post();
  for (std::int64_t k = 0; k < count; ++k) {
    const Row f{b.force[0][k], b.force[1][k], b.force[2][k]};
    const Row n{b.normal[0][k], b.normal[1][k], b.normal[2][k]};
    const Row lever{b.lever[0][k], b.lever[1][k], b.lever[2][k]};
    const Row turn = cross(f, n), reaction = cross(lever, f);
    ForceLine& line = state.force[b.bead[k]];
    double power = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double moment_i = post ? b.moment_i[a][k] : 0.0, moment_j = post ? b.moment_j[a][k] : 0.0;
      line.f[a] += f[a];
      line.t[a] += b.arm[k] * turn[a] + moment_i;
      book.force[a] -= f[a];
      book.torque[a] += moment_j - reaction[a];
      power += f[a] * b.wall_velocity[a][k] - moment_j * pose.omega[a];
    }
    book.power += power;
    book.work += power * dt;
    const std::size_t c = b.contact[k];
    for (std::size_t h = 0; h < wall.next.history.size(); ++h) wall.next.history[h][chunk.base + c] = b.history[h][k];
    const std::uint32_t triangle = scratch.found.triangle[c];
    if (body.per_triangle && triangle < body.triangle_count) {
      for (std::size_t channel = 0; channel < physics_[physics].law.table->info.channel_count; ++channel) {
        auto& kind = normal_channel_[channel] ? state.impact : state.shear;
        kind[chunk.body][triangle] += b.power[channel][k] * dt;
      }
    }
  }
}

}  // namespace millscope::dem
