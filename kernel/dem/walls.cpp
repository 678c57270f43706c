// Beads at the walls, at each list rebuild: which features are near which bead. The contacts of each step are in wall_contacts.cpp.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/base/error.hpp"
#include "kernel/dem/rows.hpp"
#include "kernel/dem/slab.hpp"

namespace millscope::dem {
namespace {

struct CarriedContact {
  std::uint32_t bead, feature;  // bead: new index
  Row normal;
  std::vector<double> history;
};

}  // namespace

void WallContacts::clear() { resize(0); }

void WallContacts::resize(std::size_t n) {
  bead.resize(n);
  feature.resize(n);
  normal.resize(n);
  for (auto& h : history) h.resize(n);
}

/// Rewrites the bead of each lasting contact as its new index; the near lists are made anew after this.
void System::extract_wall_history() {
  for (const auto& slab : slabs_) {
    for (WallSlab& wall : slab->walls) {
      for (std::uint32_t& b : wall.active.bead) b = new_index_[wall.bead[b]];
    }
  }
}

/// Asks every geometry for the features near each bead, and hands the lasting contacts to the slabs that own the beads now.
void System::build_walls() {
  const std::int64_t n = particles.count();
  const std::size_t slots = static_cast<std::size_t>(layout_.history_count());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> near;
  // reaches_ holds half of the laws' reach, for two beads share it; a wall has none of its own.
  double law_reach = 0;
  for (const PairPhysics& p : physics_) law_reach = std::max(law_reach, p.reach);
  wall_speed_ = 0;
  for (const Body& body : bodies) {
    const double rotation = std::abs(body.motion.speed) * (1 + std::abs(body.motion.ripple_amplitude));
    double translation = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      translation += std::abs(body.motion.velocity[a]) +
                     std::abs(body.motion.oscillation_amplitude[a]) * 2 * std::numbers::pi * body.motion.oscillation_frequency;
    }
    wall_speed_ = std::max(wall_speed_, rotation * body.greatest_distance + translation);
  }
  // The walls may move this far before the lists must be made anew.
  wall_moved_ = 0;
  wall_margin_ = wall_speed_ * 1.1 * settings_.skin_steps * settings_.time_step;
  // x, y, z in the body's frame, and reach, of every bead. The lines of the forces are free between steps.
  double* const lines = reinterpret_cast<double*>(particles.force.data());
  double* const coordinate[4] = {lines, lines + n, lines + 2 * n, lines + 3 * n};
  for (std::size_t body_index = 0; body_index < bodies.size(); ++body_index) {
    const Body& body = bodies[body_index];
    const Pose pose = pose_at(body.motion, time());
    workers_->run(settings_.partitions, [&](int slab, int) {
      for (std::size_t k = static_cast<std::size_t>(slab_begin(slab)); k < static_cast<std::size_t>(slab_begin(slab + 1)); ++k) {
        const Row x = to_body(pose, centre(particles.position[k]));
        for (std::size_t a = 0; a < 3; ++a) coordinate[a][k] = x[a];
        coordinate[3][k] = reaches_[k].radius + 0.5 * law_reach;
      }
    });
    const GeometryBeads beads{n, {coordinate[0], coordinate[1], coordinate[2]}, coordinate[3]};
    near.clear();
    const CandidateSink sink{&near, [](void* host, std::int64_t bead, std::uint32_t feature) {
                               static_cast<decltype(near)*>(host)->emplace_back(static_cast<std::uint32_t>(bead), feature);
                             }};
    Failure failure{};
    if (body.table->candidates(body.self, &beads, wall_margin_, &sink, &failure) != 0) {
      throw base::UserError(std::string("geometry '") + body.name + "': " + failure.message);
    }
    if (!std::is_sorted(near.begin(), near.end())) std::sort(near.begin(), near.end());

    std::vector<CarriedContact> carried;
    for (const auto& slab : slabs_) {
      WallContacts& active = slab->walls[body_index].active;
      for (std::size_t c = 0; c < active.bead.size(); ++c) {
        carried.push_back({active.bead[c], active.feature[c], active.normal[c], std::vector<double>(slots)});
        for (std::size_t h = 0; h < slots; ++h) carried.back().history[h] = active.history[h][c];
      }
      active.clear();
    }
    std::stable_sort(carried.begin(), carried.end(), [](const CarriedContact& a, const CarriedContact& b) { return a.bead < b.bead; });

    std::size_t at = 0, from = 0;
    for (int s = 0; s < settings_.partitions; ++s) {
      WallSlab& wall = slabs_[static_cast<std::size_t>(s)]->walls[body_index];
      wall.bead.clear();
      wall.first.assign(1, 0);
      wall.candidates.clear();
      const std::uint32_t end = static_cast<std::uint32_t>(slab_begin(s + 1));
      while (at < near.size() && near[at].first < end) {
        const std::uint32_t bead = near[at].first;
        const std::uint32_t local = static_cast<std::uint32_t>(wall.bead.size());
        wall.bead.push_back(bead);
        for (; at < near.size() && near[at].first == bead; ++at) wall.candidates.push_back(near[at].second);
        wall.first.push_back(static_cast<std::int64_t>(wall.candidates.size()));
        while (from < carried.size() && carried[from].bead < bead) ++from;
        for (; from < carried.size() && carried[from].bead == bead; ++from) {
          wall.active.bead.push_back(local);
          wall.active.feature.push_back(carried[from].feature);
          wall.active.normal.push_back(carried[from].normal);
          for (std::size_t h = 0; h < slots; ++h) wall.active.history[h].push_back(carried[from].history[h]);
        }
      }
    }
  }
}

}  // namespace millscope::dem
