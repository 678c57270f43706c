// Frames of other programs as a run: the same results as from the run that they are of; what lacks is said.
#include "studies/frames/import.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "frames/support.hpp"
#include "kernel/base/statistics.hpp"
#include "kernel/config/case.hpp"
#include "kernel/output/frame_reader.hpp"
#include "kernel/output/summary.hpp"
#include "kernel/output/track_reader.hpp"
#include "kernel/run/assembly.hpp"
#include "kernel/run/simulation.hpp"
#include "plugins.hpp"
#include "skip.hpp"
#include "studies/analysis/analysis.hpp"
#include "studies/analysis/mill.hpp"
#include "studies/camera/simulated_beads.hpp"

using namespace frames_test;
using namespace millscope;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

frames::Imported imported(const Scratch& scratch, const std::string& mill_text, const std::string& out = "out") {
  fs::remove_all(scratch / out);
  write(scratch / "mill.yaml", mill_text);
  return frames::import_frames(scratch / "mill.yaml", scratch / out, testing::registry(), {"millscope", "import"});
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::vector<float> values_of(const output::FrameReader& reader, output::BeadField field, std::size_t frame) {
  std::vector<float> values(3 * reader.beads().size());
  reader.read(field, frame, 1, values);
  return values;
}

/// Frames of a charge that turns as one, `step` apart, as dumps in one file.
std::string turning(int frames, double step, const std::string& columns, double omega = 2) {
  std::string text;
  for (int f = 0; f < frames; ++f) text += dump(charge(60, omega, omega * step * f), f, columns);
  return text;
}

constexpr const char* kAll = "id type x y z vx vy vz omegax omegay omegaz radius";
constexpr const char* kPlaces = "id type x y z radius";

analysis::ResultSet analyzed(const fs::path& run, std::vector<std::string> only = {"pept_grid", "power"}, std::optional<double> from = {}) {
  analysis::AnalysisRequest request;
  request.path = run;
  request.only = std::move(only);
  request.from = from;
  return analysis::analyze(request, testing::registry());
}

const analysis::ResultArray& result(const analysis::ResultSet& results, const std::string& analyzer, const std::string& name) {
  for (const analysis::ResultArray& array : results.arrays) {
    if (array.analyzer == analyzer && array.name == name) return array;
  }
  FAIL(analyzer << "." << name << " is not there");
  return results.arrays.front();
}

bool has_result(const analysis::ResultSet& results, const std::string& analyzer, const std::string& name) {
  return std::any_of(results.arrays.begin(), results.arrays.end(),
                     [&](const analysis::ResultArray& a) { return a.analyzer == analyzer && a.name == name; });
}

/// Equal values, as far as single precision has them; `scale`: of the largest.
void same(const analysis::ResultArray& a, const analysis::ResultArray& b) {
  CAPTURE(a.analyzer, a.name);
  REQUIRE(a.size() == b.size());
  double largest = 0, worst = 0;
  for (const double v : a.value) largest = std::isnan(v) ? largest : std::max(largest, std::fabs(v));
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(std::isnan(a.value[i]) == std::isnan(b.value[i]));
    if (!std::isnan(a.value[i])) worst = std::max(worst, std::fabs(a.value[i] - b.value[i]));
  }
  CHECK(worst <= 2e-6 * largest + 1e-12);
}

/// The mill of the story for 0.4 s, with pictures and frames at the same times.
void run_of_ours(const fs::path& out) {
  run::RunOptions options;
  options.output = out;
  options.quiet = true;
  options.threads = 1;
  options.overrides = {"time.end_s=0.4", "time.analyze_from_s=0.1", "fill.settle_s=0.1",
                       "output={frames: {every_s: 0.005, from_s: 0}, vtk: {every_s: 0.005}}"};
  REQUIRE(run::run_case(std::string(MILLSCOPE_SOURCE_DIR) + "/configs/story/mill.yaml", testing::registry(), options) ==
          run::Outcome::finished);
}

/// All frames as one dump whose mill lies along x, with its middle at 0, and up is z; the last bead stands first.
std::string dumps_of(const output::FrameReader& own) {
  std::string dumps;
  for (std::size_t f = 0; f < own.frame_count(); ++f) {
    const auto x = values_of(own, output::BeadField::position, f), v = values_of(own, output::BeadField::velocity, f),
               w = values_of(own, output::BeadField::spin, f);
    dumps += fmt::format(
        "ITEM: TIME\n{:.12g}\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id y z "
        "x vy vz vx omegay omegaz omegax radius density\n",
        own.scalars().time[f], f, own.beads().size());
    for (std::size_t i = own.beads().size(); i-- > 0;) {
      dumps +=
          fmt::format("{} {:.9g} {:.9g} {:.9g}", own.beads().id[i], double{x[3 * i]}, double{x[3 * i + 1]}, double{x[3 * i + 2]} - 0.017);
      for (const auto* of : {&v, &w})
        dumps += fmt::format(" {:.9g} {:.9g} {:.9g}", double{(*of)[3 * i]}, double{(*of)[3 * i + 1]}, double{(*of)[3 * i + 2]});
      dumps += " 0.005 2500\n";
    }
  }
  return dumps;
}

}  // namespace

TEST_CASE("a run of ours comes back from its pictures and from dumps") {
  const Scratch scratch;
  run_of_ours(scratch / "own");
  const output::FrameReader own(scratch / "own/frames.h5");
  write(scratch / "d.txt", dumps_of(own));
  const std::string speed = "speed: 75 %critical, direction: clockwise, periodic: true}\ntime: {analyze_from: 0.1 s}\n";
  imported(
      scratch,
      "files: own/vtk/beads.pvd\naxis: z\ngravity: -y\nbeads: {density: 2500, porosity: 0.4}\nmill: {diameter: 150 mm, ends: [0, 34 mm], " +
          speed,
      "pictures");
  imported(scratch, "files: d.txt\naxis: x\ngravity: -z\nbeads: {porosity: 0.4}\nmill: {diameter: 150 mm, ends: [-17 mm, 17 mm], " + speed,
           "dumps");
  const analysis::ResultSet wanted = analyzed(scratch / "own", {"pept_grid", "power"}, 0.1);
  for (const char* name : {"pictures", "dumps"}) {
    CAPTURE(name);
    const output::FrameReader theirs(scratch / name / "frames.h5");
    REQUIRE(theirs.frame_count() == own.frame_count());
    const analysis::ResultSet found = analyzed(scratch / name, {"pept_grid", "power"}, 0.1);
    for (const analysis::ResultArray& array : wanted.arrays) {
      const bool of_walls = array.name.find("shell") != std::string::npos || array.name.find("dissipation") != std::string::npos;
      if (of_walls) CHECK_FALSE(has_result(found, array.analyzer, array.name));
      if (!of_walls) same(array, result(found, array.analyzer, array.name));
    }
    // The power by the centre of mass of the summaries: ours is of samples each ms, theirs of frames.
    const auto power = [&](const char* run) { return output::read_json(scratch / run / "summary.json")["power_W"]["com"].get<double>(); };
    const double gravity = result(wanted, "power", "power_gravity").value[0];
    CHECK_THAT(power(name), WithinRel(power("own"), 0.01));
    CHECK(gravity > 0);
  }
  // Near enough in time for a camera.
  const output::TrackReader tracks(scratch / "dumps/tracks.h5");
  CHECK(tracks.tracks().size() == 48);
  const output::TrackSamples track = tracks.read(5);
  const double step = (track.time.back() - track.time.front()) / static_cast<double>(track.size() - 1);
  CHECK(step <= 0.00051);
  const camera::SimulatedBeads beads(scratch / "dumps", testing::registry());
  CHECK_THAT(beads.condition().speed.value(), WithinRel(8.879, 1e-3));
}

TEST_CASE("somebody's drum: as many beads, its speed at the shell") {
  const fs::path file = testing::public_case("data/dem_frames/drum_1804000.vtk.gz");
  if (testing::absent(file)) return;
  const Scratch scratch;
  const frames::Imported done =
      imported(scratch, "files: " + file.string() + "\naxis: y\ngravity: -z\nmill: {diameter: 100 mm, ends: [-100 mm, 100 mm]}\n");
  CHECK(done.beads == 21992);
  CHECK(done.frames == 1);
  const output::FrameReader reader(scratch / "out/frames.h5");
  const auto small =
      std::count_if(reader.beads().radius.begin(), reader.beads().radius.end(), [](double r) { return std::fabs(r - 0.0008) < 1e-6; });
  const auto large =
      std::count_if(reader.beads().radius.begin(), reader.beads().radius.end(), [](double r) { return std::fabs(r - 0.00182) < 1e-6; });
  CHECK(small == 14205);
  CHECK(large == 7787);
  // Beads whose middle is within 3 % of the shell: small ones alone can be. 3.55 rad/s is what whoever passed the frame on says of the
  // wall.
  const auto x = values_of(reader, output::BeadField::position, 0), v = values_of(reader, output::BeadField::velocity, 0);
  std::vector<double> turning;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const double r = std::hypot(x[i], x[i + 1]);
    if (r > 0.97 * 0.05) turning.push_back((double{x[i]} * double{v[i + 1]} - double{x[i + 1]} * double{v[i]}) / (r * r));
  }
  CHECK_THAT(base::quantile(turning, 0.5), WithinAbs(3.55, 0.02));
  // All that touch the shell, whatever their size: 36 rpm.
  const auto summary = output::read_json(scratch / "out/summary.json");
  CHECK_THAT(summary["engine"]["shell_turns_rad_per_s"].get<double>(), WithinRel(36 * M_PI / 30, 0.005));
  CHECK_THAT(summary["mill_speed_rad_per_s"].get<double>(), WithinRel(36 * M_PI / 30, 0.005));
  const analysis::ResultSet maps = analyzed(scratch / "out", {"pept_grid", "power", "models"});
  CHECK(result(maps, "pept_grid", "outside_fraction").value[0] == 0);
  CHECK(result(maps, "power", "centre_of_mass_x").value[0] > 0.01);
  CHECK_THAT(result(maps, "models", "filling").value[0], WithinAbs(0.229, 0.002));
  CHECK(says(maps.meta.notes, "there is one frame"));
}

TEST_CASE("velocities that are not there") {
  const Scratch scratch;
  write(scratch / "near.txt", turning(12, 0.01, kPlaces));
  const std::string beads = "beads: {density: 2500}\ntime: {step: 0.01 s}\n";
  const frames::Imported near = imported(scratch, mill("near.txt", beads));
  CHECK(says(near.notes, "differences of places 10 ms apart"));
  const output::FrameReader reader(scratch / "out/frames.h5");
  const Charge c = charge(60, 2, 2 * 0.01 * 4);
  const auto v = values_of(reader, output::BeadField::velocity, 4);
  // A chord of 0.04 rad is shorter than its arc by 7e-5.
  for (std::size_t i = 0; i < c.size(); ++i) REQUIRE_THAT(double{v[3 * i]}, WithinAbs(c.velocity[i][0], 2e-4));
  CHECK(has_result(analyzed(scratch / "out"), "pept_grid", "speed"));
  // Farther apart than a bead: where they are is all that is told.
  write(scratch / "far.txt", turning(6, 0.1, kPlaces));
  const frames::Imported far = imported(scratch, mill("far.txt", "beads: {density: 2500}\ntime: {step: 0.1 s}\n"));
  CHECK(says(far.notes, "more than its radius of 4.67 mm"));
  CHECK(says(far.notes, "let the program write velocities"));
  const analysis::ResultSet maps = analyzed(scratch / "out", {"pept_grid", "power", "distributions"});
  CHECK(has_result(maps, "pept_grid", "occupancy"));
  CHECK_FALSE(has_result(maps, "pept_grid", "speed"));
  CHECK(has_result(maps, "power", "power_gravity"));
  CHECK_FALSE(has_result(maps, "power", "power_bbosa"));
  CHECK(has_result(maps, "distributions", "x_percent"));
  CHECK_THAT(refusal([&] { analyzed(scratch / "out", {"circulation"}); }), Contains("needs velocities"));
}

TEST_CASE("frames too far apart for a camera") {
  const Scratch scratch;
  write(scratch / "d.txt", turning(10, 0.02, kAll));
  imported(scratch, mill("d.txt", "beads: {density: 2500}\ntime: {step: 0.02 s}\n"));
  CHECK_FALSE(fs::exists(scratch / "out/tracks.h5"));
  const std::string said = refusal([&] { const camera::SimulatedBeads beads(scratch / "out", testing::registry()); });
  CHECK_THAT(said, Contains("its frames are 20 ms apart, and the camera needs frames at most 5 ms apart"));
  CHECK(said.find('\n') == std::string::npos);
}

TEST_CASE("beads that come and go count where they are there") {
  const Scratch scratch;
  std::string text = dump(Charge{}, 0);  // before the first bead is put in
  for (int f = 1; f < 21; ++f) {
    Charge c = charge(60, 2, 0.02 * f);
    if (f < 11) {
      for (auto* list : {&c.place, &c.velocity, &c.spin}) list->resize(40);
      c.id.resize(40), c.type.resize(40), c.radius.resize(40);
    }
    text += dump(c, f);
  }
  write(scratch / "d.txt", text);
  const frames::Imported done = imported(scratch, mill("d.txt", "beads: {density: 2500}\ntime: {step: 0.01 s}\n"));
  CHECK(done.beads == 60);
  CHECK(done.frames == 20);
  CHECK(says(done.notes, "1 of 21 frames hold no bead"));
  CHECK(says(done.notes, "from 40 to 60 in a frame; 60 different ones"));
  const analysis::ResultSet all = analyzed(scratch / "out");
  // Weights are a frame's share of the time: 50 beads in the mean, for 0.2 s.
  CHECK_THAT(result(all, "pept_grid", "bead_time").value[0], WithinRel(50 * 0.2, 1e-9));
  CHECK_THAT(all.meta.context.charge_count, WithinRel(50, 0.02));
  const output::FrameReader reader(scratch / "out/frames.h5");
  REQUIRE(reader.scalars().mass_there.size() == 20);
  CHECK(std::isnan(values_of(reader, output::BeadField::position, 0)[3 * 50]));
  CHECK_FALSE(std::isnan(values_of(reader, output::BeadField::position, 15)[3 * 50]));
}

TEST_CASE("the axes of the files, and a liner in them") {
  const Scratch scratch;
  const Charge c = charge();
  // Along y, down −x: a file's x is our y, its z is our x; with our x = up × axis.
  Charge turned = c;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const auto put = [](const std::array<double, 3>& ours, double shift) {
      return std::array<double, 3>{ours[1], ours[2] - shift, ours[0]};
    };
    turned.place[i] = put(c.place[i], 0.025);
    turned.velocity[i] = put(c.velocity[i], 0), turned.spin[i] = put(c.spin[i], 0);
  }
  write(scratch / "d.txt", dump(turned, 1));
  // A shell of 24 faces in the same axes.
  std::string stl = "solid shell\n";
  for (int k = 0; k < 24; ++k) {
    const auto corner = [&](int at, double y) {
      const double a = 2 * M_PI * at / 24;
      return fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", 101 * std::sin(a), y, 101 * std::cos(a));
    };
    const std::string a = corner(k, -25), b = corner(k + 1, -25), d = corner(k, 25), e = corner(k + 1, 25);
    for (const std::string& triangle : {a + b + e, a + e + d}) stl += "facet normal 0 0 0\nouter loop\n" + triangle + "endloop\nendfacet\n";
  }
  write(scratch / "shell.stl", stl + "endsolid shell\n");
  const std::string text =
      "files: d.txt\naxis: y\ngravity: -x\nbeads: {density: 2500}\nmill: {diameter: 200 mm, ends: [-25 mm, 25 mm], periodic: true, speed: "
      "2 rad/s, liner: {file: shell.stl, unit: ";
  const frames::Imported done = imported(scratch, text + "mm}}\n");
  CHECK(says(done.notes, "found to turn counter-clockwise"));
  const output::FrameReader reader(scratch / "out/frames.h5");
  const auto x = values_of(reader, output::BeadField::position, 0), v = values_of(reader, output::BeadField::velocity, 0),
             w = values_of(reader, output::BeadField::spin, 0);
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      REQUIRE_THAT(double{x[3 * i + k]}, WithinAbs(c.place[i][k], 1e-7));
      REQUIRE_THAT(double{v[3 * i + k]}, WithinAbs(c.velocity[i][k], 1e-7));
      REQUIRE_THAT(double{w[3 * i + k]}, WithinAbs(c.spin[i][k], 1e-7));
    }
  }
  const analysis::MillOfCase found = analysis::read_mill_of_case(scratch / "out/case.resolved.yaml", testing::registry());
  CHECK_THAT(found.context.mill_radius, WithinRel(0.1, 0.02));
  CHECK_THAT(found.context.mill_length, WithinRel(0.05, 1e-6));
  CHECK_THAT(refusal([&] { imported(scratch, text + "cm}}\n"); }),
             Contains("mill.yaml: geometry 'mesh'") && Contains("period 0.05 m is not the extent"));
  const std::string narrow = std::string(text).replace(text.find("200 mm"), 6, "208 mm") + "mm}, direction: counter_clockwise}\n";
  CHECK_THAT(refusal([&] { imported(scratch, narrow); }), Contains("the liner 'shell.stl' has a bore of 0.101"));
}

TEST_CASE("an imported case holds no physics to run") {
  const Scratch scratch;
  write(scratch / "d.txt", dump(charge(), 1));
  imported(scratch, mill("d.txt", "beads: {density: 2500}\n"));
  const config::Case c = config::read_case((scratch / "out/case.resolved.yaml").string());
  CHECK(c.fill.count == 60);
  CHECK(c.contact.law.kind.empty());
  CHECK_THAT(refusal([&] { config::finish(c, testing::registry().descriptors()); }), Contains("'run.engine' is 'imported'"));
  CHECK_THAT(refusal([&] { run::assemble(c, testing::registry()); }),
             Contains("case.resolved.yaml:4") && Contains("another program moved these beads"));
}
