#include "kernel/dem/system.hpp"

#include <algorithm>

#include "kernel/dem/parts.hpp"

namespace millscope::dem {

namespace {

constexpr std::int64_t kSharedAnew = 8;  ///< rebuilds after which the work of the slabs is shared out again

}  // namespace

System::System(Settings settings, Layout layout, std::vector<PairPhysics> physics, int material_count)
    : parts_(std::make_unique<Parts>(*this, std::move(settings), std::move(layout), PhysicsTable(std::move(physics), material_count))) {}

System::~System() = default;

int System::threads() const { return parts_->common.workers.count(); }
const Settings& System::settings() const { return parts_->common.settings; }
const Layout& System::layout() const { return parts_->common.layout; }
const std::vector<PairPhysics>& System::physics() const { return parts_->common.physics.all(); }
const PairLists& System::pair_lists() const { return parts_->pairs; }
const WallLists& System::wall_lists() const { return parts_->walls; }
std::int64_t System::listed_pairs() const { return parts_->pairs.count(); }
std::array<double, 3> System::acceleration() const { return parts_->step.acceleration(); }

void System::Parts::prepare(const Particles& particles) {
  common.slabs.cut_equally(particles.count());
  double largest = 0;
  for (const PositionLine& x : particles.position) largest = std::max(largest, x.radius);
  check_periods(common.settings, largest, common.physics.reach());
  pairs.clear();
  walls.clear();
  step.prepare();
}

/// A step's work on each bead as the lists of the last steps have it, in units of about a nanosecond of one core.
void System::Parts::share_work() {
  constexpr std::uint32_t kMove = 6, kListed = 2, kTouching = 15, kNearWall = 15;
  std::vector<std::uint32_t> work(order.new_index().size(), kMove);
  pairs.add_work(order.new_index(), kListed, kTouching, work);
  walls.add_work(order.new_index(), kNearWall, work);
  common.slabs.cut(work);
}

void System::start(std::int64_t step) {
  step_ = step;
  parts_->prepare(particles);
  rebuild();
}

void System::rebuild() {
  Parts& p = *parts_;
  p.order.renew(particles, time());
  if (rebuilds_ % kSharedAnew == 1 && p.common.slabs.count > 1) p.share_work();
  p.pairs.begin_rebuild(p.order, particles.material);
  p.walls.begin_rebuild(p.order, time());
  p.common.workers.run_any(2 * p.common.slabs.count, [&](int task, int) {
    const int slab = task / 2;
    if (task % 2 == 0) {
      p.pairs.rebuild(slab, p.order, particles.material);
    } else {
      p.walls.rebuild(slab, p.order, particles);
      const BeadRange beads = p.common.slabs.range(slab);
      std::fill(particles.force.begin() + beads.begin, particles.force.begin() + beads.end, ForceLine{});
    }
  });
  p.walls.end_rebuild();
  p.step.lists_changed();
  ++rebuilds_;
  rebuild_needed_ = false;
}

void System::advance() {
  if (rebuild_needed_) rebuild();
  std::function<void()> look;
  if (observe) look = [this] { observe(*this); };
  const IntegrateResult result = parts_->step.make(step_, look);
  ++step_;
  const bool walls_moved = parts_->walls.move_on();
  if (result.runaway >= 0) throw Runaway(complaint(particles, result.runaway, time(), "moved more than half its radius in one step"));
  rebuild_needed_ = rebuild_needed_ || result.rebuild || walls_moved;
}

Ledger System::ledger() const {
  const std::vector<SlabState>& slabs = parts_->step.slabs();
  Ledger total = slabs[0].ledger;
  for (std::size_t k = 1; k < slabs.size(); ++k) total.add(slabs[k].ledger);
  return total;
}

void System::velocity_at_step(std::int64_t bead, double velocity[3], double spin[3]) const {
  const MotionLine& half = particles.half[bead];
  const ForceLine& force = particles.force[bead];
  const std::array<double, 3>& acceleration = parts_->step.acceleration();
  const double h = 0.5 * settings().time_step;
  for (int a = 0; a < 3; ++a) {
    velocity[a] = half.v[a] + h * (force.f[a] * half.inverse_mass + acceleration[a]);
    spin[a] = half.w[a] + h * force.t[a] * half.inverse_inertia;
  }
}

System::KineticEnergy System::kinetic_energy() const {
  KineticEnergy sum;
  for (std::int64_t i = 0; i < particles.count(); ++i) {
    double v[3], w[3];
    velocity_at_step(i, v, w);
    const MotionLine& m = particles.motion[i];
    sum.translational += 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / m.inverse_mass;
    sum.rotational += 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / m.inverse_inertia;
  }
  return sum;
}

std::array<double, 3> System::centre_of_mass() const {
  std::array<double, 3> sum{};
  double mass = 0;
  for (std::int64_t i = 0; i < particles.count(); ++i) {
    const double m = 1.0 / particles.motion[i].inverse_mass;
    for (int a = 0; a < 3; ++a) sum[a] += m * particles.position[i].centre[a];
    mass += m;
  }
  for (double& s : sum) s /= mass;
  return sum;
}

double System::total_mass() const {
  double mass = 0;
  for (const MotionLine& m : particles.motion) mass += 1.0 / m.inverse_mass;
  return mass;
}

/// Of all slabs, in their order, what each has added up of the triangles of a body.
std::vector<double> System::triangle_sums(std::size_t body, std::vector<std::vector<double>> SlabState::*kind) const {
  const auto& slabs = parts_->step.slabs();
  std::vector<double> sum((slabs[0].*kind)[body].size(), 0.0);
  for (const SlabState& slab : slabs) {
    for (std::size_t t = 0; t < sum.size(); ++t) sum[t] += (slab.*kind)[body][t];
  }
  return sum;
}

std::vector<double> System::impact_work(std::size_t body) const { return triangle_sums(body, &SlabState::impact); }
std::vector<double> System::shear_work(std::size_t body) const { return triangle_sums(body, &SlabState::shear); }
std::vector<double> System::worn_volume(std::size_t body) const { return triangle_sums(body, &SlabState::worn); }
void System::forget_wear() { parts_->step.forget_wear(); }

}  // namespace millscope::dem
