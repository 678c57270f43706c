// Everything that the next step depends on, as named arrays: a restored system continues bit for bit.
#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "kernel/dem/parts.hpp"
#include "kernel/dem/state_visitors.hpp"

namespace millscope::dem {
namespace {

/// Lists of the slab of the beads [begin, end).
void demand_sound(const PairList& list, BeadRange slab) {
  demand(list.partner.size() == list.owner.size() && list.touching.size() == list.owner.size());
  for (std::size_t s = 0; s < list.owner.size(); ++s) {
    demand(list.owner[s] >= slab.begin && list.owner[s] < slab.end && list.partner[s] < list.owner[s]);
    demand(list.touching[s] <= 1 && (s == 0 || list.owner[s] >= list.owner[s - 1]));
  }
  const std::int64_t contacts = list.contact_count();
  for (const std::vector<double>& h : list.history) demand(std::ssize(h) == contacts);
}

/// Candidates are the geometry's own: the seal alone guards them.
void demand_sound(const WallList& wall, BeadRange slab) {
  demand(wall.first.size() == wall.bead.size() + 1 || (wall.first.empty() && wall.bead.empty()));
  for (std::size_t k = 0; k < wall.bead.size(); ++k) {
    demand(wall.bead[k] >= slab.begin && wall.bead[k] < slab.end && (k == 0 || wall.bead[k] > wall.bead[k - 1]));
    demand(wall.first[k] >= 0 && wall.first[k] <= wall.first[k + 1]);
  }
  demand(wall.first.empty() || wall.first.back() == std::ssize(wall.candidates));
  for (const std::uint32_t bead : wall.active.bead) demand(bead < wall.bead.size());
}

void demand_sound(const Slabs& slabs, std::int64_t beads) {
  demand(slabs.bounds.front() == 0 && slabs.bounds.back() == beads && std::is_sorted(slabs.bounds.begin(), slabs.bounds.end()));
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

/// The same part of every slab.
template <class Slabs, class Access>
auto across(Slabs& slabs, const Access& access) {
  std::vector<decltype(&access(slabs[0]))> all;
  for (auto& slab : slabs) all.push_back(&access(slab));
  return all;
}

template <class Numbers>
auto pointers_to(Numbers& numbers) {
  return across(
      numbers, [](auto& number) -> auto& { return number; });
}

}  // namespace

template <class Self, class Visit>
void PairLists::each_array(Self& self, Visit& visit) {
  const int histories = self.common_.layout.history_count();
  for (int q = 0; q < self.common_.physics.count(); ++q) {
    const std::string at = fmt::format("pairs/{}/", q);
    const auto lists = across(
        self.slabs_, [q](auto& slab) -> auto& { return slab.lists[q]; });
    const auto count = visit.lengths(at + "count", lists, &PairList::count);
    visit.parts(at + "owner", count, lists, &PairList::owner);
    visit.parts(at + "partner", count, lists, &PairList::partner);
    visit.parts(at + "touching", count, lists, &PairList::touching);
    const auto contacts = visit.lengths(at + "contacts", lists, &PairList::contact_count);
    for (int h = 0; h < histories; ++h) {
      visit.parts(
          fmt::format("{}contact_history_{}", at, h), contacts, lists, [h](auto& list) -> auto& { return list.history[h]; });
      for (const PairList* list : lists) visit.idle(list->next[h]);
    }
  }
  for (const SlabLists& slab : self.slabs_) {
    for (const std::vector<std::uint32_t>& first : slab.first) visit.idle(first);
  }
  visit.idle(self.carried_.start);
  visit.idle(self.carried_.filled);
  visit.idle(self.carried_.partner);
  visit.idle(self.carried_.history);
}

template <class Self, class Visit>
void WallLists::each_array(Self& self, int body, Visit& visit) {
  const std::string at = fmt::format("walls/{}/", body);
  const auto lists = across(
      self.slabs_, [body](auto& slab) -> auto& { return slab.lists[body]; });
  const auto active = across(
      self.slabs_, [body](auto& slab) -> auto& { return slab.lists[body].active; });
  const auto beads = visit.lengths(at + "beads", lists, [](const WallList& list) { return std::ssize(list.bead); });
  visit.parts(at + "bead", beads, lists, &WallList::bead);
  const auto offsets = visit.lengths(at + "offsets", lists, [](const WallList& list) { return std::ssize(list.first); });
  visit.parts(at + "first", offsets, lists, &WallList::first);
  const auto candidates = visit.lengths(at + "candidate_count", lists, [](const WallList& list) { return std::ssize(list.candidates); });
  visit.parts(at + "candidates", candidates, lists, &WallList::candidates);
  const auto contacts = visit.lengths(at + "contacts", active, &WallContacts::count);
  visit.parts(at + "contact_bead", contacts, active, &WallContacts::bead);
  visit.parts(at + "contact_feature", contacts, active, &WallContacts::feature);
  visit.parts(at + "contact_normal", contacts, active, &WallContacts::normal);
  for (int h = 0; h < self.common_.layout.history_count(); ++h) {
    visit.parts(
        fmt::format("{}history_{}", at, h), contacts, active, [h](auto& c) -> auto& { return c.history[h]; });
  }
  for (const WallList* list : lists) {
    visit.idle(list->next.bead);
    visit.idle(list->next.feature);
    visit.idle(list->next.normal);
    for (const std::vector<double>& h : list->next.history) visit.idle(h);
  }
}

template <class Self, class Visit>
void WallLists::each_number(Self& self, Visit& visit) {
  visit.scalars("walls_moved", std::vector{&self.margin_, &self.moved_, &self.speed_});
}

/// Kept with the lists of the body.
template <class Self, class Visit>
void Step::each_work(Self& self, int body, Visit& visit) {
  const std::string at = fmt::format("walls/{}/", body);
  const auto slabs = pointers_to(self.slabs_);
  assert(!slabs.empty());  // `start` makes them
  const std::vector<std::int64_t> triangles(slabs.size(), std::ssize(slabs[0]->impact[body]));
  visit.parts(
      at + "impact", triangles, slabs, [body](auto& slab) -> auto& { return slab.impact[body]; });
  visit.parts(
      at + "shear", triangles, slabs, [body](auto& slab) -> auto& { return slab.shear[body]; });
  if (slabs[0]->worn[body].empty()) return;  // no wear laws: as in checkpoints of before there were any
  visit.parts(
      at + "worn", triangles, slabs, [body](auto& slab) -> auto& { return slab.worn[body]; });
}

template <class Self, class Visit>
void Step::each_book(Self& self, Visit& visit) {
  std::vector<decltype(&self.slabs_[0].ledger.bodies[0].work)> numbers;
  std::vector<decltype(&self.slabs_[0].ledger.pairs[0].collisions)> counts;
  for (auto& slab : self.slabs_) {
    for (auto& p : slab.ledger.pairs) {
      for (auto& channel : p.dissipated) numbers.push_back(&channel);
      for (auto& volume : p.worn) numbers.push_back(&volume);
      numbers.insert(numbers.end(), {&p.impact_energy, &p.largest_closing_speed, &p.largest_overlap});
      counts.push_back(&p.collisions);
      for (auto& bin : p.spectrum) counts.push_back(&bin);
    }
    for (auto& b : slab.ledger.bodies) numbers.push_back(&b.work);
    for (auto& w : slab.ledger.body_force_work) numbers.push_back(&w);
    visit.idle(slab.log.bead);
    visit.idle(slab.log.push);
  }
  visit.scalars("ledger/numbers", numbers);
  visit.scalars("ledger/counts", counts);
}

template <class Self, class SelfParts, class Visit>
void System::each_bead_array(Self& self, SelfParts& parts, Visit& visit) {
  WallLists::each_number(parts.walls, visit);
  visit.whole("position", self.particles.position);
  visit.whole("motion", self.particles.motion);
  visit.whole("half", self.particles.half);
  visit.whole("acceleration", self.particles.acceleration);
  visit.whole("reference", self.particles.reference);
  visit.whole("id", self.particles.id);
  visit.whole("material", self.particles.material);
  visit.idle(self.particles.force);
  parts.order.each_idle(visit);
}

template <class Self, class SelfParts, class Visit>
void System::each_list_array(Self& self, SelfParts& parts, Visit& visit) {
  visit.scalars("slabs", pointers_to(parts.common.slabs.bounds));
  PairLists::each_array(parts.pairs, visit);
  for (int body = 0; body < std::ssize(self.bodies); ++body) {
    WallLists::each_array(parts.walls, body, visit);
    Step::each_work(parts.step, body, visit);
  }
  Step::each_book(parts.step, visit);
}

/// Time and shape of the state.
std::array<std::int64_t, 6> System::counters() const {
  return {step_, rebuilds_, rebuild_needed_, settings().partitions, layout().history_count(), std::ssize(physics())};
}

void System::save(const DoubleSink& doubles, const IntegerSink& integers) const {
  StateWriter visit(doubles, integers);
  const std::array<std::int64_t, 6> now = counters();
  visit.scalars("counters", pointers_to(now));
  each_bead_array(*this, std::as_const(*parts_), visit);
  each_list_array(*this, std::as_const(*parts_), visit);
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
  rebuilds_ = saved[1];
  rebuild_needed_ = saved[2] != 0;
  Parts& parts = *parts_;
  each_bead_array(*this, parts, visit);
  demand_sound(particles, parts.common.physics.material_count());
  particles.force.assign(particles.position.size(), ForceLine{});
  parts.prepare(particles);
  each_list_array(*this, parts, visit);
  demand_sound(parts.common.slabs, particles.count());
  for (int slab = 0; slab < parts.common.slabs.count; ++slab) {
    const BeadRange beads = parts.common.slabs.range(slab);
    for (int q = 0; q < parts.common.physics.count(); ++q) demand_sound(parts.pairs.of(slab, q), beads);
    for (int body = 0; body < std::ssize(bodies); ++body) demand_sound(parts.walls.of(slab, body), beads);
  }
  parts.step.lists_changed();
}

std::size_t System::memory_bytes() const {
  StateBytes bytes;
  each_bead_array(*this, std::as_const(*parts_), bytes);
  each_list_array(*this, std::as_const(*parts_), bytes);
  return bytes.count();
}

}  // namespace millscope::dem
