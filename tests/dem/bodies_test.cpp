// Beads on their way to body forces and back, four at once: each bead gets its own, also the last ones of a number that is no multiple
// of 4.
#include <catch2/catch.hpp>

#include <cstring>
#include <string>
#include <vector>

#include "dem/support.hpp"
#include "kernel/dem/scratch.hpp"
#include "kernel/dem/wide.hpp"
#include "millscope/random.hpp"

using namespace millscope;
using namespace millscope::dem;

namespace {

constexpr std::int64_t kBefore = 3, kBehind = 5;  ///< beads that are not asked for
constexpr double kDownhill[3] = {2, -9, 1};       // m/s²

struct Beads {
  std::vector<PositionLine> position;
  std::vector<MotionLine> motion;
  std::vector<ForceLine> force;

  explicit Beads(std::int64_t count) : position(count), motion(count), force(count) {
    Random random(7);
    for (std::int64_t i = 0; i < count; ++i) {
      for (int a = 0; a < 3; ++a) {
        position[i].centre[a] = random.normal();
        motion[i].v[a] = random.normal();
        motion[i].w[a] = random.normal();
        force[i].f[a] = random.normal();
        force[i].t[a] = random.normal();
      }
      position[i].radius = random.between(1, 2);
      motion[i].inverse_mass = random.between(1, 2);
    }
  }
};

/// What the forces say; every third bead has no fluid.
void answer(const BodyForceArrays& b, std::int64_t count) {
  Random random(8);
  for (std::int64_t k = 0; k < count; ++k) {
    for (int a = 0; a < 3; ++a) {
      b.force[a][k] += random.normal();
      b.moment[a][k] += random.normal();
    }
    b.added_mass[k] += k % 3 == 0 ? 0.0 : random.uniform();
  }
}

bool got_its_own(const Beads& beads, std::int64_t i, const BodyForceArrays& b, std::int64_t k) {
  bool same = b.radius[k] == beads.position[i].radius && b.mass[k] == 1 / beads.motion[i].inverse_mass && b.added_mass[k] == 0;
  for (int a = 0; a < 3; ++a) {
    same = same && b.position[a][k] == beads.position[i].centre[a] && b.velocity[a][k] == beads.motion[i].v[a] &&
           b.spin[a][k] == beads.motion[i].w[a] && b.force[a][k] == 0 && b.moment[a][k] == 0;
  }
  return same;
}

/// (m + m_a) a = ΣF + m g, and the integrator makes F/m + g of it.
bool is_pushed(const ForceLine& before, const ForceLine& now, const BodyForceArrays& b, std::int64_t k) {
  bool right = true;
  for (int a = 0; a < 3; ++a) {
    const double m = b.mass[k], all = before.f[a] + b.force[a][k] + m * kDownhill[a];
    right = right && now.f[a] / m + kDownhill[a] == Approx(all / (m + b.added_mass[k])).margin(1e-13);
    right = right && now.t[a] == before.t[a] + b.moment[a][k];
  }
  return right;
}

void check(const WideTable& wide, std::int64_t count) {
  const Beads before(kBefore + count + kBehind);
  Beads now = before;
  Scratch scratch(0);
  const BeadRange asked{kBefore, kBefore + count};
  wide.gather_bodies(now.position.data(), now.motion.data(), asked, scratch.bodies);
  for (std::int64_t k = 0; k < count; ++k) REQUIRE(got_its_own(before, kBefore + k, scratch.bodies, k));
  answer(scratch.bodies, count);
  wide.scatter_bodies(ForceWindow{now.force.data()}, asked, kDownhill, scratch.bodies);
  for (std::int64_t i = 0; i < std::ssize(before.force); ++i) {
    if (i >= asked.begin && i < asked.end) {
      REQUIRE(is_pushed(before.force[i], now.force[i], scratch.bodies, i - kBefore));
    } else {
      REQUIRE(std::memcmp(&before.force[i], &now.force[i], sizeof(ForceLine)) == 0);
    }
  }
}

}  // namespace

TEST_CASE("each bead hands body forces its own state and gets what they answer it, whatever their number, in each build") {
  for (const std::string& level : dem_test::levels()) {
    for (const std::int64_t count : {0, 1, 2, 3, 4, 5, 6, 7, 8, 241, 511, 512}) {
      INFO(level << ", " << count << " beads");
      check(wide_table(level.c_str()), count);
    }
  }
}
