// Neighbour lists: complete, without repeats, and the histories survive every reordering.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dem/support.hpp"
#include "kernel/dem/pair_lists.hpp"
#include "millscope/random.hpp"

using namespace dem_test;

namespace {

using IdPairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// All listed pairs as (smaller id, larger id); fails on a repeat, a self or an owner before its partner.
IdPairs listed(const Assembly& a) {
  const dem::PairLists& lists = a.system->pair_lists();
  const std::vector<std::uint32_t>& id = a.system->particles.id;
  IdPairs found;
  for (int slab = 0; slab < a.system->settings().partitions; ++slab) {
    for (int p = 0; p < std::ssize(a.system->physics()); ++p) {
      const dem::PairList& list = lists.of(slab, p);
      for (std::int64_t s = 0; s < list.count(); ++s) {
        REQUIRE(list.owner[s] > list.partner[s]);
        const std::uint32_t i = id[list.owner[s]], j = id[list.partner[s]];
        REQUIRE(found.emplace(std::min(i, j), std::max(i, j)).second);
      }
    }
  }
  return found;
}

/// Pairs nearer than radii + half the skin that every bead has at rest.
IdPairs brute(const Assembly& a) {
  const dem::Particles& p = a.system->particles;
  const dem::Settings& s = a.system->settings();
  IdPairs found;
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    for (std::size_t j = i + 1; j < p.position.size(); ++j) {
      const double* x = p.position[i].centre;
      const double* y = p.position[j].centre;
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        double d = x[k] - y[k];
        if (s.periodic.length[k] > 0) d -= s.periodic.length[k] * std::round(d / s.periodic.length[k]);
        square += d * d;
      }
      const double limit = (1 + s.skin_base) * (p.position[i].radius + p.position[j].radius);
      if (square < limit * limit) found.emplace(std::min(p.id[i], p.id[j]), std::max(p.id[i], p.id[j]));
    }
  }
  return found;
}

Setup gas(const std::string& domain) {
  Setup s;
  s.beads = "{all: {material: glass, sizes: [{diameter: 2 mm, fraction: 50 %}, {diameter: 6 mm, fraction: 50 %}]}}";
  s.domain = domain;
  s.run = "{partitions: 5}";
  return s;
}

std::vector<Bead> random_beads(std::size_t count, const Vector& low, const Vector& high, std::uint64_t seed) {
  Random random(seed);
  std::vector<Bead> beads(count);
  for (Bead& b : beads) {
    for (std::size_t k = 0; k < 3; ++k) {
      b.position[k] = low[k] + (high[k] - low[k]) * random.uniform();
      b.velocity[k] = 2 * (random.uniform() - 0.5);
    }
    b.radius = 1e-3 * (1 + 2 * random.uniform() * random.uniform());
  }
  beads.back().radius = 3e-3;
  return beads;
}

void check_lists(const Assembly& a) {
  const IdPairs have = listed(a), need = brute(a);
  IdPairs missing;
  std::set_difference(need.begin(), need.end(), have.begin(), have.end(), std::inserter(missing, missing.begin()));
  CHECK(missing.empty());
  CHECK(need.size() > 50);
}

}  // namespace

TEST_CASE("the lists hold every near pair once, in open and periodic boxes") {
  // The shortest period for radii up to 3 mm: 4 · 3 mm · (1 + 0.6) = 19.2 mm, one cell.
  const char* const domains[] = {"{}",
                                 "{periodic: {x: [0, 50 mm]}}",
                                 "{periodic: {y: [-10 mm, 40 mm]}}",
                                 "{periodic: {z: [0, 50 mm]}}",
                                 "{periodic: {x: [0, 50 mm], z: [0, 50 mm]}}",
                                 "{periodic: {x: [0, 50 mm], y: [0, 50 mm], z: [0, 50 mm]}}",
                                 "{periodic: {z: [0, 19.3 mm]}}",
                                 "{periodic: {x: [0, 19.2001 mm]}}",
                                 "{periodic: {x: [0, 19.3 mm], y: [5 mm, 24.3 mm], z: [0, 19.3 mm]}}"};
  for (const char* domain : domains) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      INFO(domain << ", seed " << seed);
      Assembly a = assembled(gas(domain));
      start(a, random_beads(500, {0, 0, 0}, {0.05, 0.05, 0.05}, seed));
      check_lists(a);
    }
  }
}

TEST_CASE("beads strewn so thinly that a cell is as long as the period are listed once") {
  for (const char axis : {'x', 'y', 'z'}) {
    INFO("periodic along " << axis);
    Setup s = gas(fmt::format("{{periodic: {{{}: [0, 20 mm]}}}}", axis));
    Assembly a = assembled(s);
    std::vector<Bead> beads = random_beads(160, {0, 0, 0}, {0.02, 0.02, 0.02}, 7);
    for (std::size_t i = 120; i < 160; ++i) {  // far apart in the open directions: the grid coarsens
      for (std::size_t k = 0; k < 3; ++k) beads[i].position[k] *= 2500;
    }
    start(a, beads);
    check_lists(a);
  }
}

TEST_CASE("lists stay complete while fast and slow beads fly through one another") {
  Setup s = gas("{periodic: {x: [0, 40 mm], y: [0, 40 mm], z: [0, 20 mm]}}");
  s.pairs = "restitution: 1, static_friction: 0";
  Assembly a = assembled(s);
  std::vector<Bead> beads = random_beads(300, {0, 0, 0}, {0.04, 0.04, 0.02}, 5);
  for (std::size_t i = 0; i < beads.size(); ++i) {
    beads[i].radius *= 0.4;
    for (double& v : beads[i].velocity) v *= i % 10 == 0 ? 8 : 0.5;
  }
  std::vector<Bead> apart;  // none overlaps another
  for (const Bead& b : beads) {
    const bool free = std::all_of(apart.begin(), apart.end(), [&b](const Bead& c) {
      Vector d = minus(b.position, c.position);
      for (std::size_t k = 0; k < 3; ++k) d[k] -= (k == 2 ? 0.02 : 0.04) * std::round(d[k] / (k == 2 ? 0.02 : 0.04));
      return length(d) > b.radius + c.radius;
    });
    if (free) apart.push_back(b);
  }
  start(a, apart);
  for (int k = 0; k < 400; ++k) {
    const dem::Particles before = a.system->particles;
    a.system->advance();
    // A pair in touch at the step that was just taken must be listed: the lists may be older than it, never too narrow.
    const IdPairs have = listed(a);
    bool complete = true;
    for (std::size_t i = 0; i < before.id.size(); ++i) {
      for (std::size_t j = i + 1; j < before.id.size(); ++j) {
        const dem::PositionLine &x = before.position[i], &y = before.position[j];
        double square = 0;
        for (int c = 0; c < 3; ++c) {
          const double length = a.system->settings().periodic.length[c];
          double d = x.centre[c] - y.centre[c];
          d -= length * std::round(d / length);
          square += d * d;
        }
        const double sum = x.radius + y.radius;
        const auto [p, q] = std::minmax(before.id[i], before.id[j]);
        complete = complete && (square >= sum * sum || have.count({p, q}) == 1);
      }
    }
    REQUIRE(complete);
  }
  CHECK(a.system->rebuilds() > 3);
  CHECK(a.system->ledger().pairs[0].collisions > 10);
}

// Four beads hold together by adhesion and shake on their springs. Seen from a frame that flies through a periodic box, cell after cell,
// nothing may change although owner and partner of each pair are exchanged again and again.
TEST_CASE("tangential springs survive rebuilds and exchanges of owner") {
  Setup s;
  s.law = "{kind: jkr}";
  s.pairs = "restitution: 0.95, static_friction: 5, surface_energy: 2 J/m^2, rolling_friction: 0.3";
  s.interactions = "{rolling: {kind: rolling_epsd}}";
  s.domain = "{periodic: {x: [0, 60 mm], y: [0, 60 mm], z: [0, 60 mm]}}";
  const double d = 2 * kRadius * 0.9995, h = d / std::sqrt(2.0);
  std::vector<Bead> cluster(4);
  cluster[0].position = {0, 0, 0};
  cluster[1].position = {h, h, 0};
  cluster[2].position = {h, 0, h};
  cluster[3].position = {0, h, h};
  for (std::size_t i = 0; i < 4; ++i) {
    for (double& x : cluster[i].position) x += 7e-3;
    cluster[i].spin = {3.0 * static_cast<double>(i), 2, -1.0 * static_cast<double>(i * i)};
  }
  std::vector<Bead> flying = cluster;
  for (Bead& b : flying) b.velocity = {3.1, -2.3, 1.7};
  Assembly still = assembled(s), moving = assembled(s);
  start(still, cluster);
  start(moving, flying);
  std::set<std::uint32_t> first_owner;
  double worst = 0, stretch = 0;
  for (int block = 0; block < 200; ++block) {
    advance(still, 20);
    advance(moving, 20);
    for (std::uint32_t i = 1; i < 4; ++i) {
      const Vector at = minus(position(still, i), position(still, 0));
      Vector other = minus(position(moving, i), position(moving, 0));
      for (double& x : other) x -= 60e-3 * std::round(x / 60e-3);
      worst = std::max(worst, length(minus(at, other)));
      stretch = std::max(stretch, length(spin(still, i)));
    }
    first_owner.insert(moving.system->particles.id[0]);
    REQUIRE(moving.system->ledger().pairs[0].contacts == 6);
  }
  CHECK(moving.system->rebuilds() > 100);
  CHECK(first_owner.size() > 1);
  CHECK(stretch > 0.1);
  CHECK(worst < 1e-9 * kRadius);
}
