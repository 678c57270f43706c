// What cannot be right is refused with one line: file and line, the value, what to do.
#include <catch2/catch.hpp>

#include "frames/support.hpp"
#include "kernel/base/text.hpp"
#include "plugins.hpp"
#include "studies/frames/import.hpp"

using namespace frames_test;
using namespace millscope;
using Catch::Contains;

namespace {

std::string refused(const std::vector<fs::path>& files) {
  return refusal([&] { frames_of(files); });
}

/// Of an import of `text` as a dump, with what mill.yaml says besides; nothing is left then.
std::string not_imported(const Scratch& scratch, const std::string& text, const std::string& more = "beads: {density: 2500}\n",
                         const std::string& of_mill = "speed: 2 rad/s, direction: counter_clockwise", const std::string& files = "d.txt") {
  write(scratch / "d.txt", text);
  write(scratch / "mill.yaml", mill(files, more, of_mill));
  const std::string said = refusal([&] { frames::import_frames(scratch / "mill.yaml", scratch / "out", testing::registry(), {}); });
  CHECK(said.find('\n') == std::string::npos);
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(scratch.path)) left += entry.path().filename().string().starts_with("out") ? 1 : 0;
  if (!said.empty()) CHECK(left == 0);
  fs::remove_all(scratch / "out");
  return said;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("files that are cut short or damaged") {
  const Scratch scratch;
  const Charge c = charge();
  const std::string whole = dump(c, 1), binary = legacy_vtk(c, true, false), packed = xml_vtk(c, Coding::raw, true, false);
  CHECK_THAT(refused({write(scratch / "a", whole.substr(0, whole.find("\n58 ") + 1))}),
             Contains("a:66: the frame is cut short after 57 of 60 atoms"));
  CHECK_THAT(refused({write(scratch / "a", whole.substr(0, whole.size() - 10))}), Contains("holds") && Contains("words, its head 12"));
  CHECK_THAT(refused({write(scratch / "a", whole.substr(0, 60))}), Contains("cut short"));
  CHECK_THAT(refused({write(scratch / "a", whole + "7 7 7\n")}), Contains("a:70: '7 7 7' stands where an ITEM is expected"));
  CHECK_THAT(refused({write(scratch / "a", replaced(whole, "0.004", "0.o04"))}), Contains("'0.o04' is no number"));
  CHECK_THAT(refused({write(scratch / "a.vtk", binary.substr(0, binary.size() - 300))}), Contains("cut short"));
  CHECK_THAT(refused({write(scratch / "a.vtk", binary.substr(0, 300))}), Contains("a.vtk: byte 300") && Contains("cut short"));
  CHECK_THAT(refused({write(scratch / "a.vtk", replaced(legacy_vtk(c, false, false), "POINTS 60", "POINTS 61"))}),
             Contains("a.vtk:") && Contains("'VERTICES' stands where"));
  CHECK_THAT(refused({write(scratch / "a.vtp", packed.substr(0, packed.size() - 1000))}), Contains("array '") && Contains("cut short"));
  CHECK_THAT(refused({write(scratch / "a.vtp", packed.substr(0, 400))}), Contains("a.vtp: byte"));
  std::string spoilt = packed;
  spoilt[spoilt.size() - 300] = static_cast<char>(~spoilt[spoilt.size() - 300]);
  CHECK_THAT(refused({write(scratch / "a.vtp", spoilt)}), Contains("zlib cannot unpack"));
  write_gzip(scratch / "a.gz", whole);
  const std::string gzip = base::text_of(scratch / "a.gz");
  CHECK_THAT(refused({write(scratch / "b.gz", gzip.substr(0, gzip.size() / 2))}), Contains("the gzip file is cut short"));
  CHECK_THAT(refused({write(scratch / "t.csv", table(c).substr(0, 900))}), Contains("t.csv:") && Contains("cells, its head 13"));
  CHECK_THAT(refused({write(scratch / "q.csv", replaced(queries(c, 0.5, false), ",58,59,60", ""))}),
             Contains("holds 60 numbers, the queries before it 57"));
}

TEST_CASE("what is none of the formats, or holds no beads") {
  const Scratch scratch;
  const Charge c = charge();
  CHECK_THAT(refused({write(scratch / "e", "")}), Contains("is empty"));
  CHECK_THAT(refused({write(scratch / "e", "\x89HDF\r\n\x1a\n")}), Contains("HDF5"));
  CHECK_THAT(refused({write(scratch / "e", std::string("\0\1\2\3", 4))}), Contains("no format known"));
  CHECK_THAT(refused({write(scratch / "e", "hello\nworld\n")}), Contains("no head names the places"));
  CHECK_THAT(refused({write(scratch / "e.csv", "TIME:,0.5\n1,2,3\n")}), Contains("numbers stand here without a head"));
  CHECK_THAT(refused({write(scratch / "e.csv", "TIME:,0.5\nTIME:,0.6\n")}), Contains("no bead stands under the time 0.5"));
  CHECK_THAT(refused({write(scratch / "d", dump(c, 1, "id type x y vx vy vz"))}), Contains("no column holds z"));
  CHECK_THAT(refused({write(scratch / "l", "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ENTRIES\n2\n")}), Contains("dump local"));
  CHECK_THAT(refused({write(scratch / "s.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n")}),
             Contains("holds STRUCTURED_POINTS"));
  CHECK_THAT(refused({write(scratch / "p.vtp", "<VTKFile type=\"PPolyData\"></VTKFile>")}), Contains("one file"));
  CHECK_THAT(refused({write(scratch / "z.vtp", replaced(xml_vtk(c, Coding::raw, true, false), "ZLib", "LZ4"))}),
             Contains("vtkLZ4DataCompressor"));
  CHECK_THAT(refused({scratch / "not there"}), Contains("cannot be opened"));
  CHECK_THAT(refused({scratch.path}), Contains("is a folder"));
}

TEST_CASE("bytes in the wrong order are told as such") {
  const Scratch scratch;
  const Charge c = charge();
  CHECK_THAT(refused({write(scratch / "a.vtk", legacy_vtk(c, true, false, true))}), Contains("little-endian") && Contains("big-endian"));
  // The file says the other order than its bytes have; lengths are of no order where they fit.
  const std::string wrong = replaced(xml_vtk(c, Coding::raw, false, false), "LittleEndian", "BigEndian");
  CHECK_THAT(refused({write(scratch / "a.vtp", wrong)}), Contains("byte order"));
}

TEST_CASE("numbers, beads and times that cannot be") {
  const Scratch scratch;
  const Charge c = charge();
  const std::string whole = dump(c, 1);
  CHECK(not_imported(scratch, whole) == "");
  CHECK_THAT(not_imported(scratch, replaced(whole, "\n1 2 ", "\n2 2 ")), Contains("d.txt:11: bead 2 stands in this frame a second time"));
  CHECK_THAT(not_imported(scratch, replaced(whole, "\n2 1 ", "\n2.5 1 ")), Contains("d.txt:11: 2.5 is no number of a bead"));
  CHECK_THAT(not_imported(scratch, replaced(whole, " 0.004 ", " nan ")), Contains("d.txt:10: radius of bead 1 is nan"));
  CHECK_THAT(not_imported(scratch, replaced(whole, " 0.004 ", " -0.004 ")), Contains("d.txt:10: the radius is -0.004"));
  CHECK_THAT(not_imported(scratch, whole + dump(c, 2)), Contains("mill.yaml") && Contains("'time: {interval: 0.01 s}'"));
  const std::string timed = "beads: {density: 2500}\ntime: {step: 0.01 s}\n";
  CHECK_THAT(not_imported(scratch, dump(c, 2) + dump(c, 2), timed),
             Contains("d.txt:79: the time of this frame is 0.02 s, that of the one before 0.02 s"));
  CHECK_THAT(not_imported(scratch, dump(c, 1) + dump(c, 2, "id type x y z omegax omegay omegaz radius"), timed),
             Contains("says no velocity, others before it one"));
  CHECK_THAT(not_imported(scratch, whole, ""), Contains("how heavy the beads are"));
  CHECK_THAT(not_imported(scratch, dump(c, 1, "id type x y z vx vy vz")), Contains("how large the beads are"));
  CHECK_THAT(not_imported(scratch, whole, "beads: {density: 2500, diameter: 5 mm}\n"),
             Contains("mill.yaml:5") && Contains("says the radius of each bead"));
  CHECK_THAT(not_imported(scratch, whole, "beads: {density: {1: 2500}}\n"), Contains("says nothing of type 2"));
  CHECK_THAT(not_imported(scratch, dump(c, 1, "x y z vx vy vz radius") + dump(charge(61), 2, "x y z vx vy vz radius"), timed),
             Contains("60 to 61 beads that have no numbers"));
}

TEST_CASE("a mill that is not the one of the frames") {
  const Scratch scratch;
  Charge c = charge();
  const std::string whole = dump(c, 1), beads = "beads: {density: 2500}\n";
  Charge millimetres = c;
  for (auto& place : millimetres.place) {
    for (double& x : place) x *= 1e3;
  }
  for (double& r : millimetres.radius) r *= 1e3;
  const std::string in_mm = not_imported(scratch, dump(millimetres, 1));
  CHECK_THAT(in_mm, Contains("60 of 60 beads") && Contains("is the unit of the files mm? Write 'length_unit: mm'"));
  CHECK_THAT(not_imported(scratch, dump(millimetres, 1), beads + "length_unit: mm\n"),
             Contains("faster than the mill") || Contains("slip") || Catch::Equals(""));
  CHECK_THAT(not_imported(scratch, whole, beads + "length_unit: mm\n"), Contains("is the unit of the files m? Write 'length_unit: m'"));
  const std::string with = "speed: 2 rad/s, direction: ";
  CHECK_THAT(not_imported(scratch, whole, beads, with + "clockwise"),
             Contains("'direction' says clockwise, but the beads at the shell move counter-clockwise (at 2 rad/s"));
  CHECK_THAT(not_imported(scratch, whole, beads, "speed: 1 rad/s, direction: counter_clockwise"),
             Contains("turn at 2 rad/s, faster than the mill is stated to, 1 rad/s"));
  CHECK_THAT(not_imported(scratch, dump(c, 1, "id type x y z radius"), beads, "speed: 2 rad/s"),
             Contains("the sense of the mill is not stated and not to be found (the files hold no velocities)"));
  CHECK_THAT(not_imported(scratch, whole, beads, with + "counter_clockwise, centre: [30 mm, 0, 0]"),
             Contains("beyond the shell of 0.1 m radius") && Contains("check 'diameter', 'centre'"));
  Charge above = c;
  for (auto& place : above.place) place[1] = -place[1];
  for (auto& velocity : above.velocity) velocity[0] = -velocity[0];
  CHECK_THAT(not_imported(scratch, dump(above, 1), beads, with + "clockwise"), Contains("above the axis; check 'gravity'"));
  Charge outside = c;
  for (std::size_t i = 0; i < 3; ++i) outside.place[i][2] = 0.07;
  CHECK_THAT(not_imported(scratch, dump(outside, 1)),
             Contains("3 of 60 beads have their centres beyond the ends of the mill, up to 0.02 m"));
}

TEST_CASE("mill.yaml is read strictly") {
  const Scratch scratch;
  CHECK_THAT(refusal([&] { frames::import_frames(scratch / "beads.vtk.gz", scratch / "out", testing::registry(), {}); }),
             Contains("'files: beads.vtk.gz', axis, gravity, mill"));
  const std::string whole = dump(charge(), 1), beads = "beads: {density: 2500}\n";
  CHECK_THAT(not_imported(scratch, whole, beads + "colour: red\n"), Contains("mill.yaml:6") && Contains("colour"));
  CHECK_THAT(not_imported(scratch, whole, beads + "length_unit: kg\n"), Contains("no unit like m"));
  CHECK_THAT(not_imported(scratch, whole, beads + "time: {step: 1e-6 s, interval: 0.1 s}\n"), Contains("keep one"));
  CHECK_THAT(not_imported(scratch, whole, beads, "speed: 2 rad/s", "nothing_*.txt"), Contains("no file has such a name"));
  write(scratch / "long.yaml",
        "files: d.txt\naxis: z\ngravity: -y\nbeads: {density: 2500}\nmill: {diameter: 200 mm, ends: [-20, 20], speed: 2 rad/s, direction: "
        "counter_clockwise}\n");
  write(scratch / "d.txt", whole);
  CHECK_THAT(refusal([&] { frames::import_frames(scratch / "long.yaml", scratch / "out", testing::registry(), {}); }),
             Contains("of the 40 m between the ends") && Contains("say their unit"));
  write(scratch / "bad.yaml", "files: d.txt\naxis: z\ngravity: -z\nmill: {diameter: 200 mm, ends: [0 mm, 50 mm]}\n");
  CHECK_THAT(refusal([&] { frames::import_frames(scratch / "bad.yaml", scratch / "out", testing::registry(), {}); }),
             Contains("bad.yaml:3") && Contains("along the mill's axis"));
}
