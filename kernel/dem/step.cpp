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
  for (PairLedger& p : empty.ledger.pairs) p.dissipated.assign(common_.layout.channels.size(), 0.0);
  empty.ledger.bodies.resize(walls_.bodies().size());
  empty.ledger.body_force_work.assign(body_forces_.size(), 0.0);
  for (const Body& body : walls_.bodies()) {
    empty.impact.emplace_back(body.per_triangle ? body.triangle_count : 0, 0.0);
    empty.shear.push_back(empty.impact.back());
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

void Step::lists_changed() {
  schedule_.renew(pairs_);
  for (int slab = 0; slab < common_.slabs.count; ++slab) slabs_[slab].halo.assign(schedule_.halo_size(slab), ForceLine{});
  for (const auto& scratch : scratch_) {
    if (std::ssize(scratch->ring) < schedule_.longest_ring()) scratch->ring.assign(schedule_.longest_ring(), ForceLine{});
  }
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
  const Slabs& slabs = common_.slabs;
  if (observe) {
    common_.each_slab([this](int slab, int worker) { contacts(slab, worker, false); });
    common_.each_slab([&](int slab, int worker) {
      add_halos(slab, slabs.range(slab));
      each_stretch(slab, [&](BeadRange range) { apply_body_forces(slab, worker, range); });
    });
    observe();
    common_.each_slab([&](int slab, int) { slabs_[slab].result = integrate(slab, slabs.range(slab)); });
  } else {
    common_.workers.run(common_.workers.count(), [this](int share, int) { share_of(share); });
  }
  IntegrateResult all{false, -1};
  for (const SlabState& slab : slabs_) all = first_of(all, slab.result);
  return all;
}

/// Both phases of a worker's slabs. Where another worker follows, the last slab goes first through phase A, for that worker waits for what
/// it pushes. Phase B follows A at once but for that slab and for the first ones, which those of other workers push: these come at the end.
void Step::share_of(int worker) {
  const int begin = common_.workers.first(worker, common_.slabs.count), last = common_.workers.first(worker + 1, common_.slabs.count) - 1;
  const bool another_follows = worker + 1 < common_.workers.count();
  const auto is_late = [&](int slab) { return (another_follows && slab == last) || !schedule_.follows_at_once(slab, worker); };
  const auto push = [&](int slab) {
    contacts(slab, worker, !is_late(slab));
    pushed_[slab].store(step_, std::memory_order_release);
  };
  if (another_follows) push(last);
  for (int slab = begin; slab < last; ++slab) push(slab);
  if (!another_follows) push(last);
  for (int slab = last; slab >= begin; --slab) {
    if (!is_late(slab)) continue;
    for (int earlier = schedule_.first_reference(slab); earlier < begin; ++earlier) {
      if (!common_.workers.wait_for([&] { return pushed_[earlier].load(std::memory_order_acquire) == step_; })) return;
    }
    each_stretch(slab, [&](BeadRange range) { slabs_[slab].result = first_of(slabs_[slab].result, finish(slab, worker, range)); });
  }
}

/// The beads of a slab in the stretches in which they are finished behind the pairs. Sums that body forces keep come out the same, whenever
/// that happens.
template <class Visit>
void Step::each_stretch(int slab, const Visit& visit) {
  std::int64_t begin = common_.slabs.begin(slab);
  for (const std::int64_t end : slabs_[slab].stretches) {
    visit(BeadRange{begin, end});
    begin = end;
  }
}

/// Phase A. With `finish_too` phase B trails behind: a bead is done with once the last list has passed it, and it is finished while it is
/// still in the cache.
void Step::contacts(int slab, int worker, bool finish_too) {
  SlabState& state = slabs_[slab];
  Scratch& scratch = *scratch_[worker];
  state.ledger.reset_instant();
  state.result = {false, -1};
  const bool in_ring = finish_too && schedule_.ring(slab) > 0;
  state.force = in_ring ? ForceWindow::ring(scratch.ring.data(), schedule_.ring(slab)) : ForceWindow{particles_.force.data()};
  const SlabPass pass{common_, particles_, state, scratch, slab, step_};
  WallSweep walls(pass, walls_, poses_);
  std::int64_t finished = common_.slabs.begin(slab);
  [[maybe_unused]] const auto fits_ring = [&](std::int64_t end) { return !in_ring || end - finished <= schedule_.ring(slab); };
  state.stretches.clear();
  const auto trail = [&](std::int64_t end) {
    assert(fits_ring(end));
    walls.until(end);
    state.stretches.push_back(end);
    if (finish_too) state.result = first_of(state.result, finish(slab, worker, {finished, end}));
    finished = end;
  };
  for (int p = 0; p < common_.physics.count(); ++p) {
    if (common_.physics[p].wall) continue;
    const bool is_last = p == schedule_.last_list();
    PairSweep pairs(pass, p, pairs_.of(slab, p), alike_[p]);
    for (std::int64_t first = 0; first < pairs.count(); first += kBatch) {
      pairs.batch(first, is_last ? schedule_.first_touched(slab, first + 2 * kBatch) : BeadRange{0, 0});
      assert(fits_ring(std::min(pairs.pushed_end(first), common_.slabs.end(slab))));
      if (is_last && Schedule::trails_at(first + kBatch, pairs.count())) trail(pairs.owner(first + kBatch));
    }
    pairs.end();
  }
  trail(common_.slabs.end(slab));
  walls.end();
}

/// Phase B.
IntegrateResult Step::finish(int slab, int worker, BeadRange range) {
  if (range.begin == range.end) return {false, -1};
  add_halos(slab, range);
  apply_body_forces(slab, worker, range);
  return integrate(slab, range);
}

/// The forces that earlier slabs computed for beads of this one, added in slab order.
void Step::add_halos(int slab, BeadRange range) {
  const ForceWindow force = slabs_[slab].force;
  for (int earlier = 0; earlier < slab; ++earlier) {
    AlignedVector<ForceLine>& halo = slabs_[earlier].halo;
    const std::int64_t halo_begin = common_.slabs.end(earlier), halo_end = halo_begin + std::ssize(halo);
    for (std::int64_t i = std::max(range.begin, halo_begin); i < std::min(range.end, halo_end); ++i) {
      ForceLine& from = halo[i - halo_begin];
      ForceLine& to = force[i];
      for (int a = 0; a < 3; ++a) {
        to.f[a] += from.f[a];
        to.t[a] += from.t[a];
      }
      from = ForceLine{};
    }
  }
}

void Step::apply_body_forces(int slab, int worker, BeadRange range) {
  if (!has_general_body_force_) return;
  const SlabPass pass{common_, particles_, slabs_[slab], *scratch_[worker], slab, step_};
  BodyForcePass forces(pass, body_forces_, acceleration_, time());
  for (std::int64_t begin = range.begin; begin < range.end; begin += kBatch) forces.run({begin, std::min(range.end, begin + kBatch)});
}

/// Kick, drift, predict.
IntegrateResult Step::integrate(int slab, BeadRange range) {
  const IntegrateContext context{particles_.position.data(),
                                 particles_.motion.data(),
                                 particles_.half.data(),
                                 slabs_[slab].force,
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
