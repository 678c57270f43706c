// What other programs write, read as it is meant: every layout of docs/import.md holds the same charge.
#include <catch2/catch.hpp>
#include <cmath>

#include "frames/support.hpp"
#include "studies/frames/columns.hpp"

using namespace frames_test;
using namespace millscope;
using frames::Frame;

namespace {

/// As single precision has it.
void same(const Frame& frame, const Charge& wanted) {
  REQUIRE(frame.count == wanted.size());
  double worst = 0;
  for (std::size_t i = 0; i < frame.count; ++i) {
    REQUIRE(frame.has(frames::kId));
    worst = std::max(worst, std::fabs(frame.value[frames::kId][i] - static_cast<double>(wanted.id[i])));
    for (std::size_t k = 0; k < 3; ++k) {
      worst = std::max(worst, std::fabs(frame.value[frames::kX + k][i] - wanted.place[i][k]));
      worst = std::max(worst, std::fabs(frame.value[frames::kVelocityX + k].at(i) - wanted.velocity[i][k]));
      worst = std::max(worst, std::fabs(frame.value[frames::kSpinX + k].at(i) - wanted.spin[i][k]));
    }
    worst = std::max(worst, std::fabs(frame.value[frames::kRadius].at(i) - wanted.radius[i]));
  }
  CHECK(worst < 2e-7);
}

Frame only(const std::string& file, double length = 1) {
  const std::vector<Frame> all = frames_of({file}, length);
  REQUIRE(all.size() == 1);
  return all[0];
}

}  // namespace

TEST_CASE("dumps of LIGGGHTS and LAMMPS") {
  const Scratch scratch;
  const Charge c = charge();
  const Frame plain = only(write(scratch / "dump.txt", dump(c, 1000)));
  same(plain, c);
  CHECK(plain.step == 1000);
  CHECK_FALSE(plain.time);
  CHECK(plain.place(2).ends_with("dump.txt:12"));
  same(only(write_gzip(scratch / "dump.gz", dump(c, 1000))), c);
  same(only(write(scratch / "scaled", dump(c, 5, "id type xs ys zs vx vy vz omegax omegay omegaz radius"))), c);
  // LAMMPS' extra lines, and a frame behind another.
  const std::string timed = "ITEM: UNITS\nsi\nITEM: TIME\n0.25\n" + dump(c, 7) + "ITEM: TIME\n0.5\n" + dump(c, 8);
  const std::vector<Frame> two = frames_of({write(scratch / "timed", timed)});
  REQUIRE(two.size() == 2);
  CHECK(two[0].time == 0.25);
  CHECK(two[1].time == 0.5);
  same(two[1], c);
}

TEST_CASE("EDEM's exports and other tables") {
  const Scratch scratch;
  const Charge c = charge(), later = charge(60, 2, 0.1);
  const Frame one = only(write(scratch / "one.csv", "EXTRACTED DATA\n\n" + table(c, "0.5")));
  same(one, c);
  CHECK(one.time == 0.5);
  CHECK(one.passed_over == std::vector<std::string>{"Kinetic Energy (J)"});
  CHECK_FALSE(only(write(scratch / "plain.csv", table(c))).time);
  // Heads that are numbered as queries are.
  std::string numbered = table(c, "0.5");
  const std::size_t head = numbered.find('\n') + 1;
  for (std::size_t at = head, k = 1; k < 20; ++k) {
    const std::string number = "Q" + std::to_string(10 + k) + " : ";
    numbered.insert(at, number);
    at = numbered.find_first_of(",\n", at + number.size());
    if (numbered[at++] == '\n') break;
  }
  same(only(write(scratch / "numbered.csv", numbered)), c);
  // Decimal commas between semicolons; tabs.
  same(only(write(scratch / "commas.csv", table(c, "0,5", ';'))), c);
  same(only(write(scratch / "tabs.txt", table(c, "0.5", '\t'))), c);
  const std::vector<Frame> blocks = frames_of({write(scratch / "two.csv", table(c, "0.5") + "\n" + table(later, "0.6"))});
  REQUIRE(blocks.size() == 2);
  same(blocks[1], later);
  CHECK(blocks[1].time == 0.6);
  // The head once, then times and rows.
  const std::string second = table(later, "0.6");
  const std::string bare = second.substr(0, second.find('\n') + 1) + second.substr(second.find('\n', second.find('\n') + 1) + 1);
  const std::vector<Frame> once = frames_of({write(scratch / "once.csv", table(c, "0.5") + bare)});
  REQUIRE(once.size() == 2);
  same(once[1], later);
}

TEST_CASE("a column of times parts a table into frames") {
  const Scratch scratch;
  const std::vector<Frame> all =
      frames_of({write(scratch / "t.csv", "Time (s),id,x,y,z\n0,1,1,2,3\n0,2,4,5,6\n0.1,1,7,8,9\n0.1,2,1,1,1\n")});
  REQUIRE(all.size() == 2);
  CHECK(all[1].time == 0.1);
  CHECK(all[1].count == 2);
  CHECK(all[1].value[frames::kY] == std::vector<double>{8, 1});
}

TEST_CASE("EDEM's queries, a line each and one below the other") {
  const Scratch scratch;
  const Charge c = charge(), later = charge(60, 2, 0.1);
  for (const bool below : {false, true}) {
    const std::string text = "EDEM 2022\nTitle,x\nEXTRACTED DATA\n" + queries(c, 0.5, below) + queries(later, 0.6, below);
    const std::vector<Frame> all = frames_of({write(scratch / "q.csv", text)});
    REQUIRE(all.size() == 2);
    same(all[0], c);
    same(all[1], later);
    CHECK(all[1].time == 0.6);
  }
}

TEST_CASE("legacy VTK: text and bytes, points and grids") {
  const Scratch scratch;
  const Charge c = charge();
  for (const bool binary : {false, true}) {
    for (const bool grid : {false, true}) {
      CAPTURE(binary, grid);
      const Frame frame = only(write(scratch / "beads_12.vtk", legacy_vtk(c, binary, grid)));
      same(frame, c);
      CHECK(frame.step == 12);
      same(only(write_gzip(scratch / "beads_12.vtk.gz", legacy_vtk(c, binary, grid))), c);
    }
  }
}

TEST_CASE("VTK's XML in every coding") {
  const Scratch scratch;
  const Charge c = charge();
  for (const Coding coding : {Coding::ascii, Coding::base64, Coding::raw, Coding::appended_base64}) {
    for (const int kind : {0, 1, 2, 3, 4, 5, 6, 7}) {
      const bool packed = (kind & 1) != 0, wide = (kind & 2) != 0, big = (kind & 4) != 0;
      CAPTURE(static_cast<int>(coding), packed, wide, big);
      const Frame frame =
          only(write(scratch / "b.vtp", xml_vtk(c, coding, packed && coding != Coding::ascii, packed == wide, wide, big, "0.75")));
      same(frame, c);
      CHECK(frame.time == 0.75);
    }
  }
}

TEST_CASE("several files stand in the order of their numbers") {
  const Scratch scratch;
  std::vector<fs::path> files;
  for (const int step : {10, 9, 100})
    files.emplace_back(write(scratch / ("dump" + std::to_string(step) + ".txt"), dump(charge(60, 2, 0.01 * step), step)));
  const std::vector<Frame> all = frames_of(files);
  REQUIRE(all.size() == 3);
  CHECK(all[0].step == 9);
  CHECK(all[1].step == 10);
  CHECK(all[2].step == 100);
  std::vector<fs::path> tables;
  for (const char* time : {"0.5", "0.15", "0.05"})
    tables.emplace_back(write(scratch / ("at_" + std::string(time) + ".csv"), table(charge(), time)));
  const std::vector<Frame> timed = frames_of(tables);
  REQUIRE(timed.size() == 3);
  CHECK(timed[0].time == 0.05);
  CHECK(timed[1].time == 0.15);
}

TEST_CASE("a .pvd says the times of the files that it lists") {
  const Scratch scratch;
  const Charge c = charge(), later = charge(60, 2, 0.1);
  write(scratch / "a.vtp", xml_vtk(c, Coding::raw, true, false));
  write(scratch / "b.vtp", xml_vtk(later, Coding::raw, false, false));
  const std::string list = R"(<?xml version="1.0"?>
<VTKFile type="Collection"><Collection>
<DataSet timestep="1.5" group="" part="0" file="a.vtp"/>
<DataSet timestep="2.5" group="" part="0" file="b.vtp"/>
</Collection></VTKFile>)";
  const std::vector<Frame> all = frames_of({write(scratch / "all.pvd", list)});
  REQUIRE(all.size() == 2);
  CHECK(all[0].time == 1.5);
  same(all[0], c);
  CHECK(all[1].time == 2.5);
  same(all[1], later);
}

TEST_CASE("columns are known by their names, and their units are turned") {
  const frames::ReadOptions millimetres{.length = 1e-3, .speed = 1e-3};
  const auto factor = [&](const char* name) { return frames::column_of(name, millimetres).to_si; };
  const auto is = [&](const char* name, frames::Quantity q) { return frames::column_of(name, millimetres).quantity == q; };
  CHECK(is("Q01 : Particle Position X:", frames::kX));
  CHECK(is("Points:2", frames::kZ));
  CHECK(is("omegay", frames::kSpinY));
  CHECK(is("Angular Velocity Z (rad/s)", frames::kSpinZ));
  CHECK(is("Particle ID", frames::kId));
  CHECK(factor("x") == 1e-3);
  CHECK(factor("Position X (m)") == 1);
  CHECK(factor("Velocity X (cm/s)") == Approx(0.01));
  CHECK(factor("Diameter (mm)") == Approx(0.0005));
  CHECK(factor("Angular Velocity X (deg/s)") == Approx(M_PI / 180));
  for (const char* unknown : {"fx", "ix", "c_stress[1]", "Velocity Magnitude", "Kinetic Energy (J)", "speed", "mass"})
    CHECK_FALSE(frames::column_of(unknown, millimetres).quantity);
  CHECK_THROWS_WITH(frames::column_of("Position X (kg)", millimetres), Catch::Contains("'kg' is no unit like m"));
  CHECK_THROWS_WITH(frames::Columns({"x", "Position X (m)"}, millimetres), Catch::Contains("the same quantity"));
}
