// Which beads are near one another is found in single precision: none is missed, wherever it stands, and each build finds the same.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/dem/pair_lists.hpp"
#include "millscope/random.hpp"

using namespace millscope;
using namespace millscope::dem;

namespace {

constexpr double kSide = 10, kRadius = 1e-3;  // m

Settings box(const std::array<double, 3>& periods, const std::string& instruction_set) {
  Settings s;
  s.time_step = 1e-5;
  s.instruction_set = instruction_set;
  for (int a = 0; a < 3; ++a) {
    s.low[a] = -20;
    s.high[a] = 20;
    s.periodic.length[a] = periods[a];
    s.periodic_low[a] = -3.7;
  }
  return s;
}

PhysicsTable one_material() { return {{PairPhysics{}}, 1}; }

/// Beads 2k and 2k + 1 just touch with their skins; some pairs stand across a periodic end.
Particles couples(const Settings& s, std::int64_t count, std::uint64_t seed) {
  Random random(seed);
  Particles p;
  p.resize(2 * count);
  for (std::int64_t k = 0; k < count; ++k) {
    double direction[3], square = 0;
    for (double& d : direction) {
      d = random.uniform() - 0.5;
      square += d * d;
    }
    const double half = kRadius * (1 + s.skin_base) * (1 - 1e-9);
    for (int a = 0; a < 3; ++a) {
      const double side = s.periodic.length[a] > 0 ? s.periodic.length[a] : kSide, centre = s.periodic_low[a] + side * random.uniform();
      p.position[2 * k].centre[a] = centre + half * direction[a] / std::sqrt(square);
      p.position[2 * k + 1].centre[a] = centre - half * direction[a] / std::sqrt(square);
    }
  }
  for (std::int64_t i = 0; i < p.count(); ++i) {
    p.position[i].radius = kRadius;
    p.id[i] = static_cast<std::uint32_t>(i);
  }
  return p;
}

struct Found {
  std::vector<std::uint32_t> owner, partner;
  std::set<std::uint32_t> couples;  ///< by number
  friend bool operator==(const Found&, const Found&) = default;
};

Found find(const std::array<double, 3>& periods, const std::string& instruction_set) {
  Common common(box(periods, instruction_set), {}, one_material());
  Particles beads = couples(common.settings, 3000, 5);
  common.slabs.cut_equally(beads.count());
  CellOrder order(common);
  PairLists pairs(common);
  pairs.clear();
  order.renew(beads, 0);
  pairs.begin_rebuild(order, beads.material);
  pairs.rebuild(0, order, beads.material);
  const PairList& list = pairs.of(0, 0);
  Found found{list.owner, list.partner, {}};
  for (std::int64_t s = 0; s < list.count(); ++s) {
    const std::uint32_t i = beads.id[list.owner[s]], j = beads.id[list.partner[s]];
    if (i / 2 == j / 2) found.couples.insert(i / 2);
  }
  return found;
}

}  // namespace

TEST_CASE("beads that just reach one another are listed, metres from the corner and across periodic ends, the same in each build") {
  for (const std::array<double, 3>& periods :
       {std::array<double, 3>{0, 0, 0}, {0, 0, 10}, {0, 0, 6.4e-3 * 1.0001}, {10, 0, 10}, {7, 8, 9}}) {
    INFO("periods " << periods[0] << ", " << periods[1] << ", " << periods[2] << " m");
    const Found usual = find(periods, "");
    CHECK(usual.couples.size() == 3000);
    for (const char* set : {"v2", "v3", "v4"}) {
      try {
        CHECK((find(periods, set) == usual));
      } catch (const base::UserError&) {
        WARN("this machine does not run " << set);
      }
    }
  }
}

TEST_CASE("where thousands of small beads share a cell with large ones, the lists take the room of their pairs") {
  Settings s = box({0, 0, 0}, "");
  Common common(s, {}, one_material());
  Random random(3);
  Particles beads;
  beads.resize(3000);
  for (std::int64_t i = 0; i < beads.count(); ++i) {
    beads.position[i].radius = i == 0 ? 40e-3 : 0.5e-3;
    for (double& c : beads.position[i].centre) c = (i == 0 ? 1.0 : 0.08 * random.uniform());
    beads.id[i] = static_cast<std::uint32_t>(i);
  }
  common.slabs.cut_equally(beads.count());
  CellOrder order(common);
  PairLists pairs(common);
  pairs.clear();
  order.renew(beads, 0);
  pairs.begin_rebuild(order, beads.material);
  pairs.rebuild(0, order, beads.material);
  CHECK(pairs.of(0, 0).partner.capacity() < 100000);
}

namespace {

PhysicsTable two_materials() {
  PairPhysics same, mixed, other;
  mixed.second = 1;
  other.first = other.second = 1;
  return {{same, mixed, other}, 2};
}

Particles two_kinds(std::int64_t count) {
  Random random(11);
  Particles beads;
  beads.resize(count);
  for (std::int64_t i = 0; i < count; ++i) {
    beads.position[i].radius = 2.5e-3;
    for (double& c : beads.position[i].centre) c = 0.05 * random.uniform();
    beads.id[i] = static_cast<std::uint32_t>(i);
    beads.material[i] = static_cast<std::uint8_t>(i % 2);
  }
  return beads;
}

}  // namespace

// Odd beads are of another material. In a mirror the order of cells is another, and owners and partners change places.
TEST_CASE("histories follow their pairs into the lists of several materials") {
  Common common(box({0, 0, 0}, ""), dem::Layout{{}, {1, -1}}, two_materials());
  Particles beads = two_kinds(400);
  common.slabs.cut_equally(beads.count());
  CellOrder order(common);
  PairLists pairs(common);
  pairs.clear();
  const auto rebuild = [&] {
    order.renew(beads, 0);
    pairs.begin_rebuild(order, beads.material);
    pairs.rebuild(0, order, beads.material);
  };
  const auto name = [&](std::uint32_t i, std::uint32_t j) {
    const auto [small, large] = std::minmax(beads.id[i], beads.id[j]);
    return 1000.0 * small + large + 1;
  };
  rebuild();
  std::array<std::int64_t, 3> touching{}, kept{}, exchanged{};
  for (int p = 0; p < 3; ++p) {
    PairList& list = pairs.of(0, p);
    for (auto& h : list.history) h.clear();
    for (std::int64_t s = 0; s < list.count(); s += 3) {  // a third of them
      const std::uint32_t i = list.owner[s], j = list.partner[s];
      list.touching[s] = 1;
      list.history[0].push_back(name(i, j));
      list.history[1].push_back(beads.id[i] < beads.id[j] ? name(i, j) : -name(i, j));
      ++touching[p];
    }
    REQUIRE(touching[p] > 20);
  }
  for (PositionLine& x : beads.position) {
    for (double& c : x.centre) c = 0.05 - c;
  }
  rebuild();
  for (int p = 0; p < 3; ++p) {
    const PairList& list = pairs.of(0, p);
    std::int64_t contact = 0;
    for (std::int64_t s = 0; s < list.count(); ++s) {
      if (list.touching[s] == 0) continue;
      const std::uint32_t i = list.owner[s], j = list.partner[s];
      const double sign = beads.id[i] < beads.id[j] ? 1 : -1;
      CHECK(common.physics.of_beads(beads.material[i], beads.material[j]) == p);
      CHECK(list.history[0][contact] == name(i, j));
      CHECK(list.history[1][contact++] == sign * name(i, j));
      exchanged[p] += sign < 0;
      ++kept[p];
    }
    CHECK(kept[p] == touching[p]);
    CHECK(exchanged[p] > 5);
  }
}
