#include "kernel/dem/wall_sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "kernel/dem/evaluate.hpp"

namespace millscope::dem {
namespace {

constexpr std::int64_t kBeadsPerQuery = kBatch / kMaxWallContacts;

constexpr double kSlides = 0.02;  // of the surfaces' speed: less is what turning and the spring's own motion take, not sliding

/// Where a law books what sliding takes: bit k is channel k. Laws without a channel `friction` say it by all of their tangential losses.
struct SlidingChannels {
  unsigned friction = 0, damping = 0;
};

SlidingChannels sliding_channels(const PairTermInfo& law) {
  SlidingChannels found;
  for (std::size_t c = 0; c < law.channel_count; ++c) {
    if (law.channels[c].part != ChannelPart::tangential || law.channels[c].nature != ChannelNature::dissipative) continue;
    (std::strcmp(law.channels[c].name, "friction") == 0 ? found.friction : found.damping) |= 1U << c;
  }
  return found;
}

double power_of(unsigned channels, const WallBatch& b, std::int64_t k) {
  double power = 0;
  for (int c = 0; channels != 0; ++c, channels >>= 1) {
    if ((channels & 1U) != 0) power += b.power[c][k];
  }
  return power;
}

/// What slides of the surfaces' motion, m/s: what friction and damping take, over the tangential force. Damping counts with friction only:
/// a spring that sticks is damped, too.
double sliding_speed(const SlidingChannels& channels, const WallBatch& b, std::int64_t k, double shear, double surfaces) {
  const double friction = power_of(channels.friction, b, k);
  if (!(shear > 0) || (channels.friction != 0 && friction < kSlides * shear * surfaces)) return 0;
  return std::min((friction + power_of(channels.damping, b, k)) / shear, surfaces);
}

/// First touches, pressing force and sliding speed. Within the reach of a film or an adhesion a contact is fresh before it touches: then it
/// is the first that was a gap a step ago. What presses is the law's own force, with what is added to Coulomb's cap.
void note_rubbing(const PairPhysics& physics, double time_step, std::int64_t count, const WallBatch& b) {
  const bool has_added = physics.has_pre();
  const SlidingChannels channels = sliding_channels(physics.law.table->info);
  for (std::int64_t k = 0; k < count; ++k) {
    double along = 0, force2 = 0, parting = 0, speed2 = 0;
    for (int a = 0; a < 3; ++a) {
      along += b.force[a][k] * b.normal[a][k];
      force2 += b.force[a][k] * b.force[a][k];
      parting += b.velocity[a][k] * b.normal[a][k];
      speed2 += b.velocity[a][k] * b.velocity[a][k];
    }
    const bool was_gap = b.overlap[k] + parting * time_step <= 0;
    b.first[k] = b.overlap[k] > 0 && (b.fresh[k] != 0 || was_gap) ? 1 : 0;
    const double shear = std::sqrt(std::max(force2 - along * along, 0.0));
    const double surfaces = std::sqrt(std::max(speed2 - parting * parting, 0.0));
    b.pressing[k] = std::max(has_added ? along - b.added_force[k] + b.added_cap[k] : along, 0.0);
    b.sliding[k] = sliding_speed(channels, b, k, shear, surfaces);
  }
}

}  // namespace

WallSweep::WallSweep(const SlabPass& pass, WallLists& walls, const std::vector<WallPose>& poses)
    : pass_(pass), walls_(walls), poses_(poses) {
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

/// Asks the geometry. Periodic coordinates are wrapped at list rebuilds only: wrapped here, a bead that crosses the boundary would jump
/// away from the features that were listed for it. A surface must therefore reach a skin beyond the box (mesh: `period`).
void WallSweep::ask(const Chunk& chunk) {
  const WallList& list = walls_.of(pass_.slab, chunk.body);
  const Body& body = walls_.bodies()[chunk.body];
  Scratch& scratch = pass_.scratch;
  for (std::int64_t k = 0; k < chunk.count; ++k) {
    const PositionLine& line = pass_.particles.position[list.bead[chunk.begin + k]];
    for (int a = 0; a < 3; ++a) scratch.query_position[a][k] = line.centre[a];
    scratch.query_radius[k] = line.radius;
  }
  pass_.common.wide.to_frame(poses_[chunk.body], chunk.count, scratch.query_position);
  const GeometryQuery query{
      {chunk.count, {scratch.query_position[0], scratch.query_position[1], scratch.query_position[2]}, scratch.query_radius},
      list.first.data() + chunk.begin,
      list.candidates.data(),
      pass_.common.physics.wall_reach()};
  scratch.found.count = 0;
  scratch.found.triangle = body.per_triangle ? scratch.triangle : nullptr;
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
  const std::vector<int>& slots = body.material_of_slot;
  for (std::int64_t c = 0; c < found.count; ++c) {
    const std::int64_t at = chunk.base + c;
    assert(found.bead[c] >= 0 && found.bead[c] < chunk.count);
    const std::uint32_t local = static_cast<std::uint32_t>(chunk.begin + found.bead[c]);
    const Vector3 normal{found.normal[0][c], found.normal[1][c], found.normal[2][c]};
    const int p = physics.of_wall(pass_.particles.material[list.bead[local]], slots[found.material[c]]);
    FoundContact& contact = pass_.scratch.contacts[c];
    list.next.bead[at] = local;
    list.next.normal[at] = normal;
    if (found.overlap[c] + physics[p].reach <= 0) {
      list.next.feature[at] = WallContacts::kUsedUp;
      contact = {FoundContact::kOutOfReach, FoundContact::kFresh};
      continue;
    }
    chunk.present |= std::uint64_t{1} << (p % 64);
    list.next.feature[at] = found.feature[c];
    contact = {p, list.active.take(list.matched, local, found.feature[c], normal).value_or(FoundContact::kFresh)};
  }
}

/// Fills the batch with the chunk's contacts of one physics. Returns their number.
std::int64_t WallSweep::gather(const Chunk& chunk, int physics_index) {
  const WallList& list = walls_.of(pass_.slab, chunk.body);
  const GeometryContacts& found = pass_.scratch.found;
  WallBatch& b = pass_.scratch.walls;
  std::int64_t count = 0;
  for (std::int64_t c = 0; c < found.count; ++c) {
    const FoundContact& contact = pass_.scratch.contacts[c];
    if (contact.physics_index != physics_index) continue;
    b.contact[count] = static_cast<std::uint32_t>(c);
    b.bead[count] = list.bead[list.next.bead[chunk.base + c]];
    b.fresh[count] = contact.last == FoundContact::kFresh;
    ++count;
  }
  if (count == 0) return 0;
  for (std::int64_t h = 0; h < std::ssize(list.active.history); ++h) {
    const double* const last = list.active.history[h].data();
    double* const history = b.history[h];
    for (std::int64_t k = 0; k < count; ++k) history[k] = b.fresh[k] ? 0.0 : last[pass_.scratch.contacts[b.contact[k]].last];
    std::fill(history + count, history + padded_count(count), 0.0);
  }
  const WallGather from{
      pass_.particles.position.data(), pass_.particles.motion.data(), found.overlap, {found.normal[0], found.normal[1], found.normal[2]}};
  pass_.common.wide.gather_walls(from, poses_[chunk.body], count, b);
  return count;
}

/// Forces on the beads and on the body, work, histories.
void WallSweep::scatter(const Chunk& chunk, int physics_index, std::int64_t count) {
  WallList& list = walls_.of(pass_.slab, chunk.body);
  WallBatch& b = pass_.scratch.walls;
  const Body& body = walls_.bodies()[chunk.body];
  const PairPhysics& physics = pass_.common.physics[physics_index];
  BodyLedger& book = pass_.state.ledger.bodies[chunk.body];
  WallSums sums;
  pass_.common.wide.scatter_walls(poses_[chunk.body], pass_.force, count, physics.has_post(), b, sums);
  for (int a = 0; a < 3; ++a) {
    book.force[a] += sums.force[a];
    book.torque[a] += sums.torque[a];
  }
  book.power += sums.power;
  book.work += sums.power * pass_.common.settings.time_step;
  for (std::int64_t h = 0; h < std::ssize(list.next.history); ++h) {
    double* const to = list.next.history[h].data() + chunk.base;
    for (std::int64_t k = 0; k < count; ++k) to[b.contact[k]] = b.history[h][k];
  }
  if (!body.per_triangle) return;
  for (std::int64_t k = 0; k < count; ++k) book_triangle(chunk, physics, k);
  if (!physics.wear.empty() && pass_.step >= pass_.common.settings.wear_from_step) wear(chunk, physics_index, count);
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

/// What the contacts of the batch take away from the body.
void WallSweep::wear(const Chunk& chunk, int physics_index, std::int64_t count) {
  const WallBatch& b = pass_.scratch.walls;
  const PairPhysics& physics = pass_.common.physics[physics_index];
  note_rubbing(physics, pass_.common.settings.time_step, count, b);
  WearBatch batch{count, pass_.common.settings.time_step, b.first, {}, {}, b.radius_i, b.mass, b.pressing, b.sliding, b.worn};
  for (int a = 0; a < 3; ++a) {
    batch.normal[a] = b.normal[a];
    batch.velocity[a] = b.velocity[a];
  }
  std::vector<double>& worn = pass_.state.worn[chunk.body];
  for (std::size_t law = 0; law < physics.wear.size(); ++law) {
    physics.wear[law].table->evaluate(physics.wear[law].self, &batch);
    double& total = pass_.state.ledger.pairs[physics_index].worn[law];
    for (std::int64_t k = 0; k < count; ++k) {
      const std::uint32_t triangle = pass_.scratch.found.triangle[b.contact[k]];
      if (triangle < worn.size()) worn[triangle] += b.worn[k];
      total += b.worn[k];
    }
  }
}

}  // namespace millscope::dem
