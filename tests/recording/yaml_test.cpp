// recording.yaml.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include <numbers>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

namespace {

struct Folder : Scratch {
  Folder() {
    file("a.txt", circle_rows(300));
    file("b.txt", circle_rows(200));
  }
  recording::Recording read(const std::string& yaml) const { return recording::read_recording(file("r.yaml", yaml)); }
  std::string why(const std::string& yaml) const {
    return refusal([&] { read(yaml); });
  }
};

}  // namespace

TEST_CASE("several files are several runs, each with its own start") {
  const Folder folder;
  const recording::Recording recording = folder.read("files: [b.txt, a.txt]\n");
  REQUIRE(recording.runs.size() == 2);
  CHECK(recording.runs[0].name == "b");
  CHECK(recording.runs[1].name == "a");
  CHECK(recording.runs[0].time[0] == 0);
  CHECK(recording.runs[1].time[0] == 0);
  CHECK(recording.runs[1].source == (folder / "a.txt").string());
  CHECK_THAT(folder.why("files: [a.txt, a.txt]\n"), Contains("r.yaml:1:") && Contains("second time"));
}

TEST_CASE("a pattern names all files that match, by name, and runs of one name are told apart") {
  const Folder folder;
  std::filesystem::create_directory(folder / "more");
  folder.file("more/a.txt", circle_rows(250));
  const recording::Recording recording = folder.read("files: [\"?.txt\", more/a.txt]\n");
  REQUIRE(recording.runs.size() == 3);
  CHECK(recording.runs[0].name == "a");
  CHECK(recording.runs[1].name == "b");
  CHECK(recording.runs[2].name == "a_2");
  CHECK_THAT(folder.why("files: \"*.a\"\n"), Contains("r.yaml:1:") && Contains("no file has such a name"));
}

TEST_CASE("the condition is read in SI, and what is absent stays unknown") {
  const Folder folder;
  const recording::Condition c = folder
                                     .read(R"(files: a.txt
condition:
  speed: 75 %critical
  direction: clockwise
  filling: 31.3 %
  porosity: 0.37
  bead_diameter: 10 mm
  bead_density: 2.5 g/cm^3
  tracer: {diameter: 10 mm, density: 2500}
  mill_diameter: 300 mm
  mill_length: 60 mm
  power: {value: 7.335 W, sem: 3 mW}
encoder: none
)")
                                     .condition;
  const double critical = 42.3 / std::sqrt(0.29) * std::numbers::pi / 30;
  CHECK(*c.speed == Approx(0.75 * critical));
  CHECK(*c.angular_velocity == Approx(-0.75 * critical));
  CHECK(*c.filling == Approx(0.313));
  CHECK(*c.porosity == Approx(0.37));
  CHECK(*c.bead_diameter == 0.01);
  CHECK(*c.bead_density == Approx(2500));
  CHECK(*c.tracer.density == 2500);
  CHECK(*c.mill_length == 0.06);
  CHECK(c.power->sem == Approx(0.003));
  CHECK(c.geometry.empty());

  const recording::Condition none = folder.read("files: a.txt\n").condition;
  CHECK_FALSE(none.speed);
  CHECK_FALSE(none.filling);
  CHECK_FALSE(none.power);
}

TEST_CASE("a speed without a sense keeps the sense open") {
  const Folder folder;
  const auto condition = [&](const std::string& text) { return folder.read("files: a.txt\ncondition: {" + text + "}\n").condition; };
  CHECK(*condition("speed: 36 rpm").speed == Approx(3.7699).epsilon(1e-4));
  CHECK_FALSE(condition("speed: 36 rpm").angular_velocity);
  CHECK(*condition("speed: -36 rpm").angular_velocity == Approx(-3.7699).epsilon(1e-4));
  CHECK(*condition("speed: 36 rpm, direction: counter_clockwise").angular_velocity == Approx(3.7699).epsilon(1e-4));
  for (const char* half : {"", ", mill_diameter: 300 mm", ", bead_diameter: 10 mm"}) {
    CHECK_THAT(folder.why(std::string("files: a.txt\ncondition: {speed: 75 %critical") + half + "}\n"),
               Contains("r.yaml:2:") && Contains("needs mill_diameter and bead_diameter; add them or give rpm"));
  }
}

TEST_CASE("numbers of the condition that cannot be meant are refused with the unit") {
  const Folder folder;
  const auto why = [&](const std::string& text) { return folder.why("files: a.txt\ncondition:\n  " + text + "\n"); };
  CHECK_THAT(why("bead_diameter: 5"), Contains("'bead_diameter'") && Contains("5 m") && Contains("e.g. 5 mm"));
  CHECK_THAT(why("tracer: {diameter: 5}"), Contains("tracer: diameter") && Contains("e.g. 5 mm"));
  CHECK_THAT(why("mill_length: 60"), Contains("r.yaml:3:") && Contains("60 mm"));
  CHECK_THAT(why("mill_length: 30"), Contains("'mill_length'") && Contains("along z"));
  CHECK_THAT(why("mill_length: 2 mm"), Contains("'mill_length'") && Contains("along z"));
  CHECK_THAT(why("slice: [0, 20]"), Contains("r.yaml:3:") && Contains("20 mm"));
  CHECK_THAT(why("slice: [20 mm, 0 mm]"), Contains("'condition.slice'") && Contains("must rise"));
  CHECK_THAT(why("slice: 20 mm"), Contains("r.yaml:3:"));
  CHECK_THAT(folder.why("files: a.txt\ncondition: {slice: [0 mm, 60 mm]}\nframe: {axis: [0 mm, 0 mm], ends: [0 mm, 60 mm]}\n"),
             Contains("'condition.slice'") && Contains("no ends"));
  CHECK_THAT(why("bead_density: 2.5"), Contains("r.yaml:3:") && Contains("kg/m^3"));
  CHECK_THAT(why("bead_density: 22.6"), Contains("kg/m^3"));  // osmium in g/cm^3
  CHECK(why("bead_density: 30").empty());                     // foam
  CHECK_THAT(why("tracer: {density: 2.5}"), Contains("kg/m^3"));
  CHECK_THAT(why("porosity: 1"), Contains("r.yaml:3:") && Contains("no bead"));
  CHECK_THAT(why("mill_diameter: 300"), Contains("r.yaml:3:") && Contains("300 mm"));
  CHECK(why("{bead_diameter: 5 mm, mill_length: 60 mm, bead_density: 2.5 g/cm^3, porosity: 0.4, mill_diameter: 300 mm}").empty());
}

TEST_CASE("a ctrack file's layout is fixed: keys that would change it are refused") {
  const Folder folder;
  std::string rows;
  for (int k = 0; k < 200; ++k) rows += ctrack_row(5 * k, 100 * std::cos(0.02 * k), 100 * std::sin(0.02 * k), 30);
  folder.file("run.a", ctrack_head() + rows);
  for (const char* format : {"ctrack", "auto"}) {
    const std::string head = fmt::format("files: run.a\nformat: {}\n", format);
    CHECK_THAT(folder.why(head + "skip_lines: 20\n"), Contains("r.yaml:3:") && Contains("'skip_lines' is of no use"));
    CHECK_THAT(folder.why(head + "separator: blank\n"), Contains("r.yaml:3:") && Contains("'separator' is of no use"));
  }
  const std::string head = "files: run.a\nformat: ctrack\ncolumns: ";
  CHECK_THAT(
      folder.why(head + "{t: {column: 1, unit: ms}, x: {column: 3, unit: mm}, y: {column: 2, unit: mm}, z: {column: 4, unit: mm}}\n"),
      Contains("r.yaml:3:") && Contains("give the units alone"));
  CHECK_THAT(folder.why(head + "{t: ms, x: mm, y: mm, z: mm, label: skip}\n"), Contains("give the units alone"));
  CHECK(folder.read(head + "{t: ms, x: mm, y: mm, z: mm}\n").runs[0].size() == 200);
  CHECK(folder.read(head + "{t: ms, x: cm, y: cm, z: cm}\n").runs[0].position[0][0] == Approx(1.0));
}

TEST_CASE("the mill's diameter comes from the geometry's case where it is not said") {
  const Folder folder;
  folder.file("mill.yaml", "mill: {diameter: 300 mm, speed: 75 %critical}\n");
  const std::string head = "files: a.txt\ncondition:\n  bead_diameter: 10 mm\n  speed: 75 %critical\n  geometry: mill.yaml\n";
  const recording::Condition c = folder.read(head).condition;
  CHECK(*c.mill_diameter == Approx(0.3));
  CHECK(c.geometry == folder / "mill.yaml");
  CHECK(*c.speed == Approx(6.169).epsilon(1e-3));
  CHECK_THAT(folder.why(head + "  mill_diameter: 310 mm\n"), Contains("r.yaml:5:") && Contains("mill_diameter"));
}

TEST_CASE("axes are swapped and turned, and nothing is mirrored silently") {
  const Folder folder;
  const recording::Run plain = folder.read("files: a.txt\n").runs[0];
  const recording::Run turned = folder.read("files: a.txt\naxes: {x: y, y: -x, z: +z}\n").runs[0];
  for (const std::size_t i : {0u, 17u, 299u}) {
    CHECK(turned.position[0][i] == plain.position[1][i]);
    CHECK(turned.position[1][i] == -plain.position[0][i]);
    CHECK(turned.position[2][i] == plain.position[2][i]);
  }
  CHECK_THAT(folder.why("files: a.txt\naxes: {x: -x, y: y, z: z}\n"), Contains("r.yaml:2:") && Contains("mirror: true"));
  const recording::Run mirrored = folder.read("files: a.txt\nmirror: true\naxes: {x: -x, y: y, z: z}\n").runs[0];
  CHECK(mirrored.position[0][9] == -plain.position[0][9]);
  CHECK_THAT(folder.why("files: a.txt\nmirror: true\naxes: {x: y, y: z, z: x}\n"), Contains("mirrors nothing"));
  CHECK_THAT(folder.why("files: a.txt\naxes: {x: y, y: y, z: z}\n"), Contains("second time"));
  CHECK_THAT(folder.why("files: a.txt\naxes: {x: up, y: y, z: z}\n"), Contains("'up'"));
}

TEST_CASE("where the mill stands is taken as it is given") {
  const Folder folder;
  const recording::Recording recording = folder.read("files: a.txt\nframe: {axis: [1.4 mm, -0.9 mm], ends: [0, 60 mm]}\n");
  REQUIRE(recording.frame);
  CHECK(recording.frame->axis[0] == Approx(0.0014));
  CHECK(recording.frame->axis[1] == Approx(-0.0009));
  CHECK(recording.frame->high == Approx(0.06));
  const recording::Recording bare = folder.read("files: a.txt\nframe: {axis: [1.4, -0.9, mm], ends: [0, 6, cm]}\n");
  CHECK(bare.frame->axis == recording.frame->axis);
  CHECK(bare.frame->high == Approx(0.06));
  CHECK_THAT(folder.why("files: a.txt\nframe: {axis: [1, 2, s]}\n"), Contains("r.yaml:2:") && Contains("length"));
  CHECK_FALSE(folder.read("files: a.txt\n").frame);
  CHECK_THAT(folder.why("files: a.txt\nframe: {axis: [0, 0], ends: [60 mm, 0]}\n"), Contains("must rise"));
}

TEST_CASE("what is wrong is named with its line") {
  const Folder folder;
  CHECK_THAT(folder.why("files: a.txt\ncondition:\n  fillin: 30 %\n"), Contains("r.yaml:3:") && Contains("did you mean 'filling'"));
  CHECK_THAT(folder.why("files: a.txt\nformat: ctrak\n"), Contains("r.yaml:2:") && Contains("did you mean 'ctrack'"));
  CHECK_THAT(folder.why("format: ctrack\n"), Contains("missing key 'files'"));
  CHECK_THAT(folder.why("files: []\n"), Contains("empty list"));
  CHECK_THAT(folder.why("files: gone.txt\n"), Contains("gone.txt") && Contains("cannot be opened"));
  CHECK_THAT(folder.why("files: a.txt\ncolumns: {t: ms, x: mm, y: mm}\n"), Contains("r.yaml:2:") && Contains("has no 'z'"));
  CHECK_THAT(folder.why("files: a.txt\ncolumns: {t: mm, x: mm, y: mm, z: mm}\n"), Contains("r.yaml:2:") && Contains("time, e.g. ms"));
  CHECK_THAT(folder.why("files: a.txt\ncolumns: {t: ms, x: furlong, y: mm, z: mm}\n"), Contains("furlong"));
  CHECK_THAT(folder.why("files: a.txt\ncolumns: {t: ms, time: ms, x: mm, y: mm, z: mm}\n"), Contains("second column"));
  CHECK_THAT(folder.why("files: a.txt\ncolumns: {t: ms, speed: m/s, x: mm, y: mm, z: mm}\n"), Contains("write 'skip'"));
  CHECK_THAT(folder.why("files: a.txt\ncondition: {direction: clockwise}\n"), Contains("without 'speed'"));
  CHECK_THAT(folder.why("files: a.txt\ncondition: {speed: -3 rad/s, direction: clockwise}\n"), Contains("sign beside"));
  CHECK_THAT(folder.why("files: a.txt\ncondition: {power: {value: 7 W}}\n"), Contains("missing key 'sem'"));
  CHECK_THAT(folder.why("files: a.txt\nencoder: pulses.csv\n"), Contains("must be one of none"));
  CHECK_THAT(folder.why("files: a.txt\ngap_limit: 0\n"), Contains("gap_limit"));
  CHECK_THAT(folder.why("files: a.txt\ngap_limit: 40\n"), Contains("r.yaml:2:") && Contains("50 ms"));
}

TEST_CASE("the examples that come with millscope are read") {
  const Scratch scratch;
  const std::filesystem::path examples = std::filesystem::path(MILLSCOPE_SOURCE_DIR) / "configs" / "recordings";
  for (const char* name : {"ctrack.yaml", "table.yaml"}) std::filesystem::copy_file(examples / name, scratch / name);
  std::string rows;
  for (int k = 0; k < 200; ++k) rows += ctrack_row(5 * k, 100 * std::cos(0.02 * k), 100 * std::sin(0.02 * k), 30);
  for (const char* name : {"run1.a", "run2.a"}) scratch.file(name, ctrack_head() + rows);
  const recording::Recording runs = recording::read_recording(scratch / "ctrack.yaml");
  REQUIRE(runs.runs.size() == 2);
  CHECK(runs.runs[0].size() == 200);
  CHECK(*runs.condition.angular_velocity < 0);

  std::string table;
  for (int k = 0; k < 200; ++k) {
    table += std::to_string(0.005 * k) + ",0.5,30," + std::to_string(100 * std::cos(0.02 * k)) + "," +
             std::to_string(100 * std::sin(0.02 * k)) + ",tracer\n";
  }
  scratch.file("tracer.csv", table);
  const recording::Run run = recording::read_recording(scratch / "table.yaml").runs[0];
  REQUIRE(run.size() == 200);
  CHECK(run.position[0][100] == Approx(0.1 * std::cos(2.0)));
  CHECK(run.position[1][100] == Approx(0.1 * std::sin(2.0)));
  CHECK(run.position[2][100] == Approx(0.03));
  CHECK(run.spread[100] == Approx(0.5e-3));
}
