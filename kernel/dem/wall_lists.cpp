#include "kernel/dem/wall_lists.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

bool WallLists::move_on() {
  moved_ += common_.settings.time_step * speed_;
  return moved_ > margin_;
}

/// Features near each bead, in the order of beads.
std::vector<WallLists::Near> WallLists::near(const Body& body, const CellOrder& order, Particles& particles, const Pose& pose) {
  const std::int64_t n = particles.count();
  // x, y, z in the body's frame, and reach, of every bead. The lines of the forces are free between steps.
  double* const lines = reinterpret_cast<double*>(particles.force.data());
  double* const coordinate[4] = {lines, lines + n, lines + 2 * n, lines + 3 * n};
  // Half of the laws' reach is in `reaches`, for two beads share it; a wall has none of its own.
  const double law_reach = common_.physics.reach();
  common_.each_slab([&](int slab, int) {
    const BeadRange beads = common_.slabs.range(slab);
    for (std::int64_t i = beads.begin; i < beads.end; ++i) {
      for (int a = 0; a < 3; ++a) coordinate[a][i] = particles.position[i].centre[a];
      coordinate[3][i] = order.reaches()[i].radius + 0.5 * law_reach;
    }
    common_.wide.to_frame(plain(pose), beads.end - beads.begin,
                          {coordinate[0] + beads.begin, coordinate[1] + beads.begin, coordinate[2] + beads.begin});
  });
  const GeometryBeads beads{n, {coordinate[0], coordinate[1], coordinate[2]}, coordinate[3]};
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
std::vector<WallLists::Carried> WallLists::take_contacts(int body, const std::vector<std::uint32_t>& new_index) {
  std::vector<Carried> carried;
  each_contact(body, [&](const WallList& list, std::int64_t c) {
    const WallContacts& active = list.active;
    std::vector<double> history;
    for (const std::vector<double>& h : active.history) history.push_back(h[c]);
    carried.push_back({new_index[list.bead[active.bead[c]]], active.feature[c], active.normal[c], std::move(history)});
  });
  for (SlabLists& slab : slabs_) slab.lists[body].active.resize(0);
  std::stable_sort(carried.begin(), carried.end(), [](const Carried& a, const Carried& b) { return a.bead < b.bead; });
  return carried;
}

/// Hands beads with their candidates and contacts to the slabs that own them.
void WallLists::deal(int body, const std::vector<Near>& near, const std::vector<Carried>& carried) {
  auto at = near.begin();
  auto from = carried.begin();
  for (int slab = 0; slab < common_.slabs.count; ++slab) {
    WallList& list = of(slab, body);
    list.bead.clear();
    list.first.assign(1, 0);
    list.candidates.clear();
    while (at != near.end() && at->bead < common_.slabs.end(slab)) {
      const std::uint32_t bead = at->bead, local = static_cast<std::uint32_t>(list.bead.size());
      list.bead.push_back(bead);
      for (; at != near.end() && at->bead == bead; ++at) list.candidates.push_back(at->feature);
      list.first.push_back(std::ssize(list.candidates));
      while (from != carried.end() && from->bead < bead) ++from;
      for (; from != carried.end() && from->bead == bead; ++from) {
        list.active.bead.push_back(local);
        list.active.feature.push_back(from->feature);
        list.active.normal.push_back(from->normal);
        for (std::int64_t h = 0; h < std::ssize(from->history); ++h) list.active.history[h].push_back(from->history[h]);
      }
    }
  }
}

void WallLists::rebuild(const CellOrder& order, Particles& particles, double time) {
  speed_ = greatest_speed();
  moved_ = 0;
  margin_ = speed_ * 1.1 * common_.settings.skin_steps * common_.settings.time_step;
  for (int b = 0; b < std::ssize(bodies_); ++b) {
    const std::vector<Near> found = near(bodies_[b], order, particles, pose_at(bodies_[b].motion, time));
    deal(b, found, take_contacts(b, order.new_index()));
  }
}

}  // namespace millscope::dem
