// Files that look right and are not, or are right and look odd: lists, names, times, units, beads that come and go.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "frames/support.hpp"
#include "kernel/base/text.hpp"
#include "kernel/output/frame_reader.hpp"
#include "plugins.hpp"
#include "studies/frames/columns.hpp"
#include "studies/frames/file_names.hpp"
#include "studies/frames/import.hpp"

using namespace frames_test;
using namespace millscope;
using Catch::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using frames::Frame;

namespace {

constexpr const char* kPlacesOnly = "id type x y z radius";
constexpr const char* kWhole = "id type x y z vx vy vz omegax omegay omegaz radius";
const std::string kDensity = "beads: {density: 2500}\n", kSteps = kDensity + "time: {step: 0.001 s}\n";

std::string refused_files(const std::vector<fs::path>& files, double length = 1) {
  const std::string said = refusal([&] { frames_of(files, length); });
  CHECK(said.find('\n') == std::string::npos);
  return said;
}

frames::Imported import_of(const Scratch& scratch, const std::string& mill_text) {
  fs::remove_all(scratch / "out");
  write(scratch / "mill.yaml", mill_text);
  return frames::import_frames(scratch / "mill.yaml", scratch / "out", testing::registry(), {"millscope", "import"});
}

std::string refused_import(const Scratch& scratch, const std::string& mill_text) {
  return refusal([&] { import_of(scratch, mill_text); });
}

std::string note_with(const frames::Imported& done, const std::string& words) {
  for (const std::string& note : done.notes) {
    if (note.find(words) != std::string::npos) return note;
  }
  return "";
}

/// Without the beads that `keep` does not want.
Charge some(const Charge& c, const std::function<bool(long long)>& keep) {
  Charge out;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!keep(c.id[i])) continue;
    out.id.push_back(c.id[i]), out.type.push_back(c.type[i]), out.radius.push_back(c.radius[i]);
    out.place.push_back(c.place[i]), out.velocity.push_back(c.velocity[i]), out.spin.push_back(c.spin[i]);
  }
  return out;
}

/// Dumps of a charge that turns as one at 2 rad/s; frame f stands at `times[f]` ms, with the beads that `keep` wants there.
std::string turned(
    const std::vector<int>& times, const std::string& columns,
    const std::function<bool(long long, int)>& keep = [](long long, int) { return true; }) {
  std::string text;
  for (const int t : times) text += dump(some(charge(60, 2, 0.002 * t), [&](long long id) { return keep(id, t); }), t, columns);
  return text;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
  return text;
}

std::string pvd(const std::vector<std::string>& files) {
  std::string text = "<VTKFile type=\"Collection\"><Collection>\n";
  for (std::size_t i = 0; i < files.size(); ++i) text += fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", i, files[i]);
  return text + "</Collection></VTKFile>";
}

std::vector<std::string> ordered(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const fs::path& file : frames::in_order({names.begin(), names.end()})) out.push_back(file.string());
  return out;
}

}  // namespace

TEST_CASE("a list of files names files of beads, in its own folder") {
  const Scratch scratch;
  write(scratch / "self.pvd", pvd({"self.pvd"}));
  CHECK_THAT(refused_files({scratch / "self.pvd"}), Contains("lists 'self.pvd', which is a list itself"));
  for (const char* name : {"../a.vtp", "/etc/passwd", "sub/../../a.vtp"})
    CHECK_THAT(refused_files({write(scratch / "l.pvd", pvd({name}))}), Contains("which is not in its folder"));
}

TEST_CASE("packed lengths that are too large to be true") {
  const Scratch scratch;
  const auto packed = [&](std::vector<std::uint64_t> lengths) {
    std::string bytes;
    for (std::uint64_t length : lengths) {
      for (int b = 0; b < 8; ++b, length >>= 8U) bytes += static_cast<char>(length & 255U);
    }
    return refused_files({write(
        scratch / "a.vtp",
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"><PolyData>"
        "<Piece NumberOfPoints=\"700\"><Points><DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" "
        "offset=\"0\"/></Points></Piece></PolyData><AppendedData encoding=\"raw\">_" +
            bytes + "xxxxxxxxxxxxxxxxxxxxxxxx")});
  };
  // 2 · (2^63 + 4200) + 8400 is 16 800 in 64 bits, the bytes that are expected.
  CHECK_THAT(packed({3, 9223372036854775808ULL + 4200, 8400, 9, 9, 9}), Contains("3 blocks of 9223372036854780008 bytes"));
  CHECK_THAT(packed({1, 8, 16800, 9}), Contains("the last of 16800"));
  CHECK_THAT(packed({18446744073709551615ULL, 8, 0, 9}), Contains("18446744073709551615 blocks"));
  CHECK_THAT(packed({1, 16800, 0, 3}), Contains("16800 bytes are packed into 3"));
  const std::string huge =
      with(xml_vtk(charge(), Coding::raw, true, false), "NumberOfPoints=\"60\"", "NumberOfPoints=\"1537228672809129302\"");
  CHECK_THAT(refused_files({write(scratch / "h.vtp", huge)}), Contains("more than any file holds"));
}

TEST_CASE("a table that holds no bead at one time goes on behind it") {
  const Scratch scratch;
  const Charge c = charge(), later = charge(60, 2, 0.2), none;
  const auto counts = [&](const std::string& text) {
    std::vector<std::size_t> all;
    for (const Frame& frame : frames_of({write(scratch / "t.csv", text)})) all.push_back(frame.count);
    return all;
  };
  using Counts = std::vector<std::size_t>;
  CHECK(counts(table(c, "0.5") + table(none, "0.6") + table(later, "0.7")) == Counts{60, 0, 60});
  CHECK(counts(table(c, "0.5") + "TIME:,0.6\n" + table(later, "0.7")) == Counts{60, 0, 60});
  CHECK(counts(table(none, "0.5") + table(c, "0.6") + table(none, "0.7")) == Counts{0, 60, 0});
  CHECK(counts(queries(c, 0.5, false) + queries(none, 0.6, false) + queries(later, 0.7, false)) == Counts{60, 0, 60});
  CHECK_THAT(refused_files({write(scratch / "t.csv", table(c, "0.5") + "TIME:,0.6\n")}), Contains("no bead stands under the time 0.6"));
  // A head before the times.
  const std::string one = table(c, "0.5"), head = one.substr(one.find('\n') + 1, one.find('\n', 12) - one.find('\n'));
  CHECK(counts(head + "TIME:,0.5\n1,1,0,0,0,0,0,0,0,0,0,5,0\n") == Counts{1});
  write(scratch / "t.csv", table(c, "0.5") + table(none, "0.6") + table(later, "0.6"));
  const frames::Imported done = import_of(scratch, mill("t.csv", kDensity));
  CHECK(done.frames == 2);
  CHECK(note_with(done, "1 of 3 frames hold no bead") != "");
}

TEST_CASE("times of a table: their name, and their unit") {
  const Scratch scratch;
  const Charge c = charge();
  const auto time_of = [&](const std::string& before) { return frames_of({write(scratch / "t.csv", before + table(c))}).at(0).time; };
  CHECK(time_of("Time (ms),500\n") == 0.5);
  CHECK(time_of("Time: 500 ms\n") == 0.5);
  CHECK(time_of("Simulation Time,0.5,s\n") == 0.5);
  CHECK(time_of("Time: 0.5 s\n") == 0.5);
  CHECK_FALSE(time_of("Time Step:,1e-06\n"));
  CHECK_FALSE(time_of("Timestep: 12000\n"));
  CHECK_FALSE(time_of("Time: 12:30 Monday\n"));
  CHECK_THAT(refused_files({write(scratch / "t.csv", "Time (mm),5\n" + table(c))}),
             Contains("t.csv:1") && Contains("'mm' is no unit like s"));
}

TEST_CASE("a blank cell at the end of a row") {
  const Scratch scratch;
  const std::string head = "id,x,y,z,radius,comment\n";
  const std::vector<Frame> all = frames_of({write(scratch / "t.csv", head + "1,1,2,3,0.1,\n2,4,5,6,0.1,seen\n")});
  REQUIRE(all.size() == 1);
  CHECK(all[0].count == 2);
  CHECK_THAT(refused_files({write(scratch / "t.csv", head + "1,1,2,3,0.1\n")}), Contains("t.csv:2: holds 5 cells, its head 6"));
}

TEST_CASE("types in words are the same in all files") {
  const Scratch scratch;
  const auto steel_first = [](const Charge& c, bool first) {
    std::string text = "Particle ID,Particle Type,x,y,z,radius\n";
    for (std::size_t i = 0; i < c.size(); ++i) {
      const std::size_t k = first ? i : c.size() - 1 - i;
      text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{}\n", c.id[k], c.type[k] == 2 ? "steel" : "glass", c.place[k][0], c.place[k][1],
                          c.place[k][2], c.radius[k]);
    }
    return text;
  };
  write(scratch / "w_1.csv", steel_first(some(charge(), [](long long id) { return id > 30; }), true));
  write(scratch / "w_2.csv", steel_first(charge(60, 2, 0.002), false));
  const frames::Imported done =
      import_of(scratch, mill("w_*.csv", "beads: {density: {steel: 7800, glass: 2500}}\ntime: {interval: 1 ms}\n"));
  CHECK(note_with(done, "type 'steel' is type_1") != "");
  const output::FrameReader reader(scratch / "out/frames.h5");
  for (std::size_t b = 0; b < reader.beads().size(); ++b) {
    const double radius = reader.beads().radius[b], volume = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
    REQUIRE_THAT(reader.beads().mass[b] / volume, WithinRel(b % 3 == 0 ? 7800 : 2500, 1e-5));
  }
  CHECK_THAT(refused_import(scratch, mill("w_*.csv", "beads: {density: {glass: 2500}}\ntime: {interval: 1 ms}\n")),
             Contains("says nothing of type steel"));
  CHECK_THAT(refused_import(scratch, mill("w_*.csv", "beads: {density: {1: 7800, 2: 2500}}\ntime: {interval: 1 ms}\n")),
             Contains("says nothing of type steel"));
}

TEST_CASE("names of files in their order") {
  using Names = std::vector<std::string>;
  CHECK(ordered({"v_1.10.csv", "v_1.11.csv", "v_1.9.csv"}) == Names{"v_1.9.csv", "v_1.10.csv", "v_1.11.csv"});
  CHECK(ordered({"at_1e-3.csv", "at_5e-4.csv", "at_2e-3.csv"}) == Names{"at_5e-4.csv", "at_1e-3.csv", "at_2e-3.csv"});
  CHECK(ordered({"p2_d10.gz", "p2_d9.gz", "p1_d11.gz"}) == Names{"p1_d11.gz", "p2_d9.gz", "p2_d10.gz"});
  CHECK(ordered({"dump.100", "dump.20"}) == Names{"dump.20", "dump.100"});
  CHECK(ordered({"b.csv", "a_1.csv"}) == Names{"b.csv", "a_1.csv"});
  CHECK_THAT(refusal([] { ordered({"at_1.5.csv", "at_1.25.csv"}); }), Contains("write equally many digits behind it"));
}

TEST_CASE("a bead without a neighbour in time has no velocity by differences") {
  const Scratch scratch;
  // Bead 7 is there at 3 ms alone.
  write(scratch / "d.txt", turned({0, 1, 2, 3, 4, 5, 6}, kPlacesOnly, [](long long id, int t) { return id != 7 || t == 3; }));
  const frames::Imported done = import_of(scratch, mill("d.txt", kSteps));
  CHECK(note_with(done, "1 times a bead is in one frame") != "");
  const output::FrameReader reader(scratch / "out/frames.h5");
  REQUIRE(reader.scalars().mass_there.size() == 7);
  CHECK_THAT(reader.scalars().mass_there[3], WithinRel(reader.scalars().mass_there[2], 1e-9));
  CHECK(base::text_of(scratch / "out/series.csv").find("nan") == std::string::npos);
}

TEST_CASE("velocities are held against places and times") {
  const Scratch scratch;
  write(scratch / "d.txt", turned({0, 1, 2, 3, 4}, kWhole));
  CHECK(refused_import(scratch, mill("d.txt", kSteps)) == "");
  CHECK_THAT(refused_import(scratch, mill("d.txt", kDensity + "time: {step: 0.01 s}\n")),
             Contains("beads go 0.1 times as far as their velocities say") && Contains("'time' and 'velocity_unit'"));
  // TimeValue is the number of the picture; 'time' of mill.yaml goes before it.
  for (int f = 0; f < 4; ++f)
    write(scratch / fmt::format("s{}.vtp", f),
          xml_vtk(charge(60, 2, 0.002 * f), Coding::raw, false, false, true, false, std::to_string(f)));
  CHECK_THAT(refused_import(scratch, mill("s*.vtp", kDensity)), Contains("0.001 times as far"));
  const frames::Imported done = import_of(scratch, mill("s*.vtp", kDensity + "time: {interval: 1 ms}\n"));
  CHECK_THAT(done.until, WithinAbs(0.003, 1e-12));
  CHECK(note_with(done, "'time' of mill.yaml goes before them") != "");
  // ParaView's rows: their numbers are not those of the beads, and their order changes.
  for (int f = 0; f < 4; ++f) {
    std::string text = "\"Point ID\",\"Points:0\",\"Points:1\",\"Points:2\",\"v:0\",\"v:1\",\"v:2\",\"radius\"\n";
    const Charge c = charge(60, 2, 0.002 * f);
    for (std::size_t i = 0; i < c.size(); ++i) {
      const std::size_t k = (i * 7 + 13 * static_cast<std::size_t>(f) * (i + 1)) % 60;
      text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},0.005\n", i, c.place[k][0], c.place[k][1], c.place[k][2],
                          c.velocity[k][0], c.velocity[k][1], c.velocity[k][2]);
    }
    write(scratch / fmt::format("pid_{}.csv", f), text);
  }
  CHECK_THAT(refused_import(scratch, mill("pid_*.csv", kDensity + "time: {interval: 1 ms}\n")), Contains("write the id of the beads"));
  CHECK_FALSE(frames::column_of("Point ID", {}).quantity);
}

TEST_CASE("no tracks lead over a pause, and the reason is told") {
  const Scratch scratch;
  const auto reason = [&](const std::string& text, const std::string& more) {
    write(scratch / "d.txt", text);
    const frames::Imported done = import_of(scratch, mill("d.txt", more));
    CHECK(done.tracks == 0);
    CHECK_FALSE(fs::exists(scratch / "out/tracks.h5"));
    return note_with(done, "no virtual camera");
  };
  CHECK_THAT(reason(turned({0, 1, 2, 3, 40, 41, 42}, kWhole), kSteps), Contains("its frames pause for 37 ms"));
  CHECK_THAT(reason(turned({0, 1, 2}, kWhole), kSteps), Contains("it has 3 frames, and a track needs 4"));
  CHECK_THAT(reason(turned({0, 1, 2, 3, 4}, kWhole, [](long long id, int t) { return id % 5 != t; }), kSteps),
             Contains("no bead is in all of its frames"));
}

TEST_CASE("speed and direction are checked by differences of places too") {
  const Scratch scratch;
  write(scratch / "d.txt", turned({0, 1, 2, 3}, kPlacesOnly));
  CHECK_THAT(refused_import(scratch, mill("d.txt", kSteps, "speed: 2 rad/s, direction: clockwise")),
             Contains("the beads at the shell move counter-clockwise"));
  CHECK_THAT(refused_import(scratch, mill("d.txt", kSteps, "speed: 1 rad/s")), Contains("faster than the mill is stated to"));
  CHECK(note_with(import_of(scratch, mill("d.txt", kSteps, "start_s: 0 s")), "2 rad/s is taken, the median of") != "");
}

TEST_CASE("the unit of the spin") {
  const Scratch scratch;
  const std::string plain = with(table(charge(), "0.5"), " (rad/s)", "");
  write(scratch / "t.csv", plain);
  CHECK(note_with(import_of(scratch, mill("t.csv", kDensity)), "names no unit of the spin") != "");
  const auto spin = [&](const std::string& more) {
    const frames::Imported done = import_of(scratch, mill("t.csv", kDensity + more));
    CHECK(note_with(done, "names no unit of the spin") == "");
    const output::FrameReader reader(scratch / "out/frames.h5");
    std::vector<float> values(3 * reader.beads().size());
    reader.read(output::BeadField::spin, 0, 1, values);
    return double{values[2]};
  };
  CHECK_THAT(spin("spin_unit: deg/s\n"), WithinRel(2 * M_PI / 180, 1e-6));
  CHECK_THAT(spin("spin_unit: rpm\n"), WithinRel(2 * M_PI / 30, 1e-6));
  CHECK_THAT(refused_import(scratch, mill("t.csv", kDensity + "spin_unit: m\n")), Contains("write e.g. rad/s, deg/s or rpm"));
  write(scratch / "t.csv", table(charge(), "0.5"));
  CHECK_THAT(spin("spin_unit: deg/s\n"), WithinRel(2, 1e-6));  // the column names its own
}

TEST_CASE("units of a dump, and a frame that lost its atoms") {
  const Scratch scratch;
  const std::string whole = dump(charge(), 7);
  CHECK_THAT(refused_files({write(scratch / "d", "ITEM: UNITS\nlj\n" + whole)}), Contains("d:2: the units are 'lj'"));
  CHECK_THAT(refused_files({write(scratch / "d", "ITEM: UNITS\ncgs\n" + whole)}), Contains("add 'length_unit: cm'"));
  CHECK(refused_files({write(scratch / "d", "ITEM: UNITS\ncgs\n" + whole)}, 0.01) == "");
  CHECK_THAT(refused_files({write(scratch / "d", "ITEM: TIMESTEP\n6\nITEM: NUMBER OF ATOMS\n60\n" + whole)}),
             Contains("d:5: a second TIMESTEP stands here, and the atoms of step 6 do not"));
}

TEST_CASE("masses that change are told") {
  const Scratch scratch;
  const auto frame = [](double angle, long long step, double radius, double mass) {
    std::string text = dump(charge(60, 2, angle), step, "id x y z");
    text = with(with(text, "ATOMS id x y z ", "ATOMS id x y z radius mass"), " \n", fmt::format(" {} {}\n", radius, mass));
    return text;
  };
  // Two thirds of the radius, and the same density: 8/27 of the mass.
  const double mass = 2500 * 4.0 / 3.0 * M_PI * 27e-9;
  write(scratch / "d.txt", frame(0, 1, 0.003, mass) + frame(0.002, 2, 0.002, mass * 8 / 27));
  const frames::Imported done = import_of(scratch, mill("d.txt", "time: {step: 0.001 s}\n"));
  CHECK(note_with(done, "the radius of a bead changes 60 times") != "");
  CHECK(note_with(done, "the mass of a bead changes 60 times") != "");
  const output::FrameReader reader(scratch / "out/frames.h5");
  CHECK_THAT(reader.beads().mass[5], WithinRel(mass * 8 / 27, 1e-5));
  // The mass alone.
  write(scratch / "d.txt", frame(0, 1, 0.003, mass) + frame(0.002, 2, 0.003, 2 * mass));
  CHECK(note_with(import_of(scratch, mill("d.txt", "time: {step: 0.001 s}\n")), "the mass of a bead changes 60 times") != "");
  const output::FrameReader heavier(scratch / "out/frames.h5");
  CHECK_THAT(heavier.beads().mass[5], WithinRel(2 * mass, 1e-5));
}

TEST_CASE("arrays of cells are named where they are passed over") {
  const Scratch scratch;
  const std::string xml = with(xml_vtk(charge(), Coding::ascii, false, false), "</Points>",
                               "</Points><CellData><DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">1</DataArray></CellData>");
  const std::string legacy = legacy_vtk(charge(), false, false) + "CELL_DATA 2\nSCALARS v float 1\nLOOKUP_TABLE default\n1 2\n";
  for (const std::string& file : {write(scratch / "a.vtp", xml), write(scratch / "b.vtk", legacy)}) {
    const Frame frame = frames_of({file}).at(0);
    CHECK(std::find(frame.passed_over.begin(), frame.passed_over.end(), "v (of cells)") != frame.passed_over.end());
  }
}
