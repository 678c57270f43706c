#include <cmath>

#include "kernel/config/units.hpp"
#include "tests/config/helpers.hpp"

using namespace millscope::config;
using testing::case_with;
using testing::message_of;
using testing::read_all;

TEST_CASE("a whole case") {
  const Case c = read_all(testing::kCase);
  CHECK(c.name == "case");
  CHECK(c.material("glass").young == 2 * 26e9 * 1.23);
  CHECK(c.softened_young(c.material("glass")) == c.material("glass").young);
  CHECK(c.beads[0].density == 2500);
  CHECK(c.mill->speed == Approx(6.1167).epsilon(1e-5));
  CHECK(c.mill->speed == Approx(0.75 * 77.88 * M_PI / 30).epsilon(1e-4));
  CHECK(c.geometry[0].motion.rotation->speed == c.mill->speed);
  CHECK(c.geometry[0].material_of("shell") == "hdpe");
  CHECK(c.domain.periodic == std::array<bool, 3>{false, false, true});
  CHECK(c.domain.box.high[2] == 0.02);
  CHECK(std::isinf(c.domain.box.high[0]));
  CHECK(c.output.frames->every == 0.01);
  CHECK(c.output.frames->from == 2.5);
  CHECK(c.output.series.has_value());
  CHECK(c.output.checkpoint.has_value());
  CHECK_FALSE(c.output.vtk.has_value());
  CHECK(c.time.step_fraction == 0.2);
  CHECK(c.contact.law.where.text() == "case.yaml:9");
}

TEST_CASE("the filling of the study's slice is 4259 beads") {
  CHECK(bead_count(read_all(testing::kCase)) == 4259);
  const std::string open = case_with("fill", "fill: {filling: 31.3 %, porosity: 0.37}");
  CHECK(bead_count(read_all(open), Vessel{0.3, 0.27}) == 57501);
  CHECK(message_of([&] { bead_count(read_all(open)); }) ==
        "case.yaml:8: 'fill.filling' has no shell to be counted on; give 'fill.vessel: {diameter, length}' or a mill as geometry");
  CHECK(bead_count(read_all(case_with("fill", "fill: {count: 12}"))) == 12);
  CHECK(bead_count(read_all(case_with("fill", "fill: {mass: 9.4 kg}"))) == 57449);
}

TEST_CASE("sizes and shares by mass become numbers") {
  const Case sizes = read_all(
      case_with("beads", "beads: {a: {material: glass, sizes: [{diameter: 1 mm, fraction: 50 %}, {diameter: 2 mm, fraction: 50 %}]}}"));
  CHECK(sizes.beads[0].sizes[0].number_fraction == Approx(8.0 / 9));
  CHECK(sizes.largest_diameter() == 0.002);
  CHECK(sizes.smallest_diameter() == 0.001);
  const Case shares = read_all(case_with(
      "beads",
      "beads: {a: {material: glass, diameter: 1 mm, share: 20 %}, b: {material: glass, density: 5000, diameter: 1 mm, share: 80 %}}"));
  CHECK(shares.beads[0].number_share == Approx(1.0 / 3));
  CHECK(shares.mean_bead_mass() == Approx(shares.mean_bead_volume() * (2500 + 2 * 5000) / 3));
}

TEST_CASE("distributions keep mean and deviation") {
  for (const std::string kind : {"normal", "lognormal"}) {
    const Case c = read_all(case_with("beads", "beads: {a: {material: glass, fractions_by: number, distribution: {kind: " + kind +
                                                   ", mean: 5 mm, deviation: 0.5 mm, bins: 41}}}"));
    double mean = 0, square = 0, sum = 0;
    for (const SizeClass& s : c.beads[0].sizes) {
      mean += s.number_fraction * s.diameter;
      square += s.number_fraction * s.diameter * s.diameter;
      sum += s.number_fraction;
    }
    CHECK(sum == Approx(1));
    CHECK(mean == Approx(0.005).epsilon(2e-3));
    CHECK(std::sqrt(square - mean * mean) == Approx(0.0005).epsilon(0.03));
  }
  const Case uniform = read_all(case_with(
      "beads", "beads: {a: {material: glass, fractions_by: number, distribution: {kind: uniform, low: 1 mm, high: 2 mm, bins: 4}}}"));
  CHECK(uniform.beads[0].sizes.size() == 4);
  CHECK(uniform.beads[0].sizes[3].number_fraction == Approx(0.25));
}

TEST_CASE("pairs fall back from materials to groups to default") {
  const Case c = read_all(testing::kCase);
  CHECK(c.pairs.lookup("hdpe", "glass").path() == "pairs.glass~liner");
  CHECK(c.pairs.lookup("glass", "glass").path() == "pairs.glass~glass");
  CHECK(c.pairs.lookup("hdpe", "nylon").path() == "pairs.default");
  const Case exact = read_all(testing::kCase, {"pairs.hdpe~glass.restitution=0.1"});
  CHECK(exact.pairs.lookup("glass", "hdpe").path() == "pairs.glass~hdpe");
  const Case none = read_all(testing::kCase, {"pairs.default=~", "groups=~", "pairs.glass~liner=~"});
  CHECK(message_of([&] { none.pairs.lookup("hdpe", "glass"); }) ==
        "case.yaml:10: 'pairs' says nothing of the pair hdpe~glass; add a key 'glass~hdpe', or 'default'");
}

TEST_CASE("senses, speeds and motions") {
  const Case clockwise = read_all(testing::kCase, {"mill.direction=clockwise", "mill.speed=30 rpm"});
  CHECK(clockwise.mill->speed == Approx(-M_PI));
  CHECK(clockwise.geometry[0].motion.rotation->speed == Approx(-M_PI));
  const Case ripple = read_all(testing::kCase, {"geometry.liner.motion={rotation: {axis: [0, 0, 2], ramp_s: 1 s, "
                                                "ripple: {amplitude: 2 %, frequency: 5 Hz}}, translation: {velocity: [1, 0, 0, mm/s]}}"});
  const MotionCase& motion = ripple.geometry[0].motion;
  CHECK(motion.rotation->follows_mill);
  CHECK(motion.rotation->axis == Vector3{0, 0, 1});
  CHECK(motion.rotation->ripple->amplitude == 0.02);
  CHECK(motion.translation->velocity[0] == 0.001);
  const auto twice = [](const std::string& speed) {
    const std::string liner = "geometry.liner.motion={rotation: {ripple: {amplitude: 2 %, per_turn: 2}}}";
    return read_all(testing::kCase, {"mill.speed=" + speed, liner}).geometry[0].motion.rotation->ripple->frequency;
  };
  CHECK(twice("30 rpm") == Approx(1));  // the frequency follows the speed
  CHECK(twice("45 rpm") == Approx(1.5));
  CHECK(message_of([] {
          read_all(testing::kCase, {"geometry.liner.motion={rotation: {ripple: {amplitude: 2 %, per_turn: 2, frequency: 1 Hz}}}"});
        }).find("is given beside 'frequency'; give one of them") != std::string::npos);
  const Case own = read_all(testing::kCase, {"mill=~", "geometry.liner.motion={rotation: {speed: -2 rad/s}}"});
  CHECK(own.geometry[0].motion.rotation->speed == -2);
  CHECK_FALSE(own.mill.has_value());
}

TEST_CASE("outputs can be switched on and off") {
  const Case c = read_all(testing::kCase, {"output.series=off", "output.checkpoint.every_wall_s=60", "output.tracks={beads: [3, 7]}",
                                           "output.vtk={}", "output.frames=off"});
  CHECK_FALSE(c.output.series.has_value());
  CHECK(c.output.checkpoint->every_wall == 60);
  CHECK(c.output.tracks->ids == std::vector<std::uint64_t>{3, 7});
  CHECK(c.output.tracks->count == 2);
  CHECK(c.output.vtk->every == 0.05);
  CHECK_FALSE(c.output.frames.has_value());
}

TEST_CASE("only beads like those of a tracer class may be followed") {
  const std::string two =
      "beads: {charge: {material: glass, diameter: 5 mm, share: 95 %}, marked: {material: glass, density: 5000, diameter: 5 mm, share: 5 "
      "%, "
      "tracer: true}}";
  const Case c = read_all(case_with("beads", two));
  const double volume = std::acos(-1.0) / 6 * std::pow(5e-3, 3);
  CHECK(c.has_tracers());
  CHECK(c.may_be_followed(2.5e-3, 5000 * volume));
  CHECK(c.may_be_followed(2.5e-3 * (1 + 1e-7), 5000 * volume * (1 - 1e-7)));  // single precision
  CHECK_FALSE(c.may_be_followed(2.5e-3, 2500 * volume));
  CHECK_FALSE(c.may_be_followed(2.6e-3, 5000 * volume));
  CHECK(c.tracer_part(2.5e-3, 5000 * volume) == 1);
  CHECK(c.tracer_part(2.5e-3, 2500 * volume) == 0);
  std::string like = two;
  like.replace(like.find("density: 5000, "), 15, "");
  CHECK(read_all(case_with("beads", like)).tracer_part(2.5e-3, 2500 * volume) == Approx(0.05));
  const Case plain = read_all(testing::kCase);
  CHECK_FALSE(plain.has_tracers());
  CHECK(plain.tracer_part(1, 1) == 0);
  CHECK(plain.may_be_followed(1, 1));
}

TEST_CASE("a pair may be like another, some of its values multiplied") {
  const std::string pairs =
      "  liner~glass: {restitution: 0.55, friction: 30 %}\n  glass~hdpe: {like: glass~liner, restitution: 0.4, times: {friction: 0.5}}\n";
  const std::string like = case_with("  liner~glass", pairs.substr(0, pairs.size() - 1));
  const auto value = [](const Case& c, const char* key) { return read_number(c.pairs.lookup("glass", "hdpe").at(key), "1"); };
  const Case c = read_all(like);
  CHECK(value(c, "restitution") == 0.4);
  CHECK(value(c, "friction") == Approx(0.15));
  CHECK(value(read_all(like, {"pairs.glass~liner.friction=0.2"}), "friction") == Approx(0.1));  // it follows the other
  CHECK(value(read_all(like, {"pairs.glass~hdpe.times.friction=2"}), "friction") == Approx(0.6));
  CHECK(value(read_all(like, {"pairs.glass~liner.friction=2e5 mm^2/m^2"}), "friction") == Approx(0.1));  // whatever the other is written in
  CHECK(value(read_all(like, {"pairs.glass~liner={like: glass~glass}"}), "friction") == Approx(0.17));   // which may be like a third
  CHECK_FALSE(read_all(case_with("  liner~glass",
                                 "  liner~glass: {restitution: 0.55, friction: 30 %}\n  glass~hdpe: {like: glass~liner, friction: ~}"))
                  .pairs.lookup("glass", "hdpe")
                  .has("friction"));
  const Case whole = read_all(like, {"pairs.glass~nylon={like: default}", "pairs.default.friction=0.7"});
  CHECK(read_number(whole.pairs.lookup("glass", "nylon").at("friction"), "1") == 0.7);
  const auto refused = [&](const std::vector<std::string>& overrides) { return testing::refusal(like, overrides); };
  CHECK(refused({"pairs.glass~hdpe.like=glass~linen"}) ==
        "--set pairs.glass~hdpe.like=glass~linen: 'pairs.glass~hdpe.like' names 'glass~linen', which 'pairs' does not have; did you mean "
        "'glass~liner'?");
  CHECK(
      refused({"pairs.glass~liner={like: glass~hdpe}"}) ==
      "case.yaml:13: 'pairs.glass~hdpe.like' names 'glass~liner', which is in the end like this pair; give one of them values of its own");
  CHECK(refused({"pairs.glass~hdpe.friction=0.1"}) ==
        "case.yaml:13: 'pairs.glass~hdpe.times.friction' multiplies a value that 'pairs.glass~hdpe' gives itself; keep one of the two");
  CHECK(refused({"pairs.glass~hdpe.times={stickiness: 2}"}) ==
        "--set pairs.glass~hdpe.times={stickiness: 2}: 'pairs.glass~hdpe.times.stickiness' multiplies a value that 'pairs.glass~liner' "
        "does not give; known: "
        "restitution, friction");
  CHECK(refused({"pairs.glass~glass.times={friction: 2}"}) ==
        "--set pairs.glass~glass.times={friction: 2}: 'pairs.glass~glass.times' multiplies values of no other pair; add 'like', e.g. like: "
        "glass~liner");
  CHECK(refused({"pairs.glass~hdpe.times.friction=1000"}) ==
        "--set pairs.glass~hdpe.times.friction=1000: 'pairs.glass~hdpe.friction' is 300; it must be from 0 to 10; Coulomb's coefficient.");
  CHECK(refused({"pairs.glass~hdpe.sticky=1"}) == "--set pairs.glass~hdpe.sticky=1: unknown key 'sticky' in 'pairs.glass~hdpe'; known: like, times, restitution, friction");
}
