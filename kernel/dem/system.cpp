#include "kernel/dem/system.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "kernel/base/error.hpp"
#include "kernel/base/hash.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {

double wrapped(const Settings& settings, int axis, double coordinate) {
  const double length = settings.periodic.length[axis];
  return length > 0 ? coordinate - length * std::floor((coordinate - settings.periodic_low[axis]) / length) : coordinate;
}

PairListView PairList::view() {
  PairListView v{};
  v.count = static_cast<std::int64_t>(owner.size());
  v.owner = owner.data();
  v.partner = partner.data();
  v.touching = touching.data();
  v.history_count = static_cast<std::int32_t>(history.size());
  for (std::size_t h = 0; h < history.size(); ++h) {
    v.history[h] = history[h].data();
    v.next[h] = next[h].data();
  }
  return v;
}

std::int64_t PairList::contact_count() const { return std::count(touching.begin(), touching.end(), 1); }

void PairList::make_room(PairListView& v) {
  const std::size_t needed = static_cast<std::size_t>(v.written + kBatch);
  for (std::size_t h = 0; h < next.size(); ++h) {
    if (next[h].size() < needed) next[h].resize(needed + needed / 8);
    v.next[h] = next[h].data();
  }
}

void PairList::end_sweep() { history.swap(next); }

System::System(Settings settings, Layout layout, std::vector<PairPhysics> physics, int material_count)
    : settings_(std::move(settings)),
      layout_(std::move(layout)),
      physics_(std::move(physics)),
      material_count_(material_count),
      wide_(&wide_table(settings_.instruction_set.c_str())),
      workers_(std::make_unique<Workers>(std::min(settings_.threads, settings_.partitions))) {
  pair_of_.assign(static_cast<std::size_t>(material_count * material_count), -1);
  wall_pair_of_ = pair_of_;
  for (std::size_t p = 0; p < physics_.size(); ++p) {
    auto& table = physics_[p].wall ? wall_pair_of_ : pair_of_;
    table[static_cast<std::size_t>(physics_[p].first * material_count + physics_[p].second)] = static_cast<int>(p);
    if (!physics_[p].wall) table[static_cast<std::size_t>(physics_[p].second * material_count + physics_[p].first)] = static_cast<int>(p);
  }
  for (const std::string& channel : layout_.channels) {
    // "plugin.channel": what acts along the normal is impact, the rest shear.
    const std::string own = channel.substr(channel.rfind('.') + 1);
    normal_channel_.push_back(own.find("normal") != std::string::npos || own.find("adhesion") != std::string::npos);
  }
}

System::~System() = default;

int System::pair_index(int a, int b, bool wall) const {
  return (wall ? wall_pair_of_ : pair_of_)[static_cast<std::size_t>(a * material_count_ + b)];
}

/// Empty lists and books of the right shape.
void System::prepare() {
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  Ledger empty;
  empty.pairs.resize(physics_.size());
  for (PairLedger& p : empty.pairs) p.dissipated.assign(layout_.channels.size(), 0.0);
  empty.bodies.resize(bodies.size());
  empty.body_force_work.assign(body_forces.size(), 0.0);
  slabs_.clear();
  for (int k = 0; k < settings_.partitions; ++k) {
    auto slab = std::make_unique<SlabState>();
    slab->ledger = empty;
    slab->lists.resize(physics_.size());
    for (PairList& list : slab->lists) {
      list.history.resize(slots);
      list.next.resize(slots);
    }
    slab->walls.resize(bodies.size());
    slab->impact.resize(bodies.size());
    slab->shear.resize(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      slab->walls[b].active.history.resize(slots);
      slab->walls[b].next.history.resize(slots);
      const std::size_t triangles = bodies[b].per_triangle ? bodies[b].triangle_count : 0;
      slab->impact[b].assign(triangles, 0.0);
      slab->shear[b].assign(triangles, 0.0);
    }
    slabs_.push_back(std::move(slab));
  }
  scratch_.clear();
  for (int w = 0; w < workers_->count(); ++w) scratch_.push_back(std::make_unique<Scratch>(layout_.history_count()));
  poses_.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) poses_[b] = pose_at(bodies[b].motion, time());
  has_general_body_force_ = false;
  for (const BodyForceReference& f : body_forces) {
    double g[3];
    has_general_body_force_ = has_general_body_force_ || !f.table->uniform(f.self, 0.0, g);
  }
  double smallest = 1e300, largest = 0;
  for (const PositionLine& x : particles.position) {
    smallest = std::min(smallest, x.radius);
    largest = std::max(largest, x.radius);
  }
  largest_step_ = 0.5 * smallest;
  double reach = 0;
  for (const PairPhysics& p : physics_) reach = std::max(reach, p.reach);
  for (int a = 0; a < 3; ++a) {
    const double needed = 4 * (largest * (1 + settings_.skin_cap) + 0.5 * reach), length = settings_.periodic.length[a];
    if (length > 0 && length < needed) {
      char line[200];
      std::snprintf(line, sizeof line,
                    "the periodic length along %c is %.4g m; beads of this size need at least %.4g m: lengthen the slice", "xyz"[a], length,
                    needed);
      throw base::UserError(line);
    }
  }
  reaches_.resize(particles.position.size());
  list_count_ = 0;
  wall_reach_ = 0;
  for (std::size_t p = 0; p < physics_.size(); ++p) {
    if (physics_[p].wall) {
      wall_reach_ = std::max(wall_reach_, physics_[p].reach);
      continue;
    }
    last_list_ = p;
    ++list_count_;
  }
  equality_.assign(physics_.size(), Equality{});
  for (std::size_t p = 0; p < physics_.size(); ++p) {
    Equality e{true, -1, 0, {}};
    for (std::size_t i = 0; i < particles.position.size() && e.equal; ++i) {
      if (particles.material[i] != physics_[p].first && (physics_[p].wall || particles.material[i] != physics_[p].second)) continue;
      const double mass = 1.0 / particles.motion[i].inverse_mass;
      if (e.radius < 0) {
        e.radius = particles.position[i].radius;
        e.mass = mass;
      }
      e.equal = particles.position[i].radius == e.radius && mass == e.mass;
    }
    if (e.radius < 0 || !e.equal) continue;
    const double constants[3] = {0.5 * e.radius, 0.5 * e.mass, e.radius};
    for (std::size_t k = 0; k < 3; ++k) {
      e.arrays[k] = std::make_shared<AlignedVector<double>>(static_cast<std::size_t>(kBatchStride), constants[k]);
    }
    equality_[p] = e;
  }
}

void System::start(std::int64_t step) {
  step_ = step;
  prepare();
  rebuild();
}

std::int64_t System::listed_pairs() const {
  std::int64_t n = 0;
  for (const auto& slab : slabs_) {
    for (const PairList& list : slab->lists) n += static_cast<std::int64_t>(list.owner.size());
  }
  return n;
}

Ledger System::ledger() const {
  Ledger total = slabs_[0]->ledger;
  for (std::size_t k = 1; k < slabs_.size(); ++k) total.add(slabs_[k]->ledger);
  return total;
}

void System::velocity_at_step(std::int64_t bead, double velocity[3], double spin[3]) const {
  const std::size_t i = static_cast<std::size_t>(bead);
  const MotionLine& half = particles.half[i];
  const ForceLine& force = particles.force[i];
  const double h = 0.5 * settings_.time_step;
  for (std::size_t a = 0; a < 3; ++a) {
    velocity[a] = half.v[a] + h * (force.f[a] * half.inverse_mass + acceleration_[a]);
    spin[a] = half.w[a] + h * force.t[a] * half.inverse_inertia;
  }
}

System::KineticEnergy System::kinetic_energy() const {
  KineticEnergy sum;
  for (std::int64_t i = 0; i < particles.count(); ++i) {
    double v[3], w[3];
    velocity_at_step(i, v, w);
    const MotionLine& m = particles.motion[static_cast<std::size_t>(i)];
    sum.translational += 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / m.inverse_mass;
    sum.rotational += 0.5 * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]) / m.inverse_inertia;
  }
  return sum;
}

std::array<double, 3> System::centre_of_mass() const {
  std::array<double, 3> sum{};
  double mass = 0;
  for (std::size_t i = 0; i < particles.position.size(); ++i) {
    const double m = 1.0 / particles.motion[i].inverse_mass;
    const PositionLine& x = particles.position[i];
    for (std::size_t a = 0; a < 3; ++a) sum[a] += m * x.centre[a];
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

std::vector<double> System::impact_work(std::size_t body) const {
  std::vector<double> sum(slabs_[0]->impact[body].size(), 0.0);
  for (const auto& slab : slabs_) {
    for (std::size_t t = 0; t < sum.size(); ++t) sum[t] += slab->impact[body][t];
  }
  return sum;
}

std::vector<double> System::shear_work(std::size_t body) const {
  std::vector<double> sum(slabs_[0]->shear[body].size(), 0.0);
  for (const auto& slab : slabs_) {
    for (std::size_t t = 0; t < sum.size(); ++t) sum[t] += slab->shear[body][t];
  }
  return sum;
}

namespace {

void add(base::Hash& hash, double v) {
  v += 0.0;  // −0 and 0 are the same state
  hash.add(&v, sizeof v);
}

}  // namespace

std::uint64_t System::state_hash() const {
  const std::size_t n = particles.position.size();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
  base::Hash hash;
  add(hash, time());
  for (const Body& b : bodies) add(hash, pose_at(b.motion, time()).angle);
  for (const std::uint32_t i : order) {
    hash.add(&particles.id[i], sizeof particles.id[i]);
    const PositionLine& x = particles.position[i];
    // Periodic coordinates are wrapped at rebuilds only: hash them wrapped.
    for (int a = 0; a < 3; ++a) add(hash, wrapped(settings_, a, x.centre[a]));
    for (int a = 0; a < 3; ++a) add(hash, particles.half[i].v[a]);
    for (int a = 0; a < 3; ++a) add(hash, particles.half[i].w[a]);
  }
  // Histories in the order of (smaller id, larger id), as seen from the smaller.
  struct Entry {
    std::uint32_t a, b;
    const PairList* list;
    std::size_t contact;
    bool flip;
  };
  std::vector<Entry> entries;
  for (const auto& slab : slabs_) {
    for (const PairList& list : slab->lists) {
      std::size_t contact = 0;
      for (std::size_t s = 0; s < list.touching.size(); ++s) {
        if (!list.touching[s]) continue;
        const std::uint32_t i = particles.id[list.owner[s]], j = particles.id[list.partner[s]];
        entries.push_back({std::min(i, j), std::max(i, j), &list, contact++, i > j});
      }
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& p, const Entry& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
  for (const Entry& e : entries) {
    hash.add(&e.a, sizeof e.a);
    hash.add(&e.b, sizeof e.b);
    for (std::size_t h = 0; h < e.list->history.size(); ++h)
      add(hash, (e.flip ? layout_.history_sign[h] : 1) * e.list->history[h][e.contact]);
  }
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    std::vector<std::pair<std::uint32_t, std::vector<double>>> contacts;
    for (const auto& slab : slabs_) {
      const WallSlab& wall = slab->walls[body];
      for (std::size_t c = 0; c < wall.active.bead.size(); ++c) {
        std::vector<double> values;
        for (const auto& h : wall.active.history) values.push_back(h[c]);
        contacts.emplace_back(particles.id[wall.bead[wall.active.bead[c]]], std::move(values));
      }
    }
    std::stable_sort(contacts.begin(), contacts.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    for (const auto& [id, values] : contacts) {
      hash.add(&id, sizeof id);
      for (const double v : values) add(hash, v);
    }
  }
  return hash.value();
}

}  // namespace millscope::dem
