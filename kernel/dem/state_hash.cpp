// What makes two states equal: not how the lists are cut, not when they were made.
#include <algorithm>
#include <numeric>

#include "kernel/base/hash.hpp"
#include "kernel/dem/parts.hpp"

namespace millscope::dem {
namespace {

void add(base::Hash& hash, std::uint32_t v) { hash.add(&v, sizeof v); }
void add(base::Hash& hash, double v) {
  v += 0.0;  // −0 and 0 are the same state
  hash.add(&v, sizeof v);
}

void add_beads(base::Hash& hash, const Particles& particles, const Settings& settings) {
  std::vector<std::uint32_t> order(particles.id.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
  for (const std::uint32_t i : order) {
    add(hash, particles.id[i]);
    // Periodic coordinates are wrapped at rebuilds only: hash them wrapped.
    for (int a = 0; a < 3; ++a) add(hash, wrapped(settings, a, particles.position[i].centre[a]));
    for (const double v : particles.half[i].v) add(hash, v);
    for (const double w : particles.half[i].w) add(hash, w);
  }
}

/// Histories in the order of (smaller id, larger id), as seen from the smaller.
void add_pairs(base::Hash& hash, const PairLists& pairs, const std::vector<std::uint32_t>& id, const std::vector<int>& history_sign) {
  struct Entry {
    std::uint32_t smaller, larger;
    const PairList* list;
    std::int64_t contact;
    bool flip;
  };
  std::vector<Entry> entries;
  pairs.each_contact([&](const PairList& list, std::int64_t slot, std::int64_t contact) {
    const std::uint32_t i = id[list.owner[slot]], j = id[list.partner[slot]];
    entries.push_back({std::min(i, j), std::max(i, j), &list, contact, i > j});
  });
  std::sort(entries.begin(), entries.end(),
            [](const Entry& p, const Entry& q) { return p.smaller != q.smaller ? p.smaller < q.smaller : p.larger < q.larger; });
  for (const Entry& e : entries) {
    add(hash, e.smaller);
    add(hash, e.larger);
    for (std::size_t h = 0; h < history_sign.size(); ++h) add(hash, (e.flip ? history_sign[h] : 1) * e.list->history[h][e.contact]);
  }
}

/// Contacts with one body in the order of ids.
void add_walls(base::Hash& hash, const WallLists& walls, int body, const std::vector<std::uint32_t>& id) {
  struct Entry {
    std::uint32_t id;
    const WallContacts* contacts;
    std::int64_t contact;
  };
  std::vector<Entry> entries;
  walls.each_contact(body, [&](const WallList& list, std::int64_t contact) {
    entries.push_back({id[list.bead[list.active.bead[contact]]], &list.active, contact});
  });
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& p, const Entry& q) { return p.id < q.id; });
  for (const Entry& e : entries) {
    add(hash, e.id);
    for (const std::vector<double>& h : e.contacts->history) add(hash, h[e.contact]);
  }
}

}  // namespace

std::uint64_t System::state_hash() const {
  base::Hash hash;
  add(hash, time());
  for (const Body& b : bodies) add(hash, pose_at(b.motion, time()).angle);
  add_beads(hash, particles, settings());
  add_pairs(hash, parts_->pairs, particles.id, layout().history_sign);
  for (int body = 0; body < std::ssize(bodies); ++body) add_walls(hash, parts_->walls, body, particles.id);
  return hash.value();
}

}  // namespace millscope::dem
