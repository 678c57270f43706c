#include "studies/campaign/progress.hpp"

#include "tests/campaign/helpers.hpp"

namespace millscope::campaign::test {

TEST_CASE("the time left follows from what has been computed") {
  ProgressLine line(true, 6);
  CHECK_FALSE(line.time_left({}, 4, 2));
  line.count(true, false, 1, 10);  // 10 s for work of 1
  CHECK(*line.time_left({}, 4, 2) == Approx(20));
  CHECK(*line.time_left({}, 4, 1) == Approx(40));
  // Two under way, 4 s old: 6 s each are left.
  CHECK(*line.time_left({{1, 4, 0}, {1, 4, 0}}, 4, 2) == Approx(26));
  // One long simulation alone cannot be shared.
  CHECK(*line.time_left({{3, 0, 0}}, 0, 2) == Approx(30));
  line.count(false, false, 100, 0);  // a failure tells nothing of the cost
  CHECK(*line.time_left({}, 4, 2) == Approx(20));
  CHECK(line.counts() == "1 of 6 done, 1 failed");
  line.count(true, true, 1, 10);
  CHECK(line.counts() == "2 of 6 done (1 from the cache), 1 failed");
}

TEST_CASE("before the first end, the runs under way tell the cost") {
  const ProgressLine line(true, 2);
  CHECK(*line.time_left({{1, 10, 0.25}}, 0, 1) == Approx(30));
  CHECK(*line.time_left({{1, 10, 0.25}}, 1, 1) == Approx(70));
}

TEST_CASE("the last whole row of the series tells the time") {
  const Folder folder;
  CHECK(simulated_time(folder.path()) == 0);
  write(folder.path() / "series.csv", "time_s,power_W\n");
  CHECK(simulated_time(folder.path()) == 0);
  write(folder.path() / "series.csv", "time_s,power_W\n0.01,1\n0.02,2\n0.0");
  CHECK(simulated_time(folder.path()) == Approx(0.02));
  std::string long_file = "time_s,power_W\n";
  for (int i = 0; i < 1000; ++i) long_file += std::to_string(i) + ".5,12345.678\n";
  write(folder.path() / "series.csv", long_file);
  CHECK(simulated_time(folder.path()) == Approx(999.5));
}

}  // namespace millscope::campaign::test
