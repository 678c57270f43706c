#include "kernel/dem/wall_lists.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernel/base/error.hpp"

namespace millscope::dem {

void WallLists::clear() {
  WallList empty;
  empty.active.history.resize(common_.layout.history_count());
  empty.next.history.resize(common_.layout.history_count());
  slabs_.assign(common_.slabs.count, SlabLists{std::vector<WallList>(bodies_.size(), empty)});
}

/// m/s, a bound.
double WallLists::greatest_speed() const {
  double greatest = 0;
  for (const Body& body : bodies_) {
    const Motion& m = body.motion;
    const double rotation = std::abs(m.speed) * (1 + std::abs(m.ripple_amplitude));
    double translation = 0;
    for (int a = 0; a < 3; ++a) {
      translation += std::abs(m.velocity[a]) + std::abs(m.oscillation_amplitude[a]) * 2 * std::numbers::pi * m.oscillation_frequency;
    }
    greatest = std::max(greatest, rotation * body.greatest_distance + translation);
  }
  return greatest;
}

void WallLists::add_work(const std::vector<std::uint32_t>& new_index, std::uint32_t near, std::vector<std::uint32_t>& work) const {
  for (const SlabLists& slab : slabs_) {
    for (const WallList& list : slab.lists) {
      for (const std::uint32_t bead : list.bead) work[new_index[bead]] += near;
    }
  }
}

bool WallLists::move_on() {
  moved_ += common_.settings.time_step * speed_;
  return moved_ > margin_;
}

/// Those of a slab in the frame of a body, with what they may reach until the next rebuild. They stand in the slab's lines of forces, which
/// are free between steps.
GeometryBeads WallLists::beads_of(int slab, int body, const CellOrder& order, Particles& particles) const {
  const BeadRange range = common_.slabs.range(slab);
  const std::int64_t n = range.end - range.begin;
  double* const lines = reinterpret_cast<double*>(particles.force.data() + range.begin);
  double* const place[3] = {lines, lines + n, lines + 2 * n};
  double* const radius = lines + 3 * n;
  // Half of the laws' reach is in that of a bead, for two beads share it; a wall has none of its own.
  const double law_reach = common_.physics.reach();
  for (std::int64_t k = 0; k < n; ++k) {
    const std::int64_t i = range.begin + k;
    for (int a = 0; a < 3; ++a) place[a][k] = particles.position[i].centre[a];
    radius[k] = order.reach(i) + 0.5 * law_reach;
  }
  common_.wide.to_frame(poses_[body], n, place);
  return {n, {place[0], place[1], place[2]}, radius};
}

/// Features near each of the beads, in their order.
std::vector<WallLists::Near> WallLists::near(const Body& body, const GeometryBeads& beads) const {
  std::vector<Near> found;
  const CandidateSink sink{&found, [](void* host, std::int64_t bead, std::uint32_t feature) {
                             static_cast<std::vector<Near>*>(host)->push_back({static_cast<std::uint32_t>(bead), feature});
                           }};
  Failure failure{};
  if (body.table->candidates(body.self, &beads, margin_, &sink, &failure) != 0) {
    throw base::UserError(std::string("geometry '") + body.name + "': " + failure.message);
  }
  if (!std::is_sorted(found.begin(), found.end())) std::sort(found.begin(), found.end());
  return found;
}

/// The contacts of the last step, in the order of the beads' new numbers; the lists have them no more.
void WallLists::take_contacts(int body, const std::vector<std::uint32_t>& new_index) {
  Carried& carried = carried_[body];
  const auto new_bead = [&](const WallList& list, std::int64_t c) { return new_index[list.bead[list.active.bead[c]]]; };
  carried.first.assign(new_index.size() + 1, 0);
  each_contact(body, [&](const WallList& list, std::int64_t c) { ++carried.first[new_bead(list, c)]; });
  std::exclusive_scan(carried.first.begin(), carried.first.end(), carried.first.begin(), std::uint32_t{0});
  carried.contacts.resize(carried.first.back());
  std::vector<std::uint32_t> next(carried.first.begin(), carried.first.end() - 1);
  each_contact(body, [&](const WallList& list, std::int64_t c) {
    const WallContacts& active = list.active;
    carried.contacts[next[new_bead(list, c)]++] = {active.feature[c], active.normal[c], std::ssize(carried.history)};
    for (const std::vector<double>& h : active.history) carried.history.push_back(h[c]);
  });
  for (SlabLists& slab : slabs_) slab.lists[body].active.resize(0);
}

/// Makes the list of a slab: its beads with their candidates and contacts.
void WallLists::deal(int slab, int body, const std::vector<Near>& near) {
  const Carried& carried = carried_[body];
  WallList& list = of(slab, body);
  list.bead.clear();
  list.first.assign(1, 0);
  list.candidates.clear();
  for (auto at = near.begin(); at != near.end();) {
    const std::uint32_t in_slab = at->bead, bead = static_cast<std::uint32_t>(common_.slabs.begin(slab)) + in_slab;
    const std::uint32_t local = static_cast<std::uint32_t>(list.bead.size());
    list.bead.push_back(bead);
    for (; at != near.end() && at->bead == in_slab; ++at) list.candidates.push_back(at->feature);
    list.first.push_back(std::ssize(list.candidates));
    for (std::uint32_t c = carried.first[bead]; c < carried.first[bead + 1]; ++c) {
      const Contact& contact = carried.contacts[c];
      list.active.bead.push_back(local);
      list.active.feature.push_back(contact.feature);
      list.active.normal.push_back(contact.normal);
      for (std::int64_t h = 0; h < std::ssize(list.active.history); ++h) {
        list.active.history[h].push_back(carried.history[contact.history + h]);
      }
    }
  }
}

void WallLists::begin_rebuild(const CellOrder& order, double time) {
  speed_ = greatest_speed();
  moved_ = 0;
  margin_ = speed_ * 1.1 * common_.settings.skin_steps * common_.settings.time_step;
  poses_.clear();
  carried_.assign(bodies_.size(), {});
  for (int b = 0; b < std::ssize(bodies_); ++b) {
    poses_.push_back(plain(pose_at(bodies_[b].motion, time)));
    take_contacts(b, order.new_index());
  }
}

void WallLists::rebuild(int slab, const CellOrder& order, Particles& particles) {
  for (int b = 0; b < std::ssize(bodies_); ++b) deal(slab, b, near(bodies_[b], beads_of(slab, b, order, particles)));
}

}  // namespace millscope::dem
