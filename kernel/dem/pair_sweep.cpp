#include "kernel/dem/pair_sweep.hpp"

#include <algorithm>
#include <cassert>

#include "kernel/dem/evaluate.hpp"

namespace millscope::dem {

std::optional<Alike> alike_of(const Particles& particles, const PairPhysics& physics) {
  if (physics.wall) return std::nullopt;
  double radius = -1, mass = 0;
  for (std::int64_t i = 0; i < particles.count(); ++i) {
    const int material = particles.material[i];
    if (material != physics.first && material != physics.second) continue;
    const double own_radius = particles.position[i].radius, own_mass = 1.0 / particles.motion[i].inverse_mass;
    if (radius < 0) {
      radius = own_radius;
      mass = own_mass;
    }
    if (own_radius != radius || own_mass != mass) return std::nullopt;
  }
  if (radius < 0) return std::nullopt;
  const auto everywhere = [](double value) { return AlignedVector<double>(kBatchStride, value); };
  return Alike{radius, 0.5 * mass, everywhere(0.5 * radius), everywhere(0.5 * mass), everywhere(radius)};
}

PairSweep::PairSweep(const SlabPass& pass, int physics_index, PairList& list, const std::optional<Alike>& alike)
    : pass_(pass),
      physics_(pass.common.physics[physics_index]),
      ledger_(pass.state.ledger.pairs[physics_index]),
      list_(list),
      view_(list.view()),
      batch_(pass.scratch.pairs),
      gather_{} {
  gather_.position = pass.particles.position.data();
  gather_.motion = pass.particles.motion.data();
  gather_.box = pass.common.settings.periodic;
  gather_.reach = physics_.reach;
  gather_.spins = !physics_.interactions.empty();
  gather_.equal = alike.has_value();
  if (!alike) return;
  gather_.radius = alike->radius;
  gather_.mass = alike->reduced_mass;
  batch_.radius = const_cast<double*>(alike->reduced_radii.data());  // `equal` keeps `gather` from writing there
  batch_.mass = const_cast<double*>(alike->reduced_masses.data());
  batch_.radius_i = batch_.radius_j = const_cast<double*>(alike->radii.data());
}

/// The owners of the next batch but one: nothing has touched them yet, and partners come before their owners. Their lines are asked for.
void PairSweep::look_ahead(std::int64_t first) {
  const std::int64_t begin = first + 2 * kBatch, end = std::min(view_.count, begin + kBatch);
  gather_.ahead = gather_.ahead_end = 0;
  if (begin >= end) return;
  gather_.ahead = view_.owner[begin - 1] + 1;
  gather_.ahead_end = view_.owner[end - 1] + 1;
  gather_.ahead_force = pass_.force.is_ring() ? nullptr : &pass_.force[gather_.ahead];
}

void PairSweep::batch(std::int64_t first) {
  look_ahead(first);
  const std::int64_t last = std::min(view_.count, first + kBatch);
  const WideTable& wide = pass_.common.wide;
  const std::int64_t count = wide.search(gather_, view_, first, last, batch_);
  assert(list_.history.empty() || view_.read <= std::ssize(list_.history[0]));
  if (count == 0) return;
  list_.make_room(view_);
  wide.gather(gather_, view_, count, batch_);
  book_contacts(pass_.step, count, batch_, ledger_);
  evaluate({&physics_, pass_.common.settings.time_step, count, false}, batch_, ledger_);
  PushLog& log = pass_.state.log;
  ScatterContext scatter{pass_.force, gather_.equal, nullptr, nullptr, pass_.note_before};
  if (pass_.note_before > 0) {
    log.make_room();
    scatter.noted_bead = log.bead.data() + log.count;
    scatter.noted_push = log.push.data() + log.count;
  }
  log.count += wide.scatter(scatter, view_, count, physics_.has_post(), batch_);
  assert(list_.next.empty() || view_.written <= std::ssize(list_.next[0]));
}

}  // namespace millscope::dem
