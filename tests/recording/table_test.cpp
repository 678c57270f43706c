// Columns and separators of tables.
#include <catch2/catch.hpp>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

namespace {

/// Columns named by letters: t in ms, T in s, x, y, z in mm, X, Y, Z in m, e in mm, a label, v a velocity.
std::string table(const std::string& columns, const char* separator, int count = 200) {
  std::string text;
  for (int k = 0; k < count; ++k) {
    const double x = 100 * std::cos(0.02 * k), y = 100 * std::sin(0.02 * k), z = 30 + 0.01 * k;
    std::string row;
    for (const char c : columns) {
      row += row.empty() ? "" : separator;
      switch (c) {
        case 't':
          row += std::to_string(5 * k);
          break;
        case 'T':
          row += std::to_string(0.005 * k);
          break;
        case 'x':
          row += std::to_string(x);
          break;
        case 'y':
          row += std::to_string(y);
          break;
        case 'z':
          row += std::to_string(z);
          break;
        case 'X':
          row += std::to_string(x / 1000);
          break;
        case 'Y':
          row += std::to_string(y / 1000);
          break;
        case 'Z':
          row += std::to_string(z / 1000);
          break;
        case 'e':
          row += std::to_string(0.5 + 0.001 * k);
          break;
        case 'l':
          row += "tracer";
          break;
        default:
          row += "0.7";
          break;
      }
    }
    text += row + "\n";
  }
  return text;
}

void check_circle(const recording::Run& run, double tolerance = 1e-8) {
  REQUIRE(run.size() == 200);
  CHECK(run.time[100] == Approx(0.5));
  CHECK(run.position[0][100] == Approx(0.1 * std::cos(2.0)).margin(tolerance));
  CHECK(run.position[1][100] == Approx(0.1 * std::sin(2.0)).margin(tolerance));
  CHECK(run.position[2][100] == Approx(0.031).margin(tolerance));
}

}  // namespace

TEST_CASE("bare tables are known by the heads above their columns") {
  const Scratch scratch;
  const auto read = [&](const std::string& text) { return recording::read_recording(scratch.file("bare.csv", text)).runs[0]; };
  SECTION("in a comment, blanks above commas") {
    const recording::Run run = read("# t x y z error\n" + table("txyze", ","));
    check_circle(run);
    CHECK(run.spread[100] == Approx(0.6e-3));
    CHECK_THAT(run.format, Contains("comma") && Contains("error mm (column 5)"));
  }
  SECTION("error first") {
    const recording::Run run = read("t,e,x,y,z\n" + table("texyz", ","));
    check_circle(run);
    CHECK(run.spread[100] == Approx(0.6e-3));
  }
  SECTION("with units, in any order, with other columns") {
    const recording::Run run = read("label;z_m;y (m);x [m];v;time/s\n" + table("lZYXvT", ";"));
    check_circle(run, 1e-6);
    CHECK(run.spread.empty());
    CHECK_THAT(run.format, Contains("semicolon") && Contains("t s (column 6)") && Contains("x m (column 4)"));
  }
  SECTION("quoted") { check_circle(read("\"t\",\"x\",\"y\",\"z\"\n" + table("txyz", ","))); }
  SECTION("below a title and a line of remarks") {
    check_circle(read("Recording of Tuesday 3\nthe tracer was glued\nt\tx\ty\tz\n" + table("txyz", "\t")));
  }
}

TEST_CASE("heads in other words and with a byte-order mark are understood") {
  const Scratch scratch;
  const auto read = [&](const std::string& text) { return recording::read_recording(scratch.file("bare.csv", text)).runs[0]; };
  SECTION("capitals and synonyms") { check_circle(read("TimeStamp,Residual,X,Y,Z\n" + table("texyz", ","))); }
  SECTION("with words and units") {
    const recording::Run run = read("Label,Time Stamp [s],X Position (m),pos_y_m,z-pos / m\n" + table("lTXYZ", ","));
    check_circle(run, 1e-6);
    CHECK(run.spread.empty());
  }
  SECTION("a mark of UTF-8 before the heads") {
    const recording::Run run = read("\xEF\xBB\xBFt,error,x,y,z\n" + table("texyz", ","));
    check_circle(run);
    CHECK(run.spread[100] == Approx(0.6e-3));
  }
  SECTION("a mark of UTF-8 before the first row") { check_circle(read("\xEF\xBB\xBF" + table("txyz", ","))); }
  SECTION("units apart by blanks") { check_circle(read("e (mm) t (s) x (m) y (m) z (m)\n" + table("eTXYZ", " ")), 1e-6); }
  SECTION("a line of units below the heads") { check_circle(read("e t x y z\nmm s m m m\n" + table("eTXYZ", " ")), 1e-6); }
  SECTION("a column without a head") { check_circle(read(",t,x,y,z\n" + table("ltxyz", ","))); }
}

TEST_CASE("heads that do not say where t, x, y and z are are refused, never passed over") {
  const Scratch scratch;
  const auto why = [&](const std::string& text) {
    const auto file = scratch.file("bare.csv", text);
    return refusal([&] { recording::read_recording(file); });
  };
  CHECK_THAT(why("clock,quality,East,North,Up\n" + table("texyz", ",")),
             Contains("bare.csv:1:") && Contains("'clock', 'quality', 'East', 'North', 'Up'") && Contains("recording.yaml"));
  CHECK_THAT(why("# of Tuesday\nt,x,y,depth\n" + table("txyz", ",")), Contains("bare.csv:2:") && Contains("'depth'"));
  CHECK_THAT(why("t,x,y,z,x\n" + table("txyzx", ",")), Contains("bare.csv:1:") && Contains("once each"));
  CHECK_THAT(why("t x y z\n" + table("ttxyz", " ")), Contains("bare.csv:1:") && Contains("the first row has 5 columns"));  // row names
}

TEST_CASE("four or five columns without heads are t, x, y, z, error in ms and mm. With more the user has to say") {
  const Scratch scratch;
  check_circle(recording::read_recording(scratch.file("four.txt", table("txyz", " "))).runs[0]);
  const recording::Run five = recording::read_recording(scratch.file("five.txt", table("txyze", "  "))).runs[0];
  check_circle(five);
  CHECK(five.spread[100] == Approx(0.6e-3));
  const auto six = scratch.file("six.txt", table("txyzev", " "));
  CHECK_THAT(refusal([&] { recording::read_recording(six); }),
             Contains("six.txt:1:") && Contains("has 6 columns") && Contains("recording.yaml"));
}

TEST_CASE("columns are named in their order, skipped, numbered or named by their heads") {
  const Scratch scratch;
  const auto read = [&](const std::string& columns) {
    return recording::read_recording(scratch.file("r.yaml", "files: data.csv\ncolumns: " + columns + "\n")).runs[0];
  };
  scratch.file("data.csv", "stamp,label,px,py,pz\n" + table("TlXyz", ","));
  SECTION("in order") { check_circle(read("{t: s, label: skip, x: m, y: mm, z: mm}"), 1e-6); }
  SECTION("by number") {
    check_circle(read("{x: {column: 3, unit: m}, y: {column: 4, unit: mm}, z: {column: 5, unit: mm}, t: {column: 1, unit: s}}"), 1e-6);
  }
  SECTION("by head") {
    check_circle(read("{t: {column: stamp, unit: s}, x: {column: px, unit: m}, y: {column: py, unit: mm}, z: {column: pz, unit: mm}}"),
                 1e-6);
  }
  SECTION("by a head that is not there") {
    const std::string why = refusal(
        [&] { read("{t: {column: time, unit: s}, x: {column: px, unit: m}, y: {column: py, unit: mm}, z: {column: pz, unit: mm}}"); });
    CHECK_THAT(why, Contains("r.yaml:2:") && Contains("'time'") && Contains("'stamp'"));
  }
}

TEST_CASE("one wrong separator or too few columns is named with its line") {
  const Scratch scratch;
  scratch.file("data.csv", "t,x,y,z\n" + table("txyz", ","));
  const auto yaml = scratch.file("r.yaml", "files: data.csv\nseparator: semicolon\ncolumns: {t: ms, x: mm, y: mm, z: mm}\n");
  CHECK_THAT(refusal([&] { recording::read_recording(yaml); }), Contains("data.csv:2:") && Contains("200 of 200 rows are unreadable"));
  const auto more = scratch.file("m.yaml", "files: data.csv\ncolumns: {t: ms, x: mm, y: mm, z: mm, error: mm}\n");
  CHECK_THAT(refusal([&] { recording::read_recording(more); }), Contains("data.csv:2:") && Contains("too few columns"));
}

TEST_CASE("lines at the top can be skipped although they look like rows") {
  const Scratch scratch;
  scratch.file("data.txt", "1 2 3 4\n5 6 7 8\n" + table("txyz", " "));
  const recording::Run run =
      recording::read_recording(scratch.file("r.yaml", "files: data.txt\nskip_lines: 2\ncolumns: {t: ms, x: mm, y: mm, z: mm}\n")).runs[0];
  check_circle(run);
  CHECK(run.report.rows == 200);
}
