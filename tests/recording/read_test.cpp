// The tracker's `.a` files, and lines that hold no point.
#include <catch2/catch.hpp>
#include <fstream>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;

namespace {

std::string ctrack_circle(int count) {
  std::string text = ctrack_head();
  for (int k = 0; k < count; ++k) text += ctrack_row(5.1 * k, 100 * std::cos(0.02 * k), 100 * std::sin(0.02 * k), 30, 3 + 0.1 * (k % 3));
  return text;
}

}  // namespace

TEST_CASE("an .a file gives seconds and metres, the spread and the events") {
  const Scratch scratch;
  const recording::Recording recording = recording::read_recording(scratch.file("tracer one.a", ctrack_circle(200)));
  REQUIRE(recording.runs.size() == 1);
  const recording::Run& run = recording.runs[0];
  CHECK(run.name == "tracer one");
  CHECK_THAT(run.format, Contains("ctrack") && Contains("t ms (column 1)") && Contains("x mm (column 2)"));
  REQUIRE(run.size() == 200);
  CHECK(run.time[3] == 15.3 / 1000);  // rounded once
  CHECK(run.position[0][0] == 0.1);
  CHECK(run.position[2][7] == 0.03);
  CHECK(run.spread[1] == 0.0031);
  CHECK(run.events[199] == 125);
  CHECK(run.report.rows == 200);
  CHECK(run.report.used == 200);
  CHECK(run.report.unreadable == 0);
}

TEST_CASE("an .a file without its nine lines is known by its columns") {
  const Scratch scratch;
  const recording::Recording recording =
      recording::read_recording(scratch.file("bare.dat", ctrack_circle(200).substr(ctrack_head().size())));
  CHECK_THAT(recording.runs[0].format, Contains("ctrack"));
  CHECK(recording.runs[0].size() == 200);
}

TEST_CASE("a cut last line is counted as unreadable") {
  const Scratch scratch;
  std::string text = ctrack_circle(200);
  SECTION("with too few columns") { text.resize(text.size() - 20); }
  SECTION("after the point of the last number but one") { text.resize(text.size() - 8); }
  const recording::Recording recording = recording::read_recording(scratch.file("cut.a", text));
  CHECK(recording.runs[0].report.rows == 200);
  CHECK(recording.runs[0].report.unreadable == 1);
  CHECK(recording.runs[0].size() == 199);
}

TEST_CASE("a table's last line that ends within a number is not taken for a point") {
  const Scratch scratch;
  std::string text = circle_rows(100);
  text.resize(text.size() - 3);  // 30.123 became 30.1
  CHECK(recording::read_recording(scratch.file("cut.txt", text)).runs[0].report.unreadable == 1);
  text = circle_rows(100);
  text.pop_back();  // complete, but without a line end
  const recording::Run whole = recording::read_recording(scratch.file("whole.txt", text)).runs[0];
  CHECK(whole.report.unreadable == 0);
  CHECK(whole.size() == 100);
}

TEST_CASE("lines that hold no point are set aside and counted, comments and empty lines are not rows") {
  const Scratch scratch;
  const std::string text = circle_rows(100, [](int k, std::string row) {
    if (k == 10) return std::string("50.0 abc 1 2");
    if (k == 20) return std::string("100.0 1 2");
    if (k == 30) return std::string("150.0 nan 1 2");
    if (k == 40) return std::string("200.0 1 inf 2");
    if (k == 50) return std::string("250.0 1 1e999 2");
    if (k == 60) return "# a remark 1 2 3\n\n   \n% another\n// and one\n" + row;
    return row;
  });
  const recording::RunReport report = recording::read_recording(scratch.file("lines.txt", text)).runs[0].report;
  CHECK(report.rows == 100);
  CHECK(report.unreadable == 2);
  CHECK(report.not_finite == 3);
  CHECK(report.used == 95);
}

TEST_CASE("line ends of other systems, tabs, plus signs and exponents do no harm") {
  const Scratch scratch;
  std::string text = "t\tx\ty\tz\r\n";
  for (int k = 0; k < 100; ++k) text += circle_row(k, "\t") + "\t \r\n";
  text += "500.0\t+1.0e2\t1E1\t.5\r\n";
  const recording::Run run = recording::read_recording(scratch.file("dos.tsv", text)).runs[0];
  CHECK(run.report.unreadable == 0);
  REQUIRE(run.report.rows == 101);
  CHECK(run.report.used + run.report.outliers == 101);
}

TEST_CASE("a gzipped file is read whatever its name, and a cut or damaged one is refused") {
  const Scratch scratch;
  const std::string text = ctrack_circle(500);
  const recording::Recording plain = recording::read_recording(scratch.file("plain.a", text));
  const auto file = scratch.packed("run7.a.gz", text);
  const recording::Recording packed = recording::read_recording(file);
  CHECK(packed.runs[0].name == "run7");
  CHECK(packed.runs[0].time == plain.runs[0].time);
  CHECK(packed.runs[0].position == plain.runs[0].position);
  CHECK(recording::read_recording(scratch.packed("noending", text)).runs[0].size() == 500);

  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  CHECK_THAT(refusal([&] { recording::read_recording(file); }), Contains("run7.a.gz") && Contains("cut short"));
  const auto damaged = scratch.file("damaged.gz", std::string("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10) + "this is no deflate stream at all");
  CHECK_THAT(refusal([&] { recording::read_recording(damaged); }), Contains("damaged.gz") && Contains("damaged"));
}

TEST_CASE("zeros behind a gzip file fill a block, a small file that unpacks to very much is refused") {
  const Scratch scratch;
  const auto file = scratch.packed("padded.gz", ctrack_circle(500));
  std::ofstream(file, std::ios::app | std::ios::binary) << std::string(3000, '\0');
  CHECK(recording::read_recording(file).runs[0].size() == 500);
  const auto bomb = scratch.packed("zeros.gz", std::string(120'000'000, ' '));
  CHECK_THAT(refusal([&] { recording::read_recording(bomb); }), Contains("zeros.gz") && Contains("unpacks to more than"));
}

TEST_CASE("a file without a usable point is refused with the reason") {
  const Scratch scratch;
  const auto why = [&](const std::string& text) {
    const auto file = scratch.file("x.txt", text);
    return refusal([&] { recording::read_recording(file); });
  };
  CHECK_THAT(why(""), Contains("x.txt") && Contains("no usable point"));
  CHECK_THAT(why("t x y z\nonly words here\n"), Contains("no usable point"));
  CHECK_THAT(why("1 nan nan nan\n2 nan nan nan\n"), Contains("x.txt:1:") && Contains("2 not finite"));
  CHECK_THAT(why("t x y z\n1 2 3 4\n2 a b c\n3 a b c\n"), Contains("x.txt:3:") && Contains("2 of 3 rows are unreadable"));
  CHECK_THAT(why("0.5;0;0;0\n2,5;2,5;3,5;4,5\n3,5;2,5;3,5;4,5\n"), Contains("x.txt:2:") && Contains("has decimal commas"));
  const std::string all = circle_rows(5);
  CHECK_THAT(why(all), Contains("5 usable points of 5 rows"));
  CHECK_THAT(refusal([&] { recording::read_recording(scratch / "absent.a"); }), Contains("absent.a") && Contains("cannot be opened"));
  CHECK_THAT(refusal([&] { recording::read_recording(scratch.path); }), Contains("is a folder"));
}
