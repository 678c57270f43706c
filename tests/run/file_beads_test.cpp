// Beads from a file: where it puts them, as fast as it says, and refused with its line where they cannot be.
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>

#include "dem/support.hpp"
#include "kernel/config/bead_file.hpp"
#include "kernel/run/assembly.hpp"
#include "kernel/run/derived_case.hpp"
#include "tests/scratch.hpp"

using namespace millscope;
using namespace dem_test;
using Catch::Contains;
using run::Assembly;
using testing::refusal;

namespace {

struct Folder : testing::Scratch {
  std::string file(const std::string& text) const {
    std::ofstream(path / "beads.csv", std::ios::binary) << text;
    return (path / "beads.csv").string();
  }
};

Setup drum_with(const std::string& file) {
  Setup s;
  s.fill = "{file: " + file + "}";
  s.body_forces = kWithGravity;
  s.geometry = "{drum: {kind: mill, diameter: 100 mm, length: 20 mm, material: wall}}";
  s.domain = "{periodic: {z: [0, 20 mm]}}";
  return s;
}

Assembly placed(const Folder& folder, const std::string& text) {
  Assembly a = assembled(drum_with(folder.file(text)));
  run::insert_beads(a);
  return a;
}

std::string why(const Folder& folder, const std::string& text) {
  return refusal([&] { placed(folder, text); });
}

}  // namespace

// crosscheck and wear run a case that is derived from the user's: its beads had been cleared out of the file and were not given time to
// settle.
TEST_CASE("in a case that is derived from another the beads of a file begin where it puts them") {
  const Folder folder;
  const Assembly a = placed(folder, "# x [mm]; y [mm]; z [mm]; radius [mm]\n1.5; -20; 3; 2.5\n-9; -20; 13; 2.5\n");
  config::Case derived = a.c;
  run::fill_by_count(derived, a.bead_count);
  CHECK(derived.fill.file == a.c.fill.file);
  CHECK_FALSE(derived.fill.count.has_value());
  CHECK(derived.fill.settle == 0);
}

TEST_CASE("beads stand where a file puts them, and move as it says") {
  const Folder folder;
  const Assembly a = placed(folder,
                            "# x [mm]; y [mm]; z [mm]; radius [mm]; vx [m/s]; vy [m/s]; vz [m/s]; wx [rad/s]; wy [rad/s]; wz [rpm]\n"
                            "1.5; -20; 3; 2.5; 0.1; 0.2; 0.3; 1; 2; 60\n"
                            "-9; -20; 23; 2.5; 0; 0; 0; 0; 0; 0\n");
  REQUIRE(a.bead_count == 2);
  const dem::Particles& p = a.system->particles;
  CHECK(p.position[0].centre[0] == 0.0015);
  CHECK(p.position[0].centre[1] == -0.02);
  CHECK(p.position[0].radius == 0.0025);
  CHECK(p.motion[0].v[2] == 0.3);
  CHECK(p.motion[0].w[1] == 2);
  CHECK(p.motion[0].w[2] == Approx(2 * M_PI));
  CHECK(p.position[1].centre[2] == Approx(0.003));  // into the period of 20 mm
  CHECK(a.first_step == 0);                         // nothing settles
}

TEST_CASE("heads have a unit each or are SI, and other columns are passed over") {
  const Folder folder;
  for (const char* text : {"x,y,z,diameter\n0.001,-0.02,0.003,0.005\n", "id x [mm] y [mm] z [mm] diameter [mm]\n7 1 -20 3 5\n",
                           "X_mm\tY_mm\tZ_mm\tRadius_mm\tcolour\r\n1\t-20\t3\t2.5\tred\r\n",
                           "\xEF\xBB\xBFx (cm),y (cm),z (cm),diameter (cm)\n.1,-2,.3,.5\n"}) {
    CAPTURE(text);
    const auto beads = config::read_bead_file(folder.file(text));
    REQUIRE(beads.size() == 1);
    CHECK(beads[0].centre[0] == Approx(0.001));
    CHECK(beads[0].diameter == Approx(0.005));
  }
}

TEST_CASE("shares are those of the file, and no walls need bound it") {
  const Folder folder;
  Setup s;
  s.beads = "{small: {material: glass, diameter: 4 mm, share: 50 %}, large: {material: glass, diameter: 5 mm, share: 50 %}}";
  s.fill = "{file: " +
           folder.file(
               "# made by hand\nx [mm],y [mm],z [mm],diameter [mm],v_x [m/s],v_y [m/s],v_z [m/s]\n"
               "0,5,0,4,1,0,0\n9,5,0,4,0,0,0\n18,5,0,4,0,0,0\n27,5,0,5,0,0,0,\n") +
           "}";
  s.geometry = kFloor;
  Assembly a = assembled(s);
  run::insert_beads(a);
  CHECK(a.c.beads[0].number_share + a.c.beads[1].number_share == Approx(1));
  CHECK(std::max(a.c.beads[0].number_share, a.c.beads[1].number_share) == Approx(0.75));
  CHECK(a.system->particles.motion[0].v[0] == 1);
}

TEST_CASE("a file of beads that cannot be is refused at its line") {
  const Folder folder;
  const std::string heads = "x [mm],y [mm],z [mm],diameter [mm]\n";
  CHECK_THAT(why(folder, heads), Contains("beads.csv:1") && Contains("holds no bead"));
  CHECK_THAT(why(folder, "x [mm],y [mm],diameter [mm]\n0,0,5\n"), Contains("beads.csv:1") && Contains("no column 'z'"));
  CHECK_THAT(why(folder, "x [mm],y [mm],z [mm]\n0,0,5\n"), Contains("'diameter' or 'radius'"));
  CHECK_THAT(why(folder, "x [kg],y [mm],z [mm],radius [mm]\n0,0,0,5\n"), Contains("the unit 'kg' for 'x'"));
  CHECK_THAT(why(folder, "x [mm],y [mm],z [mm],radius [mm],vx\n0,0,0,5,0\n"), Contains("give all three or none"));
  CHECK_THAT(why(folder, heads + "0,0,0\n"), Contains("beads.csv:2") && Contains("3 columns, but 4 heads"));
  CHECK_THAT(why(folder, heads + "1,5,-20,3,5\n"), Contains("5 columns, but 4 heads"));  // a decimal comma
  CHECK_THAT(why(folder, "x [mm],y [mm],z [mm],radius [mm],vel_x\n0,0,0,5,0\n"),
             Contains("a column 'vel_x'") && Contains("call velocities vx"));
  CHECK_THAT(why(folder, heads + "0,0,nan,5\n"), Contains("beads.csv:2") && Contains("'nan'"));
  CHECK_THAT(why(folder, heads + "0,0,3,5\n0,0,3,7\n"), Contains("beads.csv:3") && Contains("no class below 'beads'"));
  CHECK_THAT(why(folder, heads + "0,0,3,5\n0,-49,3,5\n"), Contains("beads.csv:3") && Contains("1 of 2 beads"));
  CHECK_THAT(why(folder, heads + "0,0,3,5\n0,400,3,5\n"),
             Contains("beads.csv:3") && Contains("beyond a wall that reaches from -0.05 to 0.05 m"));
  CHECK_THAT(why(folder, heads + "0,0,1,5\n9,0,3,5\n0,0,18,5\n"), Contains("beads.csv:4") && Contains("line 2"));  // over the period
  CHECK(why(folder, heads + "0,0,3,5\n0,4.9,3,5\n").empty());                                                      // 4 % of the radius
  CHECK_THAT(why(folder, "x [mm],y [mm],z [mm],diameter [mm],material\n0,0,3,5,gold\n"), Contains("of gold"));
  CHECK_THAT(refusal([&] { assembled(drum_with((folder.path / "none.csv").string())); }), Contains("none.csv"));
}
