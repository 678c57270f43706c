#include "kernel/dem/step.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "kernel/dem/body_force_pass.hpp"
#include "kernel/dem/wall_sweep.hpp"

namespace millscope::dem {
namespace {

/// Of beads in order: the first that ran away, and whether any asks for new lists.
IntegrateResult first_of(const IntegrateResult& a, const IntegrateResult& b) {
  return {a.rebuild || b.rebuild, a.runaway >= 0 ? a.runaway : b.runaway};
}

}  // namespace

Step::Step(Common& common, Particles& particles, PairLists& pairs, WallLists& walls, const std::vector<BodyForceReference>& body_forces)
    : common_(common), particles_(particles), pairs_(pairs), walls_(walls), body_forces_(body_forces), schedule_(common) {}

void Step::prepare() {
  SlabState empty;
  empty.ledger.pairs.resize(common_.physics.count());
  for (int p = 0; p < common_.physics.count(); ++p) {
    empty.ledger.pairs[p].dissipated.assign(common_.layout.channels.size(), 0.0);
    empty.ledger.pairs[p].worn.assign(common_.physics[p].wear.size(), 0.0);
  }
  empty.ledger.bodies.resize(walls_.bodies().size());
  empty.ledger.body_force_work.assign(body_forces_.size(), 0.0);
  const auto& all = common_.physics.all();
  const bool wears = std::any_of(all.begin(), all.end(), [](const PairPhysics& p) { return !p.wear.empty(); });
  for (const Body& body : walls_.bodies()) {
    empty.impact.emplace_back(body.per_triangle ? body.triangle_count : 0, 0.0);
    empty.shear.push_back(empty.impact.back());
    empty.worn.emplace_back(wears ? empty.impact.back().size() : 0, 0.0);
  }
  slabs_.assign(common_.slabs.count, empty);
  pushed_ = std::vector<std::atomic<std::int64_t>>(common_.slabs.count);
  for (auto& step : pushed_) step.store(std::numeric_limits<std::int64_t>::min());
  scratch_.clear();
  for (int w = 0; w < common_.workers.count(); ++w) scratch_.push_back(std::make_unique<Scratch>(common_.layout.history_count()));
  alike_.clear();
  for (const PairPhysics& physics : common_.physics.all()) alike_.push_back(alike_of(particles_, physics));
  double smallest = 1e300;
  for (const PositionLine& x : particles_.position) smallest = std::min(smallest, x.radius);
  largest_drift_ = 0.5 * smallest;
  has_general_body_force_ = std::any_of(body_forces_.begin(), body_forces_.end(), [](const BodyForceReference& f) {
    double uniform[3];
    return !f.table->uniform(f.self, 0.0, uniform);
  });
}

void Step::forget_wear() {
  for (SlabState& slab : slabs_) {
    for (std::vector<double>& body : slab.worn) std::fill(body.begin(), body.end(), 0.0);
    for (PairLedger& p : slab.ledger.pairs) std::fill(p.worn.begin(), p.worn.end(), 0.0);
  }
}

void Step::lists_changed() {
  schedule_.renew(pairs_, particles_.count());
  for (int worker = 0; worker < common_.workers.count(); ++worker) {
    AlignedVector<ForceLine>& ring = scratch_[worker]->ring;
    if (takes_ring(beads_of(worker)) && std::ssize(ring) < schedule_.ring()) ring.assign(schedule_.ring(), ForceLine{});
  }
}

BeadRange Step::beads_of(int worker) const {
  const auto bound = [&](int w) { return common_.slabs.bounds[common_.workers.first(w, common_.slabs.count)]; };
  return {bound(worker), bound(worker + 1)};
}

/// Where a ring is no shorter than the beads themselves, their own lines do as well.
bool Step::takes_ring(BeadRange beads) const { return schedule_.ring() < beads.end - beads.begin; }

/// A worker's slabs on their way through a step.
struct Step::Share {
  Scratch& scratch;
  int begin, end;  ///< slabs
  BeadRange beads;
  ForceWindow force;
  int finishing;          ///< the slab of the next bead for phase B
  std::int64_t finished;  ///< that bead
};

Step::Share Step::share_of(int worker, bool observed) {
  const int begin = common_.workers.first(worker, common_.slabs.count), end = common_.workers.first(worker + 1, common_.slabs.count);
  const BeadRange beads = beads_of(worker);
  Scratch& scratch = *scratch_[worker];
  const bool in_ring = !observed && takes_ring(beads);
  const ForceWindow force = in_ring ? ForceWindow::ring(scratch.ring.data(), schedule_.ring()) : ForceWindow{particles_.force.data()};
  return {scratch, begin, end, beads, force, begin, beads.begin};
}

IntegrateResult Step::make(std::int64_t step, const std::function<void()>& observe) {
  step_ = step;
  acceleration_ = {};
  for (const BodyForceReference& f : body_forces_) {
    double g[3];
    if (!f.table->uniform(f.self, time(), g)) continue;
    for (int a = 0; a < 3; ++a) acceleration_[a] += g[a];
  }
  poses_.clear();
  for (const Body& body : walls_.bodies()) poses_.push_back(plain(pose_at(body.motion, time())));
  if (observe) {
    make_observed(observe);
  } else {
    each_share(false, [this](Share& share) {
      for (int slab = share.begin; slab < share.end; ++slab) push(share, slab, [&](std::int64_t done) { finish(share, done); });
      if (take_pushes(share)) finish(share, share.beads.end);
    });
  }
  IntegrateResult all{false, -1};
  for (const SlabState& slab : slabs_) all = first_of(all, slab.result);
  return all;
}

/// The same, with all beads at rest between phase A and the drift.
void Step::make_observed(const std::function<void()>& observe) {
  const auto no_drift = [](std::int64_t) {};
  each_share(true, [&](Share& share) {
    for (int slab = share.begin; slab < share.end; ++slab) push(share, slab, no_drift);
  });
  each_share(true, [this](Share& share) {
    if (!take_pushes(share)) return;
    for (int slab = share.begin; slab < share.end; ++slab) apply_body_forces(share, slab, common_.slabs.range(slab));
  });
  observe();
  each_share(true, [this](Share& share) {
    for (int slab = share.begin; slab < share.end; ++slab) slabs_[slab].result = integrate(share.force, common_.slabs.range(slab));
  });
}

template <class Work>
void Step::each_share(bool observed, const Work& work) {
  common_.workers.run(common_.workers.count(), [&](int worker, int) {
    Share share = share_of(worker, observed);
    work(share);
  });
}

/// Phase A of a slab. The walls trail behind the pairs. `done` hears up to which bead no pair still pushes.
template <class Done>
void Step::push(Share& share, int slab, const Done& done) {
  SlabState& state = slabs_[slab];
  state.ledger.reset_instant();
  state.result = {false, -1};
  state.log.count = 0;
  const bool reaches_others = schedule_.first_touched(slab) < share.beads.begin;
  const SlabPass pass{common_, particles_, state, share.scratch, share.force, slab, reaches_others ? share.beads.begin : 0, step_};
  WallSweep walls(pass, walls_, poses_);
  const std::vector<Trail>& trails = schedule_.trails(slab);
  [[maybe_unused]] const auto fits_ring = [&](std::int64_t touched) {
    return !share.force.is_ring() || touched - share.finished <= share.force.mask + 1;
  };
  for (int p = 0; p < common_.physics.count(); ++p) {
    if (common_.physics[p].wall) continue;
    PairSweep pairs(pass, p, pairs_.of(slab, p), alike_[p]);
    for (std::int64_t first = 0, trail = 0; first < pairs.count(); first += kBatch) {
      pairs.batch(first);
      if (p != schedule_.last_list() || trail + 1 == std::ssize(trails) || first + kBatch != (trail + 1) * Schedule::kSlotsPerTrail)
        continue;
      assert(fits_ring(schedule_.touched(slab, trails[trail])));
      walls.until(trails[trail].passed);
      done(trails[trail++].done);
    }
    pairs.end();
  }
  assert(fits_ring(schedule_.touched(slab, trails.back())));
  walls.until(trails.back().passed);
  walls.end();
  pushed_[slab].store(step_, std::memory_order_release);
  done(trails.back().done);
}

/// Waits for the slabs of other workers that push beads of this one, and adds what they push, in their order: one by one, as if this worker
/// had come by them itself, so that the number of workers does not enter. False: a worker has failed.
bool Step::take_pushes(const Share& share) {
  for (int later = share.end; later < common_.slabs.count && schedule_.first_touched(later) < share.beads.end; ++later) {
    if (!common_.workers.wait_for([&] { return pushed_[later].load(std::memory_order_acquire) == step_; })) return false;
    const PushLog& log = slabs_[later].log;
    for (std::int64_t k = 0; k < log.count; ++k) {
      if (log.bead[k] < share.beads.begin || log.bead[k] >= share.beads.end) continue;
      assert(log.bead[k] >= share.finished);
      ForceLine& line = share.force[log.bead[k]];
      for (int a = 0; a < 3; ++a) {
        line.f[a] += log.push[k].f[a];
        line.t[a] += log.push[k].t[a];
      }
    }
  }
  return true;
}

/// Phase B of the beads before `end`, but of a slab whole batches only: sums that body forces keep come out the same, whenever that
/// happens.
void Step::finish(Share& share, std::int64_t end) {
  for (; share.finishing < share.end; ++share.finishing) {
    const BeadRange slab = common_.slabs.range(share.finishing);
    std::int64_t stop = slab.end;
    if (end < slab.end) stop = std::max(share.finished, slab.begin + (end - slab.begin) / kBatch * kBatch);
    if (stop > share.finished) {
      const BeadRange range{share.finished, stop};
      IntegrateResult& result = slabs_[share.finishing].result;
      apply_body_forces(share, share.finishing, range);
      result = first_of(result, integrate(share.force, range));
      share.finished = stop;
    }
    if (stop < slab.end) return;
  }
}

void Step::apply_body_forces(Share& share, int slab, BeadRange range) {
  if (!has_general_body_force_) return;
  const SlabPass pass{common_, particles_, slabs_[slab], share.scratch, share.force, slab, 0, step_};
  BodyForcePass forces(pass, body_forces_, acceleration_, time());
  for (std::int64_t begin = range.begin; begin < range.end; begin += kBatch) forces.run({begin, std::min(range.end, begin + kBatch)});
}

/// Kick, drift, predict.
IntegrateResult Step::integrate(const ForceWindow& force, BeadRange range) {
  const IntegrateContext context{particles_.position.data(),
                                 particles_.motion.data(),
                                 particles_.half.data(),
                                 force,
                                 particles_.acceleration.data(),
                                 particles_.reference.data(),
                                 range.begin,
                                 range.end,
                                 common_.settings.time_step,
                                 {acceleration_[0], acceleration_[1], acceleration_[2]},
                                 largest_drift_ * largest_drift_};
  return common_.wide.integrate(context);
}

}  // namespace millscope::dem
