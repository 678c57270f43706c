// Everything that the next step depends on, as named arrays: a restored system continues bit for bit.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kernel/dem/slab.hpp"
#include "kernel/dem/state_visitors.hpp"

namespace millscope::dem {
namespace {

/// Lists of the slab of the beads [begin, end), of `beads` in all.
void demand_sound(const PairList& list, BeadRange slab, std::int64_t beads) {
  demand(list.partner.size() == list.owner.size() && list.touching.size() == list.owner.size());
  for (std::size_t s = 0; s < list.owner.size(); ++s) {
    demand(list.owner[s] >= slab.begin && list.owner[s] < slab.end && list.partner[s] > list.owner[s] && list.partner[s] < beads);
    demand(list.touching[s] <= 1 && (s == 0 || list.owner[s] >= list.owner[s - 1]));
  }
  const std::int64_t contacts = list.contact_count();
  for (const std::vector<double>& h : list.history) demand(std::ssize(h) == contacts);
}

/// Candidates are the geometry's own: the seal alone guards them.
void demand_sound(const WallSlab& wall, BeadRange slab) {
  demand(wall.first.size() == wall.bead.size() + 1 || (wall.first.empty() && wall.bead.empty()));
  for (std::size_t k = 0; k < wall.bead.size(); ++k) {
    demand(wall.bead[k] >= slab.begin && wall.bead[k] < slab.end && (k == 0 || wall.bead[k] > wall.bead[k - 1]));
    demand(wall.first[k] >= 0 && wall.first[k] <= wall.first[k + 1]);
  }
  demand(wall.first.empty() || wall.first.back() == std::ssize(wall.candidates));
  for (const std::uint32_t bead : wall.active.bead) demand(bead < wall.bead.size());
}

/// All beads once, of materials that there are.
void demand_sound(const Particles& p, int material_count) {
  const std::size_t n = p.position.size();
  demand(n < (std::size_t{1} << 31));
  demand(p.motion.size() == n && p.half.size() == n && p.acceleration.size() == n && p.reference.size() == n && p.id.size() == n &&
         p.material.size() == n);
  std::vector<bool> seen(n, false);
  for (const std::uint32_t id : p.id) {
    demand(id < n && !seen[id]);
    seen[id] = true;
  }
  demand(std::all_of(p.material.begin(), p.material.end(), [=](std::uint8_t m) { return m < material_count; }));
}

/// Every number of the ledgers in a fixed order.
template <class Slabs>
auto numbers_of(Slabs& slabs) {
  std::vector<decltype(&slabs[0]->ledger.pairs[0].impact_energy)> all;
  for (auto& slab : slabs) {
    for (auto& p : slab->ledger.pairs) {
      for (auto& d : p.dissipated) all.push_back(&d);
      all.insert(all.end(), {&p.impact_energy, &p.largest_closing_speed, &p.largest_overlap});
    }
    for (auto& b : slab->ledger.bodies) all.push_back(&b.work);
    for (auto& w : slab->ledger.body_force_work) all.push_back(&w);
  }
  return all;
}

template <class Slabs>
auto counts_of(Slabs& slabs) {
  std::vector<decltype(&slabs[0]->ledger.pairs[0].collisions)> all;
  for (auto& slab : slabs) {
    for (auto& p : slab->ledger.pairs) {
      all.push_back(&p.collisions);
      for (auto& s : p.spectrum) all.push_back(&s);
    }
  }
  return all;
}

/// The same part of every slab.
template <class Slabs, class Access>
auto across(Slabs& slabs, const Access& access) {
  std::vector<decltype(&access(*slabs[0]))> all;
  for (auto& slab : slabs) all.push_back(&access(*slab));
  return all;
}

template <class Numbers>
auto pointers_to(Numbers& numbers) {
  std::vector<decltype(&numbers[0])> all;
  for (auto& number : numbers) all.push_back(&number);
  return all;
}

}  // namespace

std::array<std::int64_t, 6> System::counters() const {
  return {step_, rebuilds_, rebuild_needed_ ? 1 : 0, settings_.partitions, layout_.history_count(), std::ssize(physics_)};
}

template <class Self, class Visit>
void System::each_bead_array(Self& s, Visit& visit) {
  visit.scalars("walls_moved", std::vector{&s.wall_margin_, &s.wall_moved_, &s.wall_speed_});
  auto& p = s.particles;
  visit.whole("position", p.position);
  visit.whole("motion", p.motion);
  visit.whole("half", p.half);
  visit.whole("acceleration", p.acceleration);
  visit.whole("reference", p.reference);
  visit.whole("id", p.id);
  visit.whole("material", p.material);
  visit.idle(p.force);
  visit.idle(s.reaches_);
  visit.idle(s.new_index_);
  visit.idle(s.carried_start_);
}

template <class Self, class Visit>
void System::each_pair_array(Self& s, Visit& visit) {
  for (std::size_t q = 0; q < s.physics_.size(); ++q) {
    const std::string at = fmt::format("pairs/{}/", q);
    const auto lists = across(
        s.slabs_, [q](auto& slab) -> auto& { return slab.lists[q]; });
    const auto count = visit.lengths(at + "count", lists, [](const PairList& l) { return std::ssize(l.owner); });
    visit.parts(at + "owner", count, lists, &PairList::owner);
    visit.parts(at + "partner", count, lists, &PairList::partner);
    visit.parts(at + "touching", count, lists, &PairList::touching);
    const auto contacts = visit.lengths(at + "contacts", lists, &PairList::contact_count);
    for (int h = 0; h < s.layout_.history_count(); ++h) {
      visit.parts(
          fmt::format("{}contact_history_{}", at, h), contacts, lists, [h](auto& l) -> auto& { return l.history[h]; });
      for (const PairList* l : lists) visit.idle(l->next[h]);
    }
  }
  for (const auto& slab : s.slabs_) visit.idle(slab->halo);
}

template <class Self, class Visit>
void System::each_wall_array(Self& s, Visit& visit) {
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const std::string at = fmt::format("walls/{}/", b);
    const auto walls = across(
        s.slabs_, [b](auto& slab) -> auto& { return slab.walls[b]; });
    const auto active = across(
        s.slabs_, [b](auto& slab) -> auto& { return slab.walls[b].active; });
    const auto beads = visit.lengths(at + "beads", walls, [](const WallSlab& w) { return std::ssize(w.bead); });
    visit.parts(at + "bead", beads, walls, &WallSlab::bead);
    const auto offsets = visit.lengths(at + "offsets", walls, [](const WallSlab& w) { return std::ssize(w.first); });
    visit.parts(at + "first", offsets, walls, &WallSlab::first);
    const auto candidates = visit.lengths(at + "candidate_count", walls, [](const WallSlab& w) { return std::ssize(w.candidates); });
    visit.parts(at + "candidates", candidates, walls, &WallSlab::candidates);
    const auto contacts = visit.lengths(at + "contacts", active, [](const WallContacts& c) { return std::ssize(c.bead); });
    visit.parts(at + "contact_bead", contacts, active, &WallContacts::bead);
    visit.parts(at + "contact_feature", contacts, active, &WallContacts::feature);
    visit.parts(at + "contact_normal", contacts, active, &WallContacts::normal);
    for (int h = 0; h < s.layout_.history_count(); ++h) {
      visit.parts(
          fmt::format("{}history_{}", at, h), contacts, active, [h](auto& c) -> auto& { return c.history[h]; });
    }
    for (const WallSlab* wall : walls) {
      for (const auto& h : wall->next.history) visit.idle(h);
      visit.idle(wall->next.bead);
      visit.idle(wall->next.feature);
      visit.idle(wall->next.normal);
    }
    const std::vector<std::int64_t> triangles(s.slabs_.size(), std::ssize(s.slabs_[0]->impact[b]));
    const auto slabs = across(
        s.slabs_, [](auto& slab) -> auto& { return slab; });
    visit.parts(
        at + "impact", triangles, slabs, [b](auto& slab) -> auto& { return slab.impact[b]; });
    visit.parts(
        at + "shear", triangles, slabs, [b](auto& slab) -> auto& { return slab.shear[b]; });
  }
}

template <class Self, class Visit>
void System::each_list_array(Self& s, Visit& visit) {
  each_pair_array(s, visit);
  each_wall_array(s, visit);
  visit.scalars("ledger/numbers", numbers_of(s.slabs_));
  visit.scalars("ledger/counts", counts_of(s.slabs_));
}

void System::save(const DoubleSink& doubles, const IntegerSink& integers) const {
  StateWriter visit(doubles, integers);
  const std::array<std::int64_t, 6> now = counters();
  visit.scalars("counters", pointers_to(now));
  each_bead_array(*this, visit);
  each_list_array(*this, visit);
}

void System::restore(const DoubleSource& doubles, const IntegerSource& integers) {
  StateReader visit(doubles, integers);
  const std::array<std::int64_t, 6> own = counters();
  std::array<std::int64_t, 6> saved{};
  visit.scalars("counters", pointers_to(saved));
  if (!std::equal(saved.begin() + 3, saved.end(), own.begin() + 3)) {
    throw base::UserError(
        "the checkpoint was written with other plugins, materials or run.partitions than the case has now; put them back");
  }
  step_ = saved[0];
  each_bead_array(*this, visit);
  demand_sound(particles, material_count_);
  particles.force.assign(particles.position.size(), ForceLine{});
  prepare();
  rebuilds_ = saved[1];
  rebuild_needed_ = saved[2] != 0;
  each_list_array(*this, visit);
  for (int slab = 0; slab < settings_.partitions; ++slab) {
    SlabState& state = *slabs_[slab];
    std::int64_t end = beads_of(slab).end;
    for (const PairList& list : state.lists) {
      demand_sound(list, beads_of(slab), particles.count());
      for (const std::uint32_t partner : list.partner) end = std::max<std::int64_t>(end, partner + 1);
    }
    for (const WallSlab& wall : state.walls) demand_sound(wall, beads_of(slab));
    state.halo.assign(end - beads_of(slab).end, ForceLine{});
  }
  prepare_sweeps();
}

std::size_t System::memory_bytes() const {
  StateBytes bytes;
  each_bead_array(*this, bytes);
  each_list_array(*this, bytes);
  return bytes.count();
}

}  // namespace millscope::dem
