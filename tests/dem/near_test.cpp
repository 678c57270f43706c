// Which beads are near one another is found in single precision: none is missed, wherever it stands, and each build finds the same.
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dem/lists.hpp"
#include "dem/support.hpp"
#include "millscope/random.hpp"

using namespace millscope;
using namespace millscope::dem;
using namespace dem_test;

namespace {

constexpr double kSide = 10, kCoupleRadius = 1e-3;  // m

Settings box(const std::array<double, 3>& periods, const std::string& instruction_set) {
  Settings s = open_box(20, 1);
  s.instruction_set = instruction_set;
  for (int a = 0; a < 3; ++a) {
    s.periodic.length[a] = periods[a];
    s.periodic_low[a] = -3.7;
  }
  return s;
}

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
    const double half = kCoupleRadius * (1 + s.skin_base) * (1 - 1e-9);
    for (int a = 0; a < 3; ++a) {
      const double side = s.periodic.length[a] > 0 ? s.periodic.length[a] : kSide, centre = s.periodic_low[a] + side * random.uniform();
      p.position[2 * k].centre[a] = centre + half * direction[a] / std::sqrt(square);
      p.position[2 * k + 1].centre[a] = centre - half * direction[a] / std::sqrt(square);
    }
  }
  for (std::int64_t i = 0; i < p.count(); ++i) {
    p.position[i].radius = kCoupleRadius;
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
  const Settings settings = box(periods, instruction_set);
  const Lists l(couples(settings, 3000, 5), settings, one_material());
  const PairList& list = l.pairs.of(0, 0);
  Found found{list.owner, list.partner, {}};
  for (std::int64_t s = 0; s < list.count(); ++s) {
    const std::uint32_t i = l.particles.id[list.owner[s]], j = l.particles.id[list.partner[s]];
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
    for (const std::string& level : levels()) {
      INFO(level);
      CHECK((find(periods, level) == usual));
    }
  }
}

TEST_CASE("where thousands of small beads share a cell with large ones, the lists take the room of their pairs") {
  Random random(3);
  Particles beads;
  beads.resize(3000);
  for (std::int64_t i = 0; i < beads.count(); ++i) {
    beads.position[i].radius = i == 0 ? 40e-3 : 0.5e-3;
    for (double& c : beads.position[i].centre) c = (i == 0 ? 1.0 : 0.08 * random.uniform());
    beads.id[i] = static_cast<std::uint32_t>(i);
  }
  const Lists l(std::move(beads), open_box(20, 1), one_material());
  CHECK(l.pairs.of(0, 0).partner.capacity() < 100000);
}
