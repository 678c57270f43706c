// The parts of a system by themselves: order, lists, schedule; no plugin, no step.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <set>

#include "dem/lists.hpp"
#include "kernel/dem/schedule.hpp"
#include "kernel/dem/wall_lists.hpp"
#include "millscope/random.hpp"

using namespace millscope;
using namespace millscope::dem;
using namespace dem_test;

namespace {

constexpr double kSide = 0.05, kBeadRadius = 2.5e-3;  // m

Particles strewn(std::int64_t count, std::uint64_t seed) {
  Random random(seed);
  Particles p;
  p.resize(count);
  for (std::int64_t i = 0; i < count; ++i) {
    p.position[i].radius = kBeadRadius;
    for (double& c : p.position[i].centre) c = kSide * random.uniform();
    p.id[i] = static_cast<std::uint32_t>(i);
  }
  return p;
}

/// Those with odd ids are of another material.
Particles two_kinds(std::int64_t count, std::uint64_t seed) {
  Particles p = strewn(count, seed);
  for (std::int64_t i = 0; i < count; ++i) p.material[i] = static_cast<std::uint8_t>(i % 2);
  return p;
}

/// A geometry that says of each bead which features are near.
struct MadeUpWall {
  std::map<std::int64_t, std::set<std::uint32_t>> near;  ///< by bead
  BeadRange asked{0, 0};                                 ///< the slab whose beads are asked for
};
const GeometryTable kMadeUp = [] {
  GeometryTable t{};
  t.candidates = [](void* self, const GeometryBeads*, double, const CandidateSink* sink, Failure*) -> Status {
    const MadeUpWall& wall = *static_cast<MadeUpWall*>(self);
    for (const auto& [bead, features] : wall.near) {
      if (bead < wall.asked.begin || bead >= wall.asked.end) continue;
      for (const std::uint32_t f : features) sink->add(sink->host, bead - wall.asked.begin, f);
    }
    return 0;
  };
  return t;
}();

void rebuild_walls(Lists& l, WallLists& walls, MadeUpWall& wall) {
  walls.begin_rebuild(l.order, 0);
  for (int slab = 0; slab < l.common.slabs.count; ++slab) {
    wall.asked = l.common.slabs.range(slab);
    walls.rebuild(slab, l.order, l.particles);
  }
}

}  // namespace

TEST_CASE("histories follow their pairs through a rebuild, and odd ones change sign with the owner") {
  for (const bool several : {false, true}) {
    INFO((several ? "two materials" : "one material"));
    Lists l(several ? two_kinds(300, 1) : strewn(300, 1), open_box(1, 4), several ? two_materials() : one_material());
    l.touch();
    std::int64_t touching = 0;
    l.pairs.each_contact([&](const PairList&, std::int64_t, std::int64_t) { ++touching; });
    REQUIRE(touching > 100);
    // Seen in a mirror the order of cells is another, and what is near stays near.
    for (PositionLine& x : l.particles.position) {
      for (double& c : x.centre) c = kSide - c;
    }
    l.rebuild();
    std::int64_t exchanged = 0, kept = 0;
    std::map<int, std::int64_t> exchanged_of;  // pairs of materials
    for (int slab = 0; slab < l.common.slabs.count; ++slab) {
      l.pairs.each_contact(slab, [&](const PairList& list, std::int64_t slot, std::int64_t contact) {
        const std::uint32_t i = list.owner[slot], j = list.partner[slot];
        const double sign = l.particles.id[i] < l.particles.id[j] ? 1 : -1;
        const int p = l.common.physics.of_beads(l.particles.material[i], l.particles.material[j]);
        CHECK(&list == &l.pairs.of(slab, p));
        CHECK(list.history[0][contact] == l.name(i, j));
        CHECK(list.history[1][contact] == sign * l.name(i, j));
        exchanged += sign < 0;
        exchanged_of[p] += sign < 0;
        ++kept;
      });
    }
    CHECK(kept == touching);
    CHECK(exchanged > 20);
    CHECK(exchanged < kept - 20);
    CHECK(exchanged_of.size() == (several ? 3 : 1));
    for (const auto& [p, count] : exchanged_of) CHECK(count > 5);
  }
}

TEST_CASE("a pair that is listed no more loses its history, the others keep theirs") {
  Lists l(strewn(300, 2));
  l.touch();
  std::int64_t touching = 0, of_moved = 0;
  const std::uint32_t moved = 17;  // an id
  l.pairs.each_contact([&](const PairList& list, std::int64_t slot, std::int64_t) {
    ++touching;
    of_moved += l.particles.id[list.owner[slot]] == moved || l.particles.id[list.partner[slot]] == moved;
  });
  REQUIRE(of_moved > 0);
  for (std::int64_t i = 0; i < l.particles.count(); ++i) {
    if (l.particles.id[i] == moved) l.particles.position[i].centre[1] += 0.5;
  }
  l.rebuild();
  std::int64_t kept = 0;
  l.pairs.each_contact([&](const PairList& list, std::int64_t slot, std::int64_t contact) {
    CHECK(list.history[0][contact] == l.name(list.owner[slot], list.partner[slot]));
    ++kept;
  });
  CHECK(kept == touching - of_moved);
}

TEST_CASE("the number of slabs changes how the lists are cut, and nothing else") {
  const auto all = [](const Lists& l) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (int slab = 0; slab < l.common.slabs.count; ++slab) {
      const PairList& list = l.pairs.of(slab, 0);
      for (std::int64_t s = 0; s < list.count(); ++s) found.emplace_back(list.owner[s], list.partner[s]);
    }
    return found;
  };
  const Lists one(strewn(300, 3), 1), many(strewn(300, 3), 7), more_than_beads(strewn(300, 3), 400);
  CHECK(one.pairs.count() > 150);
  CHECK(all(one) == all(many));
  CHECK(all(one) == all(more_than_beads));
}

TEST_CASE("a contact at a wall is found again by bead, feature and the nearest normal, once") {
  WallContacts c;
  c.resize(4);
  c.bead = {3, 3, 3, 8};
  c.feature = {1, 1, 2, 1};
  c.normal = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{1, 0, 0}, Vector3{1, 0, 0}};
  std::int64_t cursor = 0;
  CHECK_FALSE(c.take(cursor, 2, 1, {1, 0, 0}));
  CHECK_FALSE(c.take(cursor, 3, 9, {1, 0, 0}));
  CHECK(c.take(cursor, 3, 1, {0.6, 0.8, 0}) == 1);
  CHECK(c.take(cursor, 3, 1, {0.6, 0.8, 0}) == 0);  // the nearest is taken
  CHECK_FALSE(c.take(cursor, 3, 1, {1, 0, 0}));
  CHECK(c.take(cursor, 3, 2, {0, 0, 1}) == 2);
  CHECK(c.take(cursor, 8, 1, {0, 0, 1}) == 3);
}

TEST_CASE("contacts at a wall go with their bead to its new number and slab, and end where it is no longer near") {
  Lists l(strewn(200, 4), 5);
  MadeUpWall wall;
  std::vector<Body> bodies(1);
  bodies[0].table = &kMadeUp;
  bodies[0].self = &wall;
  WallLists walls(l.common, bodies);
  walls.clear();
  const auto near_ids = [&](std::uint32_t first, std::uint32_t last) {
    wall.near.clear();
    for (std::int64_t i = 0; i < l.particles.count(); ++i) {
      if (l.particles.id[i] >= first && l.particles.id[i] < last) wall.near[i] = {5, l.particles.id[i]};
    }
  };
  near_ids(0, 100);
  rebuild_walls(l, walls, wall);
  std::int64_t near = 0;
  for (int slab = 0; slab < 5; ++slab) {
    WallList& list = walls.of(slab, 0);
    near += std::ssize(list.bead);
    REQUIRE(std::ssize(list.first) == std::ssize(list.bead) + 1);
    list.active.resize(std::ssize(list.bead));
    for (std::int64_t k = 0; k < std::ssize(list.bead); ++k) {
      const std::uint32_t id = l.particles.id[list.bead[k]];
      CHECK(list.bead[k] >= l.common.slabs.begin(slab));
      CHECK(list.bead[k] < l.common.slabs.end(slab));
      CHECK(std::set<std::uint32_t>(list.candidates.begin() + list.first[k], list.candidates.begin() + list.first[k + 1]) ==
            std::set<std::uint32_t>{5, id});
      list.active.bead[k] = static_cast<std::uint32_t>(k);
      list.active.feature[k] = id;
      list.active.history[0][k] = id + 0.5;
    }
  }
  CHECK(near == 100);
  for (PositionLine& x : l.particles.position) {
    for (double& c : x.centre) c = kSide - c;
  }
  l.rebuild();
  near_ids(40, 140);
  rebuild_walls(l, walls, wall);
  std::set<std::uint32_t> kept;
  walls.each_contact(0, [&](const WallList& list, std::int64_t c) {
    const std::uint32_t id = l.particles.id[list.bead[list.active.bead[c]]];
    CHECK(list.active.feature[c] == id);
    CHECK(list.active.history[0][c] == id + 0.5);
    kept.insert(id);
  });
  CHECK(kept.size() == 60);
  CHECK(*kept.begin() == 40);
  CHECK(*kept.rbegin() == 99);
}

// All slabs are gone through as a step of one worker does it: a bead carries forces from the first pair that touches it until phase B.
TEST_CASE("phase B follows right behind the last pair that touches a bead, and the ring holds all beads that carry forces at once") {
  Particles long_bed = strewn(20000, 5);
  for (PositionLine& x : long_bed.position) x.centre[0] *= 20;  // longer than wide: a slab is much longer than its pairs reach
  Settings settings = open_box(1, 3);
  settings.high[0] = 3;
  Lists l(std::move(long_bed), settings, one_material());
  auto& [common, order, pairs, beads] = l;
  Schedule schedule(common);
  schedule.renew(pairs, beads.count());
  // The last pair of all, in the order of a step, that touches each bead.
  std::vector<std::int64_t> last_touch(beads.count(), -1);
  std::int64_t pair = 0;
  for (int slab = 0; slab < 3; ++slab) {
    const PairList& list = pairs.of(slab, 0);
    for (std::int64_t s = 0; s < list.count(); ++s, ++pair) last_touch[list.owner[s]] = last_touch[list.partner[s]] = pair;
  }
  std::int64_t before = 0, finished = 0, longest = 0, early = 0, late = 0;
  for (int slab = 0; slab < 3; ++slab) {
    INFO("slab " << slab);
    const PairList& list = pairs.of(slab, 0);
    const std::vector<Trail>& trails = schedule.trails(slab);
    REQUIRE(trails.size() > 3);
    CHECK(std::ssize(trails) == (list.count() + Schedule::kSlotsPerTrail - 1) / Schedule::kSlotsPerTrail);
    CHECK(trails.back().passed == common.slabs.end(slab));
    for (std::size_t t = 0; t < trails.size(); ++t) {
      const std::int64_t slots = std::min<std::int64_t>(list.count(), (t + 1) * Schedule::kSlotsPerTrail);
      if (slots < list.count()) CHECK(trails[t].passed == list.owner[slots]);
      longest = std::max<std::int64_t>(longest, trails[t].passed + 1 - finished);
      for (std::int64_t i = finished; i < trails[t].done; ++i) early += last_touch[i] >= before + slots;
      if (trails[t].done < beads.count()) late += last_touch[trails[t].done] < before + slots;
      finished = trails[t].done;
    }
    before += list.count();
  }
  CHECK(early == 0);
  CHECK(late == 0);
  CHECK(finished == beads.count());
  CHECK(longest <= schedule.ring());
  CHECK(4 * longest > schedule.ring());  // a batch of beads more, and the next power of two
  CHECK(schedule.ring() < common.slabs.end(0));
  CHECK(schedule.first_touched(0) == 0);
  CHECK(schedule.first_touched(1) < common.slabs.begin(1));
  CHECK(schedule.first_touched(1) > common.slabs.begin(1) - 2000);
  CHECK(schedule.first_touched(3) == beads.count());
}

TEST_CASE("where lists of several pairs of materials follow one another, a slab carries its forces at once") {
  Lists l(two_kinds(2000, 6), open_box(1, 2), two_materials());
  auto& [common, order, pairs, beads] = l;
  Schedule schedule(common);
  schedule.renew(pairs, beads.count());
  CHECK(schedule.last_list() == 2);
  CHECK(schedule.ring() > common.slabs.end(0));
  for (int slab = 0; slab < 2; ++slab) {
    for (int p = 0; p < 3; ++p) {
      const PairList& list = pairs.of(slab, p);
      CHECK(list.count() > 100);
      bool right = true;
      for (std::int64_t s = 0; s < list.count(); ++s) {
        right = right && common.physics.of_beads(beads.material[list.owner[s]], beads.material[list.partner[s]]) == p;
      }
      CHECK(right);
    }
  }
}

TEST_CASE("slabs are cut so that each has about the same work, none is lost, and there may be more than beads") {
  Slabs slabs{4};
  slabs.cut({1, 1, 1, 1, 4, 4, 4, 1, 1, 2});
  CHECK(slabs.bounds == std::vector<std::int64_t>{0, 5, 6, 7, 10});
  slabs.cut({3, 3});
  CHECK(slabs.bounds.front() == 0);
  CHECK(slabs.bounds.back() == 2);
  CHECK(std::is_sorted(slabs.bounds.begin(), slabs.bounds.end()));
  slabs.cut({});
  CHECK(slabs.bounds == std::vector<std::int64_t>(5, 0));
}

TEST_CASE("the number of slabs follows from the number of beads: one for hundreds, as many as 64 threads use for hundreds of thousands") {
  CHECK(partitions_for(0) == 1);
  CHECK(partitions_for(241) == 1);
  CHECK(partitions_for(1999) == 1);
  CHECK(partitions_for(4259) == 4);
  CHECK(partitions_for(60000) == 32);
  CHECK(partitions_for(300000) == 64);
}
