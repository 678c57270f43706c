// The same bits from any number of threads, any instruction set, and across a restart.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <regex>
#include <set>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"

using namespace dem_test;

namespace {

/// 300 beads of two sizes and two materials in a turning drum with lifters; nothing is equal, so every path of the step is taken.
Setup mixed_drum(int partitions = 16) {
  Setup s;
  s.pairs = "restitution: 0.8, static_friction: 0.34, rolling_friction: 0.02";
  s.wall_pairs = "restitution: 0.55, static_friction: 0.30, rolling_friction: 0.02";
  s.beads = "{light: {material: glass, diameter: 5 mm, share: 60 %}, dense: {material: heavy, diameter: 3 mm, share: 40 %}}";
  s.fill = "{count: 300, settle_s: 0.01}";
  s.interactions = "{rolling: {kind: rolling_epsd}}";
  s.body_forces = "{gravity: {kind: gravity}, air: {kind: air_drag}}";
  s.geometry =
      "{drum: {kind: mill, diameter: 80 mm, length: 20 mm, lifters: 6, lifter_height: 4 mm, lifter_width: 10 mm, material: wall, "
      "motion: {rotation: {speed: 14 rad/s}}}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  s.run = fmt::format("{{partitions: {}}}", partitions);
  return s;
}

/// Beads of one size on the liner that is committed as a mesh.
Setup mesh_drum() {
  Setup s;
  s.fill = "{count: 300, settle_s: 0.01}";
  s.body_forces = kWithGravity;
  s.geometry = "{liner: {kind: mesh, file: " MILLSCOPE_BINARY_DIR
               "/tests/liner.stl, unit: m, period: 20 mm, material: wall, "
               "motion: {rotation: {speed: 6 rad/s}}}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  s.run = "{partitions: 16}";
  return s;
}

/// 4800 beads of one kind in a long trough, pressed together and moving: few enough carry forces at once for a ring (schedule.hpp).
Assembly long_bed(int partitions, int threads = 2) {
  Setup s;
  s.body_forces = "{gravity: {kind: gravity}, air: {kind: air_drag}}";
  s.geometry = kFloor;
  s.domain = "{low: [-1, -0.1, -0.1], high: [5, 0.2, 0.2]}";
  s.run = fmt::format("{{partitions: {}}}", partitions);
  Assembly a = assembled(s, {std::min(partitions, threads), ""});
  std::vector<Bead> beads;
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 16; ++j) {
      const double x = 1.98 * kRadius * i, y = 0.99 * kRadius * (1 + 2 * (j / 4)), z = 1.98 * kRadius * (j % 4);
      beads.push_back({{x, y, z}, {0.3 * std::sin(1.7 * i + j), 0.2 * std::cos(0.9 * i - j), 0.1 * std::sin(i + 2.3 * j)}, {}});
    }
  }
  start(a, beads);
  return a;
}

/// 1000 beads of one kind in a box that repeats along all axes: pairs of the last slabs push beads of the first.
Assembly periodic_box(int threads) {
  Setup s;
  s.domain = "{periodic: {x: [0, 0.1], y: [0, 0.1], z: [0, 0.1]}}";
  s.run = "{partitions: 8}";
  Assembly a = assembled(s, {threads, ""});
  std::vector<Bead> beads;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.01 * (i / 100) + 0.005, y = 0.01 * (i / 10 % 10) + 0.005, z = 0.01 * (i % 10) + 0.005;
    beads.push_back({{x, y, z}, {0.5 * std::sin(1.7 * i), 0.4 * std::cos(0.9 * i), 0.3 * std::sin(2.3 * i)}, {}});
  }
  start(a, beads);
  return a;
}

Assembly ready(const Setup& s, int threads = 1, const std::string& level = "") {
  Assembly a = assembled(s, {threads, level}, level);
  run::insert_beads(a);
  run::begin(a);
  return a;
}

std::uint64_t hash_after(const Setup& s, int steps, int threads, const std::string& level) {
  Assembly a = ready(s, threads, level);
  advance(a, steps);
  return a.system->state_hash();
}

double dissipated(const Assembly& a) {
  double sum = 0;
  for (const dem::PairLedger& p : a.system->ledger().pairs) {
    for (const double d : p.dissipated) sum += d;
  }
  return sum;
}

}  // namespace

TEST_CASE("threads and instruction sets change no bit") {
  const int steps = 1500;  // three turns of the lists' life, a tenth of a turn of the drum
  for (const Setup& s : {mixed_drum(), mesh_drum()}) {
    const std::uint64_t expected = hash_after(s, steps, 1, "v2");
    for (const std::string& level : levels()) {
      INFO(level);
      CHECK(hash_after(s, steps, 1, level) == expected);
    }
    for (const int threads : {2, 3}) {
      INFO(threads << " threads");
      CHECK(hash_after(s, steps, threads, "") == expected);
    }
    CHECK(hash_after(s, steps, 2, "v2") == expected);
  }
}

TEST_CASE("as many threads as slabs, and slabs without a bead, change no bit") {
  for (const int partitions : {3, 400}) {
    const Setup s = mixed_drum(partitions);
    INFO(partitions << " partitions");
    CHECK(hash_after(s, 300, 3, "") == hash_after(s, 300, 1, ""));
  }
}

// A step that is observed finishes no bead before all pairs are through, and keeps the forces of all beads side by side.
TEST_CASE("beads that are finished behind the pairs, with their forces in a ring, move by the same bits") {
  for (const int partitions : {1, 2}) {
    Assembly trailing = long_bed(partitions), observed = long_bed(partitions);
    observed.system->observe = [](const dem::System&) {};
    advance(trailing, 40);
    advance(observed, 40);
    INFO(partitions << " partitions");
    CHECK(trailing.system->ledger().pairs[0].contacts > 4800);
    CHECK(trailing.system->state_hash() == observed.system->state_hash());
    CHECK(dissipated(trailing) == dissipated(observed));
    CHECK(trailing.system->ledger().body_force_work == observed.system->ledger().body_force_work);
  }
}

TEST_CASE("what slabs of other workers push is added as if one worker had come by it") {
  const auto same = [](const auto& with, int steps) {
    Assembly one = with(1);
    advance(one, steps);
    CHECK(one.system->ledger().pairs[0].collisions > 300);
    for (const int threads : {2, 3, 8}) {
      INFO(threads << " threads");
      Assembly many = with(threads);
      advance(many, steps);
      CHECK(many.system->threads() == threads);
      CHECK(many.system->state_hash() == one.system->state_hash());
      CHECK(dissipated(many) == dissipated(one));
      CHECK(many.system->ledger().body_force_work == one.system->ledger().body_force_work);
    }
  };
  same([](int threads) { return long_bed(8, threads); }, 60);
  same([](int threads) { return long_bed(300, threads); }, 60);
  same([](int threads) { return periodic_box(threads); }, 1500);
}

TEST_CASE("the hash sees the state: another time, another seed, another speed") {
  Assembly a = ready(mixed_drum());
  const std::uint64_t first = a.system->state_hash();
  CHECK(ready(mixed_drum()).system->state_hash() == first);
  a.system->advance();
  CHECK(a.system->state_hash() != first);
  Assembly b = ready(mixed_drum());
  b.system->particles.half[17].w[2] += 1e-12;
  CHECK(b.system->state_hash() != first);
}

TEST_CASE("partitions other than 1 and more than beads work, the physics stays") {
  Setup s = mixed_drum(1);
  Assembly one = ready(s);
  advance(one, 1500);
  for (const int partitions : {7, 400}) {
    s.run = fmt::format("{{partitions: {}}}", partitions);
    Assembly many = ready(s);
    advance(many, 1500);
    INFO(partitions << " partitions");
    CHECK(many.system->centre_of_mass()[1] == Approx(one.system->centre_of_mass()[1]).margin(2e-4));
    CHECK(dissipated(many) == Approx(dissipated(one)).epsilon(0.05));
  }
}

TEST_CASE("a restored system continues bit for bit") {
  for (const Setup& s : {mixed_drum(), mesh_drum()}) {
    Assembly whole = ready(s);
    advance(whole, 1500);
    std::vector<Saved> states;
    for (int k = 0; k < 7; ++k) {  // at all distances from the last rebuild
      states.push_back(saved(whole));
      advance(whole, 7);
    }
    advance(whole, 400);
    const std::uint64_t expected = whole.system->state_hash();
    const double lost = dissipated(whole), work = whole.system->ledger().bodies[0].work;
    const std::int64_t rebuilds = whole.system->rebuilds(), last = whole.system->step();
    bool wall_contacts = false, pair_contacts = false;
    for (std::size_t k = 0; k < states.size(); ++k) {
      wall_contacts = wall_contacts || !states[k].integers.at("walls/0/contact_bead").empty();
      for (const std::int64_t touching : states[k].integers.at("pairs/0/touching")) pair_contacts = pair_contacts || touching != 0;
      Assembly part = assembled(s, {k == 3 ? 2 : 1, ""});
      restore(part, states[k]);
      while (part.system->step() < last) part.system->advance();
      INFO("saved " << 7 * k << " steps later");
      CHECK(part.system->state_hash() == expected);
      CHECK(part.system->rebuilds() == rebuilds);
      CHECK(dissipated(part) == lost);
      CHECK(part.system->ledger().bodies[0].work == work);
    }
    CHECK(wall_contacts);
    CHECK(pair_contacts);
  }
}

TEST_CASE("the bytes of a system are those of its beads, lists and walls") {
  Assembly a = ready(mixed_drum());
  const std::size_t beads = a.system->particles.id.size();
  const std::size_t lines =
      2 * sizeof(dem::PositionLine) + 3 * sizeof(dem::MotionLine) + sizeof(dem::AccelerationLine) + sizeof(dem::ReferenceLine);
  const std::size_t list = static_cast<std::size_t>(a.system->listed_pairs()) * (2 * sizeof(std::uint32_t) + 1);
  CHECK(a.system->memory_bytes() > beads * (lines + 13) + list);
  CHECK(a.system->memory_bytes() < 2 * (beads * (lines + 13) + list));
}

TEST_CASE("what a checkpoint holds has the names that resuming an older one needs") {
  const Saved state = saved(ready(mixed_drum()));
  const auto kinds = [](const auto& arrays) {
    std::set<std::string> names;
    for (const auto& [name, values] : arrays) names.insert(std::regex_replace(name, std::regex("[0-9]+"), "#"));
    return names;
  };
  CHECK(kinds(state.doubles) == std::set<std::string>{"acceleration", "half", "ledger/numbers", "motion", "pairs/#/contact_history_#",
                                                      "position", "reference", "walls/#/contact_normal", "walls/#/history_#",
                                                      "walls/#/impact", "walls/#/shear", "walls_moved"});
  CHECK(kinds(state.integers) == std::set<std::string>{"counters", "id", "ledger/counts", "material", "pairs/#/contacts", "pairs/#/count",
                                                       "pairs/#/owner", "pairs/#/partner", "pairs/#/touching", "slabs", "walls/#/bead",
                                                       "walls/#/beads", "walls/#/candidate_count", "walls/#/candidates",
                                                       "walls/#/contact_bead", "walls/#/contact_feature", "walls/#/contacts",
                                                       "walls/#/first", "walls/#/offsets"});
}

TEST_CASE("a checkpoint whose numbers do not belong together is refused, never used as an index") {
  const Setup s = mixed_drum();
  Assembly whole = ready(s);
  advance(whole, 1500);
  const Saved good = saved(whole);
  const auto refused = [&s](const Saved& state) {
    Assembly a = assembled(s);
    try {
      restore(a, state);
    } catch (const base::UserError&) {
      return true;
    }
    return false;
  };
  CHECK_FALSE(refused(good));
  for (const auto& [name, values] : good.integers) {
    if (values.empty() || name == "counters" || name.find("ledger") != std::string::npos) continue;
    // Features and candidates are numbers that only the geometry knows.
    if (name.find("candidates") != std::string::npos || name.find("feature") != std::string::npos) continue;
    INFO(name);
    for (const std::int64_t hostile : {std::int64_t{-5}, std::int64_t{30000000}, (std::int64_t{1} << 31) - 1}) {
      Saved bad = good;
      bad.integers[name][values.size() / 2] = hostile;
      CHECK(refused(bad));
    }
    Saved shorter = good, longer = good;
    shorter.integers[name].pop_back();
    longer.integers[name].push_back(values.back());
    CHECK(refused(shorter));
    CHECK(refused(longer));
  }
  for (const auto& [name, values] : good.doubles) {
    if (values.empty()) continue;
    INFO(name);
    Saved shorter = good;
    shorter.doubles[name].resize(values.size() / 2);
    CHECK(refused(shorter));
  }
}

TEST_CASE("a checkpoint of other partitions, materials or plugins is refused") {
  const Saved state = saved(ready(mixed_drum()));
  Assembly same = assembled(mixed_drum());
  CHECK_NOTHROW(restore(same, state));
  Assembly other = assembled(mixed_drum(8));
  CHECK_THROWS_WITH(restore(other, state), Catch::Contains("partitions"));
  Setup plain = mixed_drum();
  plain.interactions = "{}";
  plain.pairs = plain.wall_pairs = "restitution: 0.8, static_friction: 0.34";
  Assembly without = assembled(plain);
  CHECK_THROWS_WITH(restore(without, state), Catch::Contains("plugins"));
}
