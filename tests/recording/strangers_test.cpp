// What trackers and spreadsheets of other people write: read as it is meant, or refused; never taken for something else.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "recording/support.hpp"
#include "tests/skip.hpp"

using namespace millscope;
using namespace recording_test;
using Catch::Contains;
using recording::read_recording;
using recording::Recording;

namespace {

struct Row {
  double t, x, y, z;  // ms, mm
};

/// A bead on a circle of 120 mm that turns with 2 rad/s, and drifts along z.
Row circle(double t) { return {t, 120 * std::cos(2e-3 * t), 120 * std::sin(2e-3 * t), 30 + 1e-3 * t}; }
Row small_circle(double t) { return {t, -60 * std::cos(2e-3 * t), -60 * std::sin(2e-3 * t), 40 - 1e-3 * t}; }

std::string text_of(const Row& r, const char* separator = " ") {
  char line[120];
  std::snprintf(line, sizeof line, "%.4f%s%.4f%s%.4f%s%.4f", r.t, separator, r.x, separator, r.y, separator, r.z);
  return line;
}

std::string rows_of(const std::vector<Row>& rows) {
  std::string text = "t x y z\n";
  for (const Row& r : rows) text += text_of(r) + "\n";
  return text;
}

std::vector<Row> circle_of(int count, double step = 2) {
  std::vector<Row> rows;
  for (int k = 0; k < count; ++k) rows.push_back(circle(step * k));
  return rows;
}

std::string utf16(const std::string& text, bool big, bool mark) {
  std::string out = !mark ? "" : big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

void same(const Recording& a, const Recording& b) {
  REQUIRE(a.runs.size() == 1);
  REQUIRE(b.runs.size() == 1);
  CHECK(a.runs[0].time == b.runs[0].time);
  CHECK(a.runs[0].position == b.runs[0].position);
}

}  // namespace

TEST_CASE("decimal commas and Fortran's exponents are the numbers that they mean") {
  const Scratch scratch;
  const std::string plain = rows_of(circle_of(200));
  const Recording wanted = read_recording(scratch.file("plain.txt", plain));
  std::string commas = plain;
  std::replace(commas.begin(), commas.end(), '.', ',');
  same(read_recording(scratch.file("blanks.txt", commas)), wanted);
  std::string semicolons = commas;
  std::replace(semicolons.begin(), semicolons.end(), ' ', ';');
  same(read_recording(scratch.file("semicolons.csv", semicolons)), wanted);
  std::string tabs = commas;
  std::replace(tabs.begin(), tabs.end(), ' ', '\t');
  same(read_recording(scratch.file("tabs.tsv", tabs)), wanted);
  CHECK_THAT(read_recording(scratch / "tabs.tsv").runs[0].format, Contains("decimal commas"));
  std::string fortran = "t x y z\n", quadruple = fortran;
  for (const Row& r : circle_of(200)) {
    char line[160];
    std::snprintf(line, sizeof line, "%.10E %.10E %.10E %.10E\n", r.t, r.x, r.y, r.z);
    for (const char c : std::string(line)) fortran += c == 'E' ? 'D' : c, quadruple += c == 'E' ? 'q' : c;
  }
  const Recording doubles = read_recording(scratch.file("fortran.txt", fortran));
  CHECK(doubles.runs[0].position[0][100] == Approx(circle(200).x / 1e3).epsilon(1e-9));
  same(read_recording(scratch.file("quadruple.txt", quadruple)), doubles);
}

TEST_CASE("commas among points are no decimal commas") {
  const Scratch scratch;
  std::string text = "t;x;y;z\n";
  for (int k = 0; k < 100; ++k) text += std::to_string(k) + ".5;1,250;2.5;3.5\n";  // 1250, or 1.25?
  CHECK_THAT(refusal([&] { read_recording(scratch.file("x.csv", text)); }), Contains("x.csv:2:") && Contains("has decimal commas"));
  const Recording integers =
      read_recording(scratch.file("i.csv", "t,x,y,z\n0,1,2,3\n5,2,2,3\n10,3,2,3\n15,4,3,3\n20,5,3,3\n25,6,3,3\n30,7,4,3\n"));
  CHECK(integers.runs[0].time[1] == 0.005);
}

TEST_CASE("UTF-16 of either order is read, with its mark or without") {
  const Scratch scratch;
  const std::string plain = rows_of(circle_of(200));
  const Recording wanted = read_recording(scratch.file("plain.txt", plain));
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) same(read_recording(scratch.file("wide.txt", utf16(plain, big, mark))), wanted);
  }
}

TEST_CASE("a label with several values is several tracers") {
  const Scratch scratch;
  std::string text = "t,x,y,z,label\n", noise = "1.000", first = "0.000";
  for (int k = 0; k < 500; ++k) {
    text += text_of(circle(2 * k), ",") + "," + first + "\n" + text_of(small_circle(2 * k), ",") + "," + noise + "\n";
    if (k % 50 == 0) text += text_of({2.0 * k, 5, 5.0 + k, 6}, ",") + ",-1.000\n";
  }
  const auto file = scratch.file("two.csv", text);
  const Recording both = read_recording(file);
  REQUIRE(both.runs.size() == 2);
  CHECK(both.runs[0].name == "two_0");
  CHECK(both.runs[1].name == "two_1");
  CHECK(both.runs[0].size() == 500);
  CHECK(both.runs[0].report.lost == 10);  // -1: no bead's
  CHECK(both.runs[0].report.duplicates == 0);
  for (std::size_t i = 0; i < 500; ++i) REQUIRE(std::hypot(both.runs[1].position[0][i], both.runs[1].position[1][i]) == Approx(0.06));
  const Recording one = read_recording(scratch.file("one.yaml", "files: two.csv\nlabels: [1]\n"));
  REQUIRE(one.runs.size() == 1);
  CHECK(one.runs[0].size() == 500);
  CHECK(one.runs[0].report.lost == 510);
  CHECK_THAT(refusal([&] { read_recording(scratch.file("none.yaml", "files: two.csv\nlabels: [2]\n")); }),
             Contains("none.yaml:2:") && Contains("'2'") && Contains("there are 0, 1, -1"));
  const Recording placed =
      read_recording(scratch.file("placed.yaml", "files: two.csv\ncolumns: {t: ms, x: mm, y: mm, z: mm, label: tracer}\nlabels: [0]\n"));
  CHECK(placed.runs.size() == 1);
}

TEST_CASE("names are labels too, and a label that numbers rows is none") {
  const Scratch scratch;
  std::string text = "# t x y z Tracer\n", numbered = "t x y z label\n";
  for (int k = 0; k < 300; ++k) {
    text += text_of(circle(2 * k)) + " red\n" + text_of(small_circle(2 * k)) + " blue\n";
    numbered += text_of(circle(2 * k)) + " " + std::to_string(k) + "\n";
  }
  const Recording two = read_recording(scratch.file("named.txt", text));
  REQUIRE(two.runs.size() == 2);
  CHECK(two.runs[1].name == "named_blue");
  CHECK(read_recording(scratch.file("numbered.txt", numbered)).runs.size() == 1);
}

TEST_CASE("two beads that take turns without a label are refused") {
  const Scratch scratch;
  std::string same_times = "t x y z\n", turns = same_times, random = same_times;
  std::mt19937_64 bits(1);
  for (int k = 0; k < 500; ++k) {
    same_times += text_of(circle(2 * k)) + "\n" + text_of(small_circle(2 * k)) + "\n";
    turns += text_of(k % 2 == 0 ? circle(k) : small_circle(k)) + "\n";
    random += text_of(bits() % 2 == 0 ? circle(k) : small_circle(k)) + "\n";
  }
  for (const std::string& text : {same_times, turns, random})
    CHECK_THAT(refusal([&] { read_recording(scratch.file("two.txt", text)); }), Contains("two tracers") && Contains("'label'"));
}

TEST_CASE("lines of response are no track, and a bead at rest in a noisy camera is") {
  const Scratch scratch;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> anywhere(0, 470);
  std::normal_distribution<double> noise(0, 3);
  std::string lines, rest = "t x y z\n";
  for (int k = 0; k < 1000; ++k) {
    char line[120];
    std::snprintf(line, sizeof line, "%.1f %.1f %.1f %.1f %.1f\n", 0.1 * k, anywhere(random), anywhere(random), anywhere(random),
                  anywhere(random));
    lines += line;
    rest += text_of({1.0 * k, 100 + noise(random), 50 + noise(random), 200 + noise(random)}) + "\n";
  }
  CHECK_THAT(refusal([&] { read_recording(scratch.file("lor.txt", lines)); }), Contains("lines of response"));
  CHECK(read_recording(scratch.file("rest.txt", rest)).runs[0].size() > 950);
}

TEST_CASE("places by which a tracker says that it has none are set aside") {
  const Scratch scratch;
  for (const double sign : {0.0, -1.0, 999.0}) {
    std::vector<Row> rows = circle_of(1000);
    for (const int k : {100, 101, 102, 300, 555, 556, 900}) rows[static_cast<std::size_t>(k)] = {2.0 * k, sign, sign, sign};
    const Recording r = read_recording(scratch.file("signs.txt", rows_of(rows)));
    CHECK(r.runs[0].report.lost == 7);
    CHECK(r.runs[0].report.used == 993);
  }
  std::vector<Row> rows = circle_of(1000);
  for (const int k : {100, 300, 555, 900}) rows[static_cast<std::size_t>(k)] = {2.0 * k, -100, 0, 55};
  CHECK(read_recording(scratch.file("parked.txt", rows_of(rows))).runs[0].report.lost == 4);
}

TEST_CASE("a last place that is repeated while the bead moves is lost time") {
  const Scratch scratch;
  std::vector<Row> rows = circle_of(2000);
  for (std::size_t k = 700; k < 900; ++k) rows[k] = {rows[k].t, rows[699].x, rows[699].y, rows[699].z};
  const Recording held = read_recording(scratch.file("held.txt", rows_of(rows)));
  CHECK(held.runs[0].report.lost == 200);
  CHECK(held.runs[0].report.gaps == 1);
  CHECK(held.runs[0].report.gap_time == Approx(0.402));
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = circle(2.0 * static_cast<double>(k - k % 5)), rows[k].t = 2.0 * static_cast<double>(k);
  const Recording sampled = read_recording(scratch.file("sampled.txt", rows_of(rows)));  // five times too often
  CHECK(sampled.runs[0].report.used == 400);
  CHECK(sampled.runs[0].report.lost == 1600);
}

TEST_CASE("equal places of a coarse clock or of a motion that was made up are none") {
  const Scratch scratch;
  std::string coarse = "t x y z\n", periodic = "t x y z\n";
  for (int k = 0; k < 2000; ++k) {
    const Row r = circle(0.2 * k);
    coarse += std::to_string(0.2 * k) + " " + std::to_string(std::lround(r.x)) + " " + std::to_string(std::lround(r.y)) + " 30\n";
    const double phase = 2 * M_PI * (k % 100) / 100;
    periodic += text_of({2.0 * k, 120 * std::cos(phase), 120 * std::sin(phase), 30 + std::sin(phase)}) + "\n";
  }
  CHECK(read_recording(scratch.file("coarse.txt", coarse)).runs[0].report.lost == 0);
  CHECK(read_recording(scratch.file("periodic.txt", periodic)).runs[0].report.lost == 0);
}

TEST_CASE("a counter that begins again at zero begins another run") {
  const Scratch scratch;
  for (const double from : {64000.0, 4.0e6}) {  // ms: 2^16, or set to zero by hand
    std::vector<Row> rows = circle_of(2000);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].t = k < 768 ? from + rows[k].t : rows[k].t - 1536;
    const Recording r = read_recording(scratch.file("wrap.txt", rows_of(rows)));
    REQUIRE(r.runs.size() == 2);
    CHECK(r.runs[0].size() == 768);
    CHECK(r.runs[0].time.front() == from / 1e3);
    CHECK(r.runs[1].time.front() == 0);
    CHECK(r.runs[0].report.gaps + r.runs[1].report.gaps == 0);
  }
}

TEST_CASE("blocks that were written in another order are still one run") {
  const Scratch scratch;
  std::vector<Row> rows = circle_of(3000);
  std::rotate(rows.begin(), rows.begin() + 1100, rows.end());
  const Recording r = read_recording(scratch.file("turned.txt", rows_of(rows)));
  REQUIRE(r.runs.size() == 1);
  CHECK(r.runs[0].size() == 3000);
}

TEST_CASE("honest tracks that look like something else are left alone") {
  const Scratch scratch;
  std::mt19937_64 random(4);
  std::string coarse = "t x y z\n", threads = "t x y z\n", through = "t x y z\n", paused = "t x y z\n";
  for (int k = 0; k < 1000; ++k) {
    coarse += std::to_string(k) + " 100 50 " + (random() % 2 == 0 ? "200" : "201") + "\n";  // at rest, of whole millimetres
    threads += text_of(circle(k % 2 == 0 ? k / 2 : 500 + k / 2)) + "\n";                    // written by two at once
    const Row r = circle(k);
    const std::string number = std::to_string(std::lround(r.x / 10) * 10 + 35);
    through += std::to_string(k) + " " + number + " " + number + " " + number + "\n";  // one number three times, often
    const double gone = k < 500 ? 0 : k - 500, along = 1e-5 * gone * gone;             // starts from rest, without noise
    paused += text_of({1.0 * k, 100 * std::cos(along), 100 * std::sin(along), 30 + 0.01 * along}) + "\n";
  }
  CHECK(read_recording(scratch.file("coarse.txt", coarse)).runs[0].size() == 1000);
  CHECK(read_recording(scratch.file("threads.txt", threads)).runs[0].size() == 1000);
  CHECK(read_recording(scratch.file("through.txt", through)).runs[0].report.lost == 0);
  CHECK(read_recording(scratch.file("paused.txt", paused)).runs[0].report.lost == 0);
}

TEST_CASE("a label that was never seen, or never in the mill, leaves the others") {
  const Scratch scratch;
  std::string unseen = "t,x,y,z,label\n", outside = unseen, many = unseen;
  for (int k = 0; k < 500; ++k) {
    unseen += text_of(circle(2 * k), ",") + ",1\n" + text_of({2.0 * k, 0, 0, 0}, ",") + ",2\n";
    outside += text_of(circle(2 * k), ",") + ",1\n";
    if (k % 50 == 0) outside += text_of({2.0 * k, 9000, 9000, 9000.0 + k}, ",") + ",2\n";
    many += text_of(circle(2 * k), ",") + "," + std::to_string(k / 3) + "\n" + text_of({2.0 * k, 7.0 * (k % 13), 3, 1}, ",") + ",-1\n";
  }
  const Recording one = read_recording(scratch.file("unseen.csv", unseen));
  REQUIRE(one.runs.size() == 1);
  CHECK(one.runs[0].report.lost == 500);
  CHECK(one.runs[0].report.rows == 1000);
  const Recording inside = read_recording(scratch.file("outside.csv", outside));
  REQUIRE(inside.runs.size() == 1);
  CHECK(inside.runs[0].size() == 500);
  scratch.file("before.csv", unseen);
  const Recording later = read_recording(scratch.file("two.yaml", "files: [before.csv, outside.csv]\n"));  // in whichever file it is
  REQUIRE(later.runs.size() == 2);
  CHECK(later.runs[1].report.lost == inside.runs[0].report.lost);
  const Recording tracks = read_recording(scratch.file("many.csv", many));  // numbers of short tracks; -1 is no bead's all the same
  REQUIRE(tracks.runs.size() == 1);
  CHECK(tracks.runs[0].size() == 500);
  CHECK(tracks.runs[0].report.lost == 500);
}

TEST_CASE("a smoothed track of a tracer at rest is read, whatever its size") {
  const Scratch scratch;
  std::mt19937_64 random(3);
  std::normal_distribution<double> push(0, 1);
  Row at{0, 361, 223, 198};
  std::string text = "t x y z error\n";
  for (int k = 0; k < 3000; ++k) {
    at = {5.0 * k, at.x + 0.01 * push(random) - 0.01 * (at.x - 361), at.y + 0.01 * push(random) - 0.01 * (at.y - 223),
          at.z + 0.01 * push(random) - 0.01 * (at.z - 198)};
    text += text_of(at) + " 6.2\n";
  }
  CHECK(read_recording(scratch.file("rest.txt", text)).runs[0].size() == 3000);
}

TEST_CASE("files on which other people's tools failed") {
  const auto at = [](const std::string& name) { return testing::public_case("recordings/" + name); };
  if (testing::absent(at("00_plain.csv"))) return;
  for (const char* name : {"decimal_comma.csv", "decimal_comma_tab.txt", "utf16.csv"}) {
    CAPTURE(name);
    same(read_recording(at(name)), read_recording(at("decimal_point_reference.csv")));
  }
  const Recording fortran = read_recording(at("fortran_exponents.txt"));  // of three digits more
  CHECK(fortran.runs[0].size() == 1972);
  CHECK(fortran.runs[0].position[0][10] == Approx(read_recording(at("decimal_point_reference.csv")).runs[0].position[0][10]).margin(1e-6));
  CHECK(read_recording(at("01_two_tracers_interleaved_label.csv")).runs.size() == 2);
  CHECK(read_recording(at("01b_two_tracers_alternating_times_label.csv")).runs.size() == 2);
  CHECK_THAT(refusal([&] { read_recording(at("10b_lor_bare_five_columns.txt")); }), Contains("lines of response"));
  CHECK(read_recording(at("15_ms_clock_wraps_at_65536.csv")).runs.size() == 2);
  CHECK(read_recording(at("21_zeros_for_lost.csv")).runs[0].report.lost == 99);
  CHECK(read_recording(at("at_rest_smoothed.csv")).runs[0].size() == 3000);
}
