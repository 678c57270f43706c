// Times that are not in order.
#include <catch2/catch.hpp>
#include <ctime>

#include "recording/support.hpp"

using namespace millscope;
using namespace recording_test;

namespace {

/// The circle of 200 rows in another order.
std::string rows_in(const std::vector<int>& order) {
  std::string text = "# t x y z\n";
  for (const int k : order) text += circle_row(k) + "\n";
  return text;
}

std::vector<int> ascending(int count) {
  std::vector<int> order;
  for (int k = 0; k < count; ++k) order.push_back(k);
  return order;
}

}  // namespace

TEST_CASE("rows that run backwards are sorted in and counted") {
  const Scratch scratch;
  std::vector<int> order = ascending(200);
  std::swap(order[50], order[51]);
  std::rotate(order.begin() + 100, order.begin() + 103, order.begin() + 110);
  const recording::Recording recording = recording::read_recording(scratch.file("order.txt", rows_in(order)));
  const recording::Recording straight = recording::read_recording(scratch.file("straight.txt", rows_in(ascending(200))));
  CHECK(recording.runs[0].report.backwards == 2);
  CHECK(recording.runs[0].time == straight.runs[0].time);
  CHECK(recording.runs[0].position == straight.runs[0].position);
}

TEST_CASE("a file that is backwards as a whole gives the same points") {
  const Scratch scratch;
  std::vector<int> order = ascending(200);
  std::reverse(order.begin(), order.end());
  const recording::Recording recording = recording::read_recording(scratch.file("reverse.txt", rows_in(order)));
  REQUIRE(recording.runs.size() == 1);
  CHECK(recording.runs[0].report.backwards == 199);
  CHECK(recording.runs[0].size() == 200);
  CHECK(recording.runs[0].time.front() == 0);
}

TEST_CASE("of rows with one time the one with the smallest spread is kept, else the first") {
  const Scratch scratch;
  std::string text = ctrack_head();
  for (int k = 0; k < 100; ++k) {
    text += ctrack_row(5 * k, 100, k, 30, 4);
    if (k == 40) text += ctrack_row(5 * k, 101, k, 30, 3) + ctrack_row(5 * k, 102, k, 30, 3.5);
    if (k == 60) text += ctrack_row(5 * k, 101, k, 30, 5) + ctrack_row(5 * k, 102, k, 30, 4);
  }
  const recording::Run run = recording::read_recording(scratch.file("twice.a", text)).runs[0];
  CHECK(run.report.rows == 104);
  CHECK(run.report.duplicates == 4);
  REQUIRE(run.size() == 100);
  CHECK(run.position[0][40] == 0.101);
  CHECK(run.position[0][60] == 0.1);
  for (std::size_t i = 1; i < run.size(); ++i) REQUIRE(run.time[i] > run.time[i - 1]);
}

TEST_CASE("a single false time is set aside") {
  const Scratch scratch;
  const std::string text = circle_rows(400, [](int k, std::string row) {
    if (k == 100) return "987654.0" + row.substr(row.find(' '));
    if (k == 300) return "-9.0e5" + row.substr(row.find(' '));
    if (k == 399) return "9.0e30" + row.substr(row.find(' '));
    return row;
  });
  const recording::Run run = recording::read_recording(scratch.file("glitch.txt", text)).runs[0];
  CHECK(run.report.false_times == 3);
  CHECK(run.report.used == 397);
  CHECK(run.time.back() == Approx(1.99));
}

TEST_CASE("times of thousands of years are refused, and false times count as bad rows") {
  const Scratch scratch;
  const auto why = [&](const std::function<std::string(int, std::string)>& change) {
    const auto file = scratch.file("times.txt", circle_rows(100, change));
    return refusal([&] { recording::read_recording(file); });
  };
  const auto at = [](const std::string& time, const std::string& row) { return time + row.substr(row.find(' ')); };
  const auto epoch = [&](int k, const std::string& row) { return at(std::to_string(1'700'000'000'000'000'000 + 5'000'000LL * k), row); };
  CHECK_THAT(why(epoch), Catch::Contains("times.txt") && Catch::Contains("three thousand years") && Catch::Contains("t: ns"));
  const auto part = [&](int k, const std::string& row) {
    return k >= 60 ? row : k >= 30 ? std::string("1 lost 2 3") : at(std::to_string(k + 1) + "e12", row);
  };
  CHECK_THAT(why(part), Catch::Contains("30 of 100 rows are unreadable, 0 not finite and 30 have false times"));
}

TEST_CASE("many stretches written over again are read in little time") {
  const Scratch scratch;
  std::string text;
  for (int part = 0; part < 4000; ++part) {
    for (int k = 0; k < 30; ++k) text += circle_row(10 * (part % 7) + 50 * k) + "\n";
  }
  const std::clock_t start = std::clock();
  const recording::Recording recording = recording::read_recording(scratch.file("over.txt", text));
  CHECK(recording.runs[0].report.rows + recording.runs.back().report.rows > 0);
  CHECK(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 4);
}

TEST_CASE("a clock that was set back begins another run") {
  const Scratch scratch;
  const std::string other = circle_rows(500, [](int, std::string row) { return row.replace(row.rfind(' '), 1, " 1"); });  // z + 100 mm
  const std::string text = circle_rows(600) + other;
  const recording::Recording recording = recording::read_recording(scratch.file("twice.txt", text));
  REQUIRE(recording.runs.size() == 2);
  CHECK(recording.runs[0].name == "twice");
  CHECK(recording.runs[1].name == "twice_2");
  CHECK(recording.runs[0].size() == 600);
  CHECK(recording.runs[1].size() == 500);
  CHECK(recording.runs[0].report.rows + recording.runs[1].report.rows == 1100);
  CHECK(recording.runs[0].report.backwards == 0);
}

TEST_CASE("a later part that was written first is sorted in, not taken for another run") {
  const Scratch scratch;
  std::vector<int> order;
  for (int k = 400; k < 800; ++k) order.push_back(k);
  for (int k = 0; k < 400; ++k) order.push_back(k);
  const recording::Recording recording = recording::read_recording(scratch.file("parts.txt", rows_in(order)));
  REQUIRE(recording.runs.size() == 1);
  CHECK(recording.runs[0].size() == 800);
  CHECK(recording.runs[0].report.backwards == 1);
}

TEST_CASE("the same points twice are one run of duplicates") {
  const Scratch scratch;
  std::vector<int> order;
  for (int k = 0; k < 300; ++k) order.insert(order.end(), {k, k});
  const recording::Run run = recording::read_recording(scratch.file("double.txt", rows_in(order))).runs[0];
  CHECK(run.report.duplicates == 300);
  CHECK(run.size() == 300);
}

TEST_CASE("a block of rows that was written twice is duplicates, not another run") {
  const Scratch scratch;
  std::vector<int> order = ascending(1000);
  const std::vector<int> block(order.begin() + 100, order.begin() + 300);
  SECTION("far behind itself") { order.insert(order.begin() + 900, block.begin(), block.end()); }
  SECTION("at the end") { order.insert(order.end(), block.begin(), block.end()); }
  const recording::Recording recording = recording::read_recording(scratch.file("block.txt", rows_in(order)));
  REQUIRE(recording.runs.size() == 1);
  CHECK(recording.runs[0].report.duplicates == 200);
  CHECK(recording.runs[0].size() == 1000);
}

TEST_CASE("a whole file written twice is one run") {
  const Scratch scratch;
  const recording::Recording recording = recording::read_recording(scratch.file("copy.txt", circle_rows(600) + circle_rows(600)));
  REQUIRE(recording.runs.size() == 1);
  CHECK(recording.runs[0].report.duplicates == 600);
}
