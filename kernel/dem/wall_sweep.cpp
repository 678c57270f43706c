#include "kernel/dem/wall_sweep.hpp"

#include <algorithm>
#include <cassert>

#include "kernel/dem/evaluate.hpp"

namespace millscope::dem {
namespace {

constexpr std::int64_t kBeadsPerQuery = kBatch / kMaxWallContacts;

}  // namespace

WallSweep::WallSweep(const SlabPass& pass, WallLists& walls, const std::vector<Pose>& poses) : pass_(pass), walls_(walls), poses_(poses) {
  for (int body = 0; body < std::ssize(poses_); ++body) {
    WallList& list = walls_.of(pass_.slab, body);
    list.next.resize(0);
    list.swept = 0;
    list.matched = 0;
  }
}

void WallSweep::end() {
  for (int body = 0; body < std::ssize(poses_); ++body) {
    WallList& list = walls_.of(pass_.slab, body);
    std::swap(list.active, list.next);
  }
}

void WallSweep::until(std::int64_t end) {
  for (int body = 0; body < std::ssize(poses_); ++body) {
    for (Chunk chunk = next_chunk(body, end); chunk.count > 0; chunk = next_chunk(body, end)) run(chunk);
  }
}

WallSweep::Chunk WallSweep::next_chunk(int body, std::int64_t end) {
  WallList& list = walls_.of(pass_.slab, body);
  Chunk chunk{body, list.swept, 0};
  const std::int64_t near = std::ssize(list.bead);
  while (chunk.count < kBeadsPerQuery && list.swept < near && list.bead[list.swept] < end) {
    ++chunk.count;
    ++list.swept;
  }
  return chunk;
}

void WallSweep::run(Chunk& chunk) {
  ask(chunk);
  if (pass_.scratch.found.count == 0) return;
  match(chunk);
  for (int p = 0; p < pass_.common.physics.count(); ++p) {
    const PairPhysics& physics = pass_.common.physics[p];
    if (!physics.wall || (chunk.present >> (p % 64) & 1) == 0) continue;
    const std::int64_t count = gather(chunk, p);
    if (count == 0) continue;
    WallBatch& batch = pass_.scratch.walls;
    PairLedger& ledger = pass_.state.ledger.pairs[p];
    book_contacts(pass_.step, count, batch, ledger);
    evaluate({&physics, pass_.common.settings.time_step, count, walls_.bodies()[chunk.body].per_triangle}, batch, ledger);
    scatter(chunk, p, count);
  }
}

/// Asks the geometry.
void WallSweep::ask(const Chunk& chunk) {
  const WallList& list = walls_.of(pass_.slab, chunk.body);
  const Body& body = walls_.bodies()[chunk.body];
  Scratch& scratch = pass_.scratch;
  for (std::int64_t k = 0; k < chunk.count; ++k) {
    const PositionLine& line = pass_.particles.position[list.bead[chunk.begin + k]];
    const Vector3 x = to_body(poses_[chunk.body], centre(line));
    for (int a = 0; a < 3; ++a) scratch.query_position[a][k] = x[a];
    scratch.query_radius[k] = line.radius;
  }
  const GeometryQuery query{
      {chunk.count, {scratch.query_position[0], scratch.query_position[1], scratch.query_position[2]}, scratch.query_radius},
      list.first.data() + chunk.begin,
      list.candidates.data(),
      pass_.common.physics.wall_reach()};
  scratch.found.count = 0;
  body.table->contacts(body.self, &query, &scratch.found);
  assert(scratch.found.count <= scratch.found.capacity);
}

/// Notes for each contact found its physics, its normal and its history.
void WallSweep::match(Chunk& chunk) {
  WallList& list = walls_.of(pass_.slab, chunk.body);
  const Body& body = walls_.bodies()[chunk.body];
  const PhysicsTable& physics = pass_.common.physics;
  const GeometryContacts& found = pass_.scratch.found;
  chunk.base = list.next.count();
  list.next.resize(chunk.base + found.count);
  pass_.scratch.contacts.resize(found.count);
  for (std::int64_t c = 0; c < found.count; ++c) {
    const std::int64_t at = chunk.base + c;
    assert(found.bead[c] >= 0 && found.bead[c] < chunk.count);
    const std::uint32_t local = static_cast<std::uint32_t>(chunk.begin + found.bead[c]);
    const Vector3 normal{found.normal[0][c], found.normal[1][c], found.normal[2][c]};
    const int p = physics.of_wall(pass_.particles.material[list.bead[local]], body.material_of_slot[found.material[c]]);
    const bool acts = !(found.overlap[c] + physics[p].reach <= 0);
    if (acts) chunk.present |= std::uint64_t{1} << (p % 64);
    std::optional<std::int64_t> last;
    if (acts) last = list.active.take(list.matched, local, found.feature[c], normal);
    list.next.bead[at] = local;
    list.next.feature[at] = acts ? found.feature[c] : WallContacts::kUsedUp;
    list.next.normal[at] = normal;
    for (int h = 0; h < std::ssize(list.next.history); ++h) list.next.history[h][at] = last ? list.active.history[h][*last] : 0.0;
    pass_.scratch.contacts[c] = {acts ? p : FoundContact::kOutOfReach, !last, to_world(poses_[chunk.body], normal)};
  }
}

/// Fills the batch with the chunk's contacts of one physics. Returns their number.
std::int64_t WallSweep::gather(const Chunk& chunk, int physics_index) {
  std::int64_t count = 0;
  for (std::int64_t c = 0; c < pass_.scratch.found.count; ++c) {
    if (pass_.scratch.contacts[c].physics_index == physics_index) fill(chunk, c, count++);
  }
  if (count > 0) pad(count);
  return count;
}

/// Place `m` of the batch, with contact `c` of those found.
void WallSweep::fill(const Chunk& chunk, std::int64_t c, std::int64_t m) {
  const WallList& list = walls_.of(pass_.slab, chunk.body);
  const Pose& pose = poses_[chunk.body];
  const FoundContact& contact = pass_.scratch.contacts[c];
  const double overlap = pass_.scratch.found.overlap[c];
  WallBatch& b = pass_.scratch.walls;
  const std::uint32_t bead = list.bead[list.next.bead[chunk.base + c]];
  const MotionLine& motion = pass_.particles.motion[bead];
  const Vector3 position = centre(pass_.particles.position[bead]);
  const double radius = pass_.particles.position[bead].radius;
  const Vector3& n = contact.normal;
  const double arm = radius - 0.5 * overlap;
  const Vector3 lever{position[0] - arm * n[0] - pose.centre[0], position[1] - arm * n[1] - pose.centre[1],
                      position[2] - arm * n[2] - pose.centre[2]};
  const Vector3 turning = cross(pose.omega, lever);
  const Vector3 surface = cross({motion.w[0], motion.w[1], motion.w[2]}, n);
  b.contact[m] = static_cast<std::uint32_t>(c);
  b.bead[m] = bead;
  b.fresh[m] = contact.fresh;
  b.overlap[m] = overlap;
  b.radius[m] = b.radius_i[m] = radius;
  b.radius_j[m] = 0.0;
  b.mass[m] = 1.0 / motion.inverse_mass;
  b.arm[m] = arm;
  for (int a = 0; a < 3; ++a) {
    b.normal[a][m] = n[a];
    b.lever[a][m] = lever[a];
    b.wall_velocity[a][m] = pose.velocity[a] + turning[a];
    b.velocity[a][m] = motion.v[a] - arm * surface[a] - b.wall_velocity[a][m];
    b.spin_i[a][m] = motion.w[a];
    b.spin_j[a][m] = pose.omega[a];
  }
  for (int h = 0; h < std::ssize(list.next.history); ++h) b.history[h][m] = list.next.history[h][chunk.base + c];
}

/// The padding behind the batch's contacts is a gap of 1 m at rest.
void WallSweep::pad(std::int64_t count) {
  WallBatch& b = pass_.scratch.walls;
  for (std::int64_t k = count; k < padded_count(count); ++k) {
    b.overlap[k] = -1.0;
    b.radius[k] = b.mass[k] = b.radius_i[k] = 1.0;
    b.radius_j[k] = 0.0;
    for (int a = 0; a < 3; ++a) {
      b.normal[a][k] = a == 0 ? 1.0 : 0.0;
      b.velocity[a][k] = b.spin_i[a][k] = b.spin_j[a][k] = 0.0;
    }
    for (int h = 0; h < pass_.common.layout.history_count(); ++h) b.history[h][k] = 0.0;
  }
}

/// Forces on the beads and on the body, work, histories.
void WallSweep::scatter(const Chunk& chunk, int physics_index, std::int64_t count) {
  WallList& list = walls_.of(pass_.slab, chunk.body);
  const WallBatch& b = pass_.scratch.walls;
  const Body& body = walls_.bodies()[chunk.body];
  const Pose& pose = poses_[chunk.body];
  const PairPhysics& physics = pass_.common.physics[physics_index];
  BodyLedger& book = pass_.state.ledger.bodies[chunk.body];
  const bool post = physics.has_post();
  for (std::int64_t k = 0; k < count; ++k) {
    const Vector3 f{b.force[0][k], b.force[1][k], b.force[2][k]};
    const Vector3 n{b.normal[0][k], b.normal[1][k], b.normal[2][k]};
    const Vector3 lever{b.lever[0][k], b.lever[1][k], b.lever[2][k]};
    const Vector3 turn = cross(f, n), reaction = cross(lever, f);
    ForceLine& line = pass_.state.force[b.bead[k]];
    double power = 0;
    for (int a = 0; a < 3; ++a) {
      const double moment_i = post ? b.moment_i[a][k] : 0.0, moment_j = post ? b.moment_j[a][k] : 0.0;
      line.f[a] += f[a];
      line.t[a] += b.arm[k] * turn[a] + moment_i;
      book.force[a] -= f[a];
      book.torque[a] += moment_j - reaction[a];
      power += f[a] * b.wall_velocity[a][k] - moment_j * pose.omega[a];
    }
    book.power += power;
    book.work += power * pass_.common.settings.time_step;
    for (int h = 0; h < std::ssize(list.next.history); ++h) list.next.history[h][chunk.base + b.contact[k]] = b.history[h][k];
    if (body.per_triangle) book_triangle(chunk, physics, k);
  }
}

/// Work that the contact at place `k` of the batch does on its triangle.
void WallSweep::book_triangle(const Chunk& chunk, const PairPhysics& physics, std::int64_t k) {
  const WallBatch& b = pass_.scratch.walls;
  const std::uint32_t triangle = pass_.scratch.found.triangle[b.contact[k]];
  if (triangle >= walls_.bodies()[chunk.body].triangle_count) return;
  const PairTermInfo& law = physics.law.table->info;
  for (std::size_t channel = 0; channel < law.channel_count; ++channel) {
    auto& kind = law.channels[channel].part == ChannelPart::normal ? pass_.state.impact : pass_.state.shear;
    kind[chunk.body][triangle] += b.power[channel][k] * pass_.common.settings.time_step;
  }
}

}  // namespace millscope::dem
