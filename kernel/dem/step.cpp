// One time step.
#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/base/error.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

// Walls and phase B trail behind the pairs by this many batches: few enough that the beads between are still in the cache.
constexpr std::int64_t kTrail = 4;

}  // namespace

/// Phase A: walls and the pairs of this slab. With `finish_too` phase B trails behind: pairs are listed by owner, and an owner comes before
/// its partners, so that a bead is done with once the last list has passed it; it is finished while it is still in the cache.
void System::contacts(int slab, int worker, bool finish_too) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(worker)];
  state.ledger.reset_instant();
  state.result = {false, -1};
  const bool in_ring = finish_too && state.ring > 0;
  state.force = in_ring ? ForceWindow::ring(scratch.ring.data(), state.ring) : ForceWindow{particles.force.data()};
  const std::int64_t slab_end = slab_begin(slab + 1);
  begin_walls(slab);
  std::int64_t finished = slab_begin(slab);
  for (std::size_t p = 0; p < physics_.size(); ++p) {
    if (physics_[p].wall) continue;
    PairSweep sweep = begin_pairs(slab, worker, p);
    PairListView& list = sweep.list;
    for (std::int64_t first = 0; first < list.count; first += kBatch) {
      const std::int64_t last = std::min(list.count, first + kBatch);
      pair_batch(sweep, first, last);
      if (p == last_list_ && last < list.count && last % (kTrail * kBatch) == 0) {
        walls(slab, worker, list.owner[last]);
        if (finish_too) finish(slab, worker, {finished, list.owner[last]});
        finished = list.owner[last];
      }
    }
    state.lists[p].end_sweep();
  }
  walls(slab, worker, slab_end);
  end_walls(slab);
  if (finish_too) finish(slab, worker, {finished, slab_end});
}

/// What all batches of one list share.
System::PairSweep System::begin_pairs(int slab, int worker, std::size_t p) {
  const PairPhysics& physics = physics_[p];
  const Equality& equality = equality_[p];
  PairSweep sweep{slab, p, slabs_[static_cast<std::size_t>(slab)]->lists[p].view(), scratch_[static_cast<std::size_t>(worker)]->pairs, {}};
  if (equality.equal) {
    // Arrays that hold the same number everywhere, made once.
    sweep.batch.radius = equality.arrays[0]->data();
    sweep.batch.mass = equality.arrays[1]->data();
    sweep.batch.radius_i = sweep.batch.radius_j = equality.arrays[2]->data();
  }
  sweep.gather = {particles.position.data(),
                  particles.motion.data(),
                  settings_.periodic,
                  physics.reach,
                  equality.equal,
                  !physics.interactions.empty(),
                  equality.radius,
                  0.5 * equality.mass,
                  0,
                  0,
                  nullptr};
  return sweep;
}

/// What `search` asks for in passing: the beads that the batch after the next will be the first to touch.
void System::look_ahead(PairSweep& sweep, std::int64_t first) const {
  const SlabState& state = *slabs_[static_cast<std::size_t>(sweep.slab)];
  GatherContext& gather = sweep.gather;
  gather.ahead = gather.ahead_end = 0;
  gather.ahead_force = nullptr;
  const std::size_t batch = static_cast<std::size_t>(first / kBatch);
  if (sweep.physics != last_list_ || batch + 2 >= state.frontier.size()) return;
  gather.ahead = state.frontier[batch + 1];
  gather.ahead_end = state.frontier[batch + 2];
  const std::int64_t slab_end = slab_begin(sweep.slab + 1);
  if (gather.ahead >= slab_end) {
    gather.ahead_force = state.halo.data() + (gather.ahead - slab_end);
  } else if (!state.force.is_ring()) {
    gather.ahead_force = particles.force.data() + gather.ahead;
    gather.ahead_end = std::min(gather.ahead_end, slab_end);
  }
}

/// Contacts among the list slots [first, last).
void System::pair_batch(PairSweep& sweep, std::int64_t first, std::int64_t last) {
  SlabState& state = *slabs_[static_cast<std::size_t>(sweep.slab)];
  const PairPhysics& physics = physics_[sweep.physics];
  PairListView& list = sweep.list;
  PairBatch& batch = sweep.batch;
  look_ahead(sweep, first);
  const std::int64_t count = wide_->search(sweep.gather, list, first, last, batch);
  if (count == 0) return;
  state.lists[sweep.physics].make_room(list);
  wide_->gather(sweep.gather, list, count, batch);
  PairLedger& ledger = state.ledger.pairs[sweep.physics];
  count_collisions(count, batch, ledger);
  if (step_ % 16 == 0) note_overlap(count, batch, ledger);
  ledger.contacts += count;
  evaluate({&physics, settings_.time_step, count, false}, batch, ledger);
  const ScatterContext scatter{state.force, state.halo.data(), slab_begin(sweep.slab + 1), sweep.gather.equal};
  wide_->scatter(scatter, list, count, physics.has_post(), batch);
}

/// How far each batch reaches, and the length of the ring that serves a slab: the most beads that carry forces at once, in the order in
/// which `contacts` goes.
void System::size_ring(int slab) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  const BeadRange beads = beads_of(slab);
  state.ring = 0;
  state.frontier.clear();
  const PairListView list = state.lists[last_list_].view();
  std::int64_t finished = beads.begin, longest = 0, touched = beads.begin, frontier = beads.begin;
  for (std::int64_t first = 0; first < list.count; first += kBatch) {
    const std::int64_t last = std::min(list.count, first + kBatch);
    for (std::int64_t s = first; s < last; ++s) {
      const std::int64_t partner = list.partner[s];
      frontier = std::max(frontier, partner + 1);
      if (partner < beads.end) touched = std::max(touched, partner + 1);
    }
    state.frontier.push_back(static_cast<std::uint32_t>(frontier));
    longest = std::max(longest, touched - finished);
    if (last < list.count && last % (kTrail * kBatch) == 0) {
      // Beads without pairs may lie before the next owner: walls and body forces reach them now.
      longest = std::max<std::int64_t>(longest, list.owner[last] - finished);
      finished = list.owner[last];
    }
  }
  longest = std::max(longest, beads.end - finished);
  const std::int64_t ring = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(longest)));
  if (list_count_ == 1 && ring < beads.end - beads.begin) state.ring = ring;
}

/// What follows from new lists: which slabs reach into which, and the rings.
void System::prepare_sweeps() {
  workers_->run(settings_.partitions, [this](int slab, int) { size_ring(slab); });
  std::int64_t longest = 0;
  for (const auto& slab : slabs_) longest = std::max(longest, slab->ring);
  for (const auto& scratch : scratch_) {
    if (static_cast<std::int64_t>(scratch->ring.size()) < longest) scratch->ring.assign(static_cast<std::size_t>(longest), ForceLine{});
  }
  first_reference_.assign(static_cast<std::size_t>(settings_.partitions), 0);
  for (int slab = 0; slab < settings_.partitions; ++slab) {
    int first = slab;
    for (int earlier = slab - 1; earlier >= 0; --earlier) {
      const std::int64_t halo_end =
          slab_begin(earlier + 1) + static_cast<std::int64_t>(slabs_[static_cast<std::size_t>(earlier)]->halo.size());
      if (halo_end > slab_begin(slab)) first = earlier;
    }
    first_reference_[static_cast<std::size_t>(slab)] = first;
  }
}

/// The forces that earlier slabs computed for beads of this one, added in slab order.
void System::add_halos(int slab, BeadRange range) {
  const ForceWindow force = slabs_[static_cast<std::size_t>(slab)]->force;
  for (int earlier = 0; earlier < slab; ++earlier) {
    AlignedVector<ForceLine>& halo = slabs_[static_cast<std::size_t>(earlier)]->halo;
    const std::int64_t halo_begin = slab_begin(earlier + 1), halo_end = halo_begin + static_cast<std::int64_t>(halo.size());
    for (std::int64_t i = std::max(range.begin, halo_begin); i < std::min(range.end, halo_end); ++i) {
      ForceLine& from = halo[static_cast<std::size_t>(i - halo_begin)];
      ForceLine& to = force[i];
      for (int a = 0; a < 3; ++a) {
        to.f[a] += from.f[a];
        to.t[a] += from.t[a];
      }
      from = ForceLine{};
    }
  }
}

/// Body forces that differ from bead to bead; the fluid that moves with a bead slows all that acts on it.
void System::apply_body_forces(int slab, int worker, BeadRange range) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  Scratch& scratch = *scratch_[static_cast<std::size_t>(worker)];
  const BodyForceArrays& b = scratch.bodies;
  for (std::int64_t begin = range.begin; begin < range.end; begin += kBatch) {
    const std::int64_t count = std::min(kBatch, range.end - begin);
    for (std::int64_t k = 0; k < count; ++k) {
      const std::size_t i = static_cast<std::size_t>(begin + k);
      const PositionLine& x = particles.position[i];
      const MotionLine& m = particles.motion[i];
      for (int a = 0; a < 3; ++a) {
        b.position[a][k] = x.centre[a];
        b.velocity[a][k] = m.v[a];
        b.spin[a][k] = m.w[a];
        b.force[a][k] = b.moment[a][k] = 0.0;
      }
      b.radius[k] = x.radius;
      b.mass[k] = 1.0 / m.inverse_mass;
      b.added_mass[k] = 0.0;
    }
    for (std::size_t f = 0; f < body_forces.size(); ++f) {
      double uniform[3];
      if (body_forces[f].table->uniform(body_forces[f].self, time(), uniform)) continue;
      BodyForceBatch batch{count,
                           time(),
                           settings_.time_step,
                           {b.position[0], b.position[1], b.position[2]},
                           {b.velocity[0], b.velocity[1], b.velocity[2]},
                           {b.spin[0], b.spin[1], b.spin[2]},
                           b.radius,
                           b.mass,
                           {b.force[0], b.force[1], b.force[2]},
                           {b.moment[0], b.moment[1], b.moment[2]},
                           b.added_mass,
                           0.0};
      body_forces[f].table->evaluate(body_forces[f].self, &batch);
      state.ledger.body_force_work[f] += batch.power_sum * settings_.time_step;
    }
    for (std::int64_t k = 0; k < count; ++k) {
      ForceLine& line = state.force[begin + k];
      for (int a = 0; a < 3; ++a) {
        line.f[a] += b.force[a][k];
        line.t[a] += b.moment[a][k];
      }
      const double added = b.added_mass[k];
      if (added != 0.0) {
        // (m + m_a) a = ΣF + m g: scale so that the integrator's F/m + g gives that.
        const double mass = b.mass[k], ratio = mass / (mass + added);
        for (std::size_t a = 0; a < 3; ++a) line.f[a] = ratio * (line.f[a] + mass * acceleration_[a]) - mass * acceleration_[a];
      }
    }
  }
}

void System::finish(int slab, int worker, BeadRange range) {
  if (range.begin == range.end) return;
  add_halos(slab, range);
  if (has_general_body_force_) apply_body_forces(slab, worker, range);
  integrate(slab, range);
}

/// Kick, drift, predict.
void System::integrate(int slab, BeadRange range) {
  SlabState& state = *slabs_[static_cast<std::size_t>(slab)];
  const IntegrateContext context{particles.position.data(),
                                 particles.motion.data(),
                                 particles.half.data(),
                                 state.force,
                                 particles.acceleration.data(),
                                 particles.reference.data(),
                                 range.begin,
                                 range.end,
                                 settings_.time_step,
                                 {acceleration_[0], acceleration_[1], acceleration_[2]},
                                 largest_step_ * largest_step_};
  const IntegrateResult result = wide_->integrate(context);
  state.result.rebuild = state.result.rebuild || result.rebuild;
  if (result.runaway >= 0) state.result.runaway = result.runaway;
}

void System::advance() {
  if (rebuild_needed_) rebuild();
  const double now = time();
  acceleration_ = {};
  for (const BodyForceReference& f : body_forces) {
    double g[3];
    if (f.table->uniform(f.self, now, g)) {
      for (std::size_t a = 0; a < 3; ++a) acceleration_[a] += g[a];
    }
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) poses_[b] = pose_at(bodies[b].motion, now);
  if (observe) {
    workers_->run(settings_.partitions, [this](int slab, int worker) { contacts(slab, worker, false); });
    workers_->run(settings_.partitions, [this](int slab, int worker) {
      add_halos(slab, beads_of(slab));
      if (has_general_body_force_) apply_body_forces(slab, worker, beads_of(slab));
    });
    observe(*this);
    workers_->run(settings_.partitions, [this](int slab, int) { integrate(slab, beads_of(slab)); });
  } else {
    workers_->run(settings_.partitions, [this](int slab, int worker) { contacts(slab, worker, follows_at_once(slab, worker)); });
    if (workers_->count() > 1) {
      workers_->run(settings_.partitions, [this](int slab, int worker) {
        if (!follows_at_once(slab, worker)) finish(slab, worker, beads_of(slab));
      });
    }
  }
  ++step_;
  wall_moved_ += settings_.time_step * wall_speed_;
  for (const auto& slab : slabs_) {
    if (slab->result.runaway >= 0) throw Runaway(complaint(slab->result.runaway, "moved more than half its radius in one step"));
    rebuild_needed_ = rebuild_needed_ || slab->result.rebuild;
  }
  if (wall_moved_ > wall_margin_) rebuild_needed_ = true;
}

std::string System::complaint(std::int64_t bead, const char* what) const {
  const std::size_t i = static_cast<std::size_t>(bead);
  const PositionLine& x = particles.position[i];
  const MotionLine& m = particles.motion[i];
  char line[700];
  std::snprintf(
      line, sizeof line,
      "at t = %.6g s bead %u %s: centre (%.4g, %.4g, %.4g) m, velocity (%.4g, %.4g, %.4g) m/s. Likely causes, in order: a time step "
      "too long for the stiffness (lower time.step_fraction), beads that overlapped walls or each other at the start, a liner with "
      "an open edge (millscope geometry report)",
      time(), particles.id[i], what, x.centre[0], x.centre[1], x.centre[2], m.v[0], m.v[1], m.v[2]);
  return line;
}

}  // namespace millscope::dem
