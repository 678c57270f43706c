// Runs that begin where another one ended: places, walls, beads too many and too few, refusals, resuming.
#include <catch2/catch.hpp>

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "dem/support.hpp"
#include "kernel/base/error.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/archive.hpp"
#include "kernel/run/simulation.hpp"
#include "kernel/run/space.hpp"
#include "tests/scratch.hpp"

using namespace dem_test;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

constexpr double kEnd = 0.2, kFrom = 0.12, kDevelop = 0.08, kSpeed = 8;  // s, s, s, rad/s
constexpr int kBeads = 150;

/// A drum of 100 mm with four lifters, which turns by 92 degrees until the donor's end.
Setup drum(int beads = kBeads) {
  Setup s;
  s.stiffness_factor = 1e-4;
  s.fill = fmt::format("{{count: {}, settle_s: 0.1}}", beads);
  s.body_forces = kWithGravity;
  s.geometry = fmt::format(
      "{{drum: {{kind: mill, diameter: 100 mm, length: 20 mm, lifters: 4, lifter_height: 8 mm, lifter_width: 20 mm, material: wall, "
      "motion: {{rotation: {{speed: {} rad/s, ripple: {{amplitude: 0.1, frequency: 3 Hz}}}}}}}}}}",
      kSpeed);
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  s.time = fmt::format("{{end_s: {}, analyze_from_s: {}}}", kEnd, kFrom);
  return s;
}

struct Folder {
  testing::Scratch scratch;

  fs::path write(const std::string& name, const Setup& s, const std::string& more = "") const {
    const fs::path file = scratch / (name + ".yaml");
    std::ofstream(file) << s.text() << more;
    return file;
  }
  /// Runs a case; returns its output.
  fs::path run(const std::string& name, const Setup& s, const std::string& more = "", std::vector<std::string> settings = {}) const {
    run::RunOptions options;
    options.output = scratch / name;
    options.quiet = true;
    options.overrides = std::move(settings);
    REQUIRE(run::run_case(write(name, s, more).string(), registry(), options) == run::Outcome::finished);
    return options.output;
  }
  void resume(const fs::path& out, const std::string& setting) const {
    run::RunOptions options;
    options.output = out;
    options.quiet = true;
    options.overrides = {setting};
    REQUIRE(run::resume_run(registry(), options) == run::Outcome::finished);
  }
};

std::string from(const fs::path& donor, double develop = kDevelop) {
  return fmt::format("start: {{run: {}, develop_s: {}}}\n", donor.string(), develop);
}

/// With its beads, before the first step.
Assembly begun(const fs::path& case_file, const std::vector<std::string>& settings = {}) {
  Assembly a = run::assemble(config::read_case(case_file.string(), settings), registry(), {1, ""});
  run::insert_beads(a);
  return a;
}

/// Centre, z in the period, velocity and spin of each bead of a run's last checkpoint, by id.
std::vector<std::array<double, 9>> left_by(const fs::path& run) {
  const output::ArchiveReader archive(output::checkpoint_path(run));
  const auto position = archive.read<double>("system/position"), motion = archive.read<double>("system/motion");
  const auto id = archive.read<std::int64_t>("system/id");
  std::vector<std::array<double, 9>> beads(id.size());
  for (std::size_t i = 0; i < id.size(); ++i) {
    const double *x = &position[4 * i], *v = &motion[8 * i];
    const double z = x[2] - 0.02 * std::floor(x[2] / 0.02);
    beads[id[i]] = {x[0], x[1], z, v[0], v[1], v[2], v[4], v[5], v[6]};
  }
  return beads;
}

std::array<double, 9> bead(const Assembly& a, std::size_t i) {
  const dem::PositionLine& x = a.system->particles.position[i];
  const dem::MotionLine &v = a.system->particles.motion[i], &half = a.system->particles.half[i];
  for (int k = 0; k < 3; ++k) CHECK((v.v[k] == half.v[k] && v.w[k] == half.w[k]));
  return {x.centre[0], x.centre[1], x.centre[2], v.v[0], v.v[1], v.v[2], v.w[0], v.w[1], v.w[2]};
}

double gap(const Assembly& a, std::size_t i, std::size_t j) {
  const dem::PositionLine &x = a.system->particles.position[i], &y = a.system->particles.position[j];
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    double d = x.centre[k] - y.centre[k];
    if (k == 2) d -= 0.02 * std::round(d / 0.02);
    square += d * d;
  }
  return std::sqrt(square) - x.radius - y.radius;
}

double angle(const Assembly& a, double time) { return dem::pose_at(a.system->bodies[0].motion, time).angle; }

nlohmann::json summary(const fs::path& run) { return nlohmann::json::parse(base::text_of(run / "summary.json")); }

}  // namespace

TEST_CASE("beads and walls begin where the other run left them") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  Setup other = drum();
  other.pairs = "restitution: 0.5, static_friction: 0.6";
  const Assembly a = begun(folder.write("warm", other, from(donor)));
  const auto left = left_by(donor);
  REQUIRE(a.system->particles.count() == kBeads);
  for (std::size_t i = 0; i < kBeads; ++i) CHECK(bead(a, i) == left[i]);
  const double begin = static_cast<double>(a.first_step) * a.time_step, end = std::ceil(kEnd / a.time_step) * a.time_step;
  CHECK(begin == Approx(kFrom - kDevelop).margin(a.time_step));
  const Assembly cold = assembled(drum());
  CHECK(angle(a, begin) == Approx(angle(cold, end)).epsilon(1e-12));
  CHECK(std::fabs(angle(a, begin)) > 1.5);
  CHECK(dem::angular_speed(a.system->bodies[0].motion, begin) == Approx(dem::angular_speed(cold.system->bodies[0].motion, end)));
}

TEST_CASE("a run from another's end tells so and keeps its own times") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum()), warm = folder.run("warm", drum(), from(donor), {"seed=2"});
  const nlohmann::json s = summary(warm);
  CHECK(s["start"] == nlohmann::json{{"run", donor.string()}, {"develop_s", kDevelop}});
  CHECK_FALSE(summary(donor).contains("start"));
  CHECK(s["settle_s"] == 0);
  CHECK(s["simulated_s"].get<double>() == Approx(kEnd).epsilon(1e-3));
  CHECK(s["window_s"][0].get<double>() == Approx(kFrom).epsilon(1e-2));
  CHECK(s["steps"].get<double>() * s["dt_s"].get<double>() == Approx(kEnd - kFrom + kDevelop).epsilon(1e-3));
  CHECK(base::text_of(warm / "series.csv").find("\n0.0") != std::string::npos);   // 0.04 s …
  CHECK(base::text_of(warm / "series.csv").find("\n0.03") == std::string::npos);  // … and nothing before
  // What the walls did before is in the resolved case, for those who read it later.
  const config::Case c = config::read_case((warm / "case.resolved.yaml").string());
  CHECK(c.walls_ahead() == Approx(kEnd - (kFrom - kDevelop)).margin(2e-5));
  // A third begins at the end of the second.
  const Assembly third = begun(folder.write("third", drum(), from(warm)));
  CHECK(third.c.walls_ahead() == Approx(2 * (kEnd - (kFrom - kDevelop))).margin(4e-5));
}

TEST_CASE("beads too many are taken away by the seed") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  const auto left = left_by(donor);
  const auto kept = [&](int seed) {
    const Assembly a = begun(folder.write("fewer", drum(140), from(donor)), {fmt::format("seed={}", seed)});
    REQUIRE(a.system->particles.count() == 140);
    std::vector<bool> found(left.size(), false);
    for (std::size_t i = 0; i < 140; ++i) {
      CHECK(a.system->particles.id[i] == i);
      const auto at = std::find(left.begin(), left.end(), bead(a, i));
      REQUIRE(at != left.end());
      CHECK_FALSE(found[at - left.begin()]);
      found[at - left.begin()] = true;
    }
    return found;
  };
  CHECK(kept(1) == kept(1));
  CHECK(kept(1) != kept(2));
}

TEST_CASE("beads that lack are put clear of the others and of the walls where these stand") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  const auto left = left_by(donor);
  Assembly a = begun(folder.write("more", drum(220), from(donor)));
  REQUIRE(a.system->particles.count() == 220);
  for (std::size_t i = 0; i < kBeads; ++i) CHECK(bead(a, i) == left[i]);
  const double turned = angle(a, static_cast<double>(a.first_step) * a.time_step);
  const Assembly cold = assembled(drum(220));  // whose walls stand as they were made
  for (std::size_t i = kBeads; i < 220; ++i) {
    for (std::size_t j = 0; j < 220; ++j) {
      if (i != j) CHECK(gap(a, i, j) > 0);
    }
    const dem::PositionLine& x = a.system->particles.position[i];
    const base::Vector3 back{std::cos(turned) * x.centre[0] + std::sin(turned) * x.centre[1],
                             -std::sin(turned) * x.centre[0] + std::cos(turned) * x.centre[1], x.centre[2]};
    CHECK(run::blocked(cold, {back}, x.radius)[0] == 0);
    CHECK(a.system->particles.motion[i].v[0] == 0);
  }
  run::begin(a);
  advance(a, 100);  // and nothing bursts
}

TEST_CASE("classes of beads keep their numbers, and have this case's densities") {
  const Folder folder;
  Setup s = drum();
  s.beads = "{small: {material: glass, diameter: 4 mm, share: 50 %}, large: {material: glass, diameter: 6 mm, share: 50 %}}";
  const fs::path donor = folder.run("donor", s);
  s.fill = "{count: 160}";
  s.beads = "{small: {material: glass, diameter: 4 mm, share: 30 %}, large: {material: heavy, diameter: 6 mm, share: 70 %, density: 5000}}";
  const Assembly a = begun(folder.write("warm", s, from(donor)));
  const Assembly cold = begun(folder.write("cold", s));
  const auto count = [](const Assembly& of) {
    std::array<int, 2> n{};
    for (std::int64_t i = 0; i < of.system->particles.count(); ++i) {
      const double radius = of.system->particles.position[i].radius;
      const int k = radius > 2.5e-3 ? 1 : 0;
      ++n[k];
      CHECK(1 / of.system->particles.motion[i].inverse_mass == Approx(bead_mass(k ? 3e-3 : 2e-3, k ? 5000 : 2500)));
      CHECK(of.materials[of.system->particles.material[i]] == (k ? "heavy" : "glass"));
    }
    return n;
  };
  CHECK(count(a) == count(cold));
}

TEST_CASE("a run that does not fit is refused at its line, with the remedy") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  const auto refusal = [&](const Setup& s, const fs::path& run, const std::string& part, const std::string& remedy) {
    CHECK_THROWS_WITH(begun(folder.write("warm", s, from(run))),
                      Contains("warm.yaml:") && Contains("'start.run'") && Contains(run.string()) && Contains(part) && Contains(remedy));
  };
  refusal(drum(), folder.scratch / "nowhere", "no such folder", "millscope run");
  refusal(drum(), folder.scratch.path, "no checkpoint.h5", "millscope run");
  Setup s = drum();
  const std::string geometry = s.geometry;
  s.geometry.replace(s.geometry.find("20 mm, material"), 5, "21 mm");
  refusal(s, donor, "other walls", "same geometry");
  s.geometry = geometry;
  s.geometry.replace(s.geometry.find("8 rad/s"), 1, "9");
  refusal(s, donor, "turns at 8 rad/s, here at 9 rad/s", "same speed");
  s.geometry = geometry;
  s.geometry.replace(s.geometry.find("3 Hz"), 1, "4");
  refusal(s, donor, "moves otherwise", "same 'motion'");
  s = drum();
  s.beads = "{glass: {material: glass, diameter: 5.1 mm}}";
  refusal(s, donor, "0.005 m", "same sizes");
  s.beads = "{one: {material: glass, diameter: 5 mm, share: 50 %}, two: {material: glass, diameter: 5 mm, share: 50 %}}";
  refusal(s, donor, "1 classes", "same classes");
  s = drum();
  s.domain = "{periodic: {z: [0, 20 mm]}, low: {y: -40 mm}}";
  refusal(s, donor, "outside this case's domain", "widen 'domain'");
  fs::remove(donor / "summary.json");
  refusal(drum(), donor, "not reached its end", "millscope resume");
  CHECK_THROWS_WITH(begun(folder.write("long", drum(), from(donor, 0.13))), Contains("long.yaml:") && Contains("analyze_from_s = 0.12"));
}

TEST_CASE("another period is refused") {
  const Folder folder;
  Setup s = drum();
  s.geometry = kFloor;
  s.fill = "{count: 20, settle_s: 0, region: {low: [0, 0, 0], high: [40 mm, 40 mm, 20 mm]}}";
  s.domain = "{periodic: {x: [0, 40 mm], z: [0, 20 mm]}}";
  const fs::path donor = folder.run("donor", s);
  s.domain = "{periodic: {x: [0, 41 mm], z: [0, 20 mm]}}";
  CHECK_THROWS_WITH(begun(folder.write("warm", s, from(donor))), Contains("warm.yaml:") && Contains("period along x"));
}

TEST_CASE("a run from another's end is resumed to the same bits, even where that one is gone") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  const fs::path whole = folder.run("whole", drum(155), from(donor));
  const fs::path part = folder.run("part", drum(155), from(donor), {"time.end_s=0.15"});
  fs::remove_all(donor);
  folder.resume(part, fmt::format("time.end_s={}", kEnd));
  CHECK(summary(part)["state_hash"] == summary(whole)["state_hash"]);
  CHECK(summary(part)["steps"] == summary(whole)["steps"]);
  CHECK(base::text_of(part / "series.csv") == base::text_of(whole / "series.csv"));
}

TEST_CASE("check knows how many steps are left") {
  const Folder folder;
  const fs::path donor = folder.run("donor", drum());
  run::RunOptions options;
  options.quiet = true;
  const run::Estimate e = run::estimate(folder.write("warm", drum(), from(donor)).string(), registry(), options);
  CHECK(static_cast<double>(e.steps) * e.time_step == Approx(kEnd - kFrom + kDevelop).epsilon(1e-3));
}
