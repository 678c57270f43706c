#include "kernel/base/parallel.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace base = millscope::base;

TEST_CASE("each item is worked on once, by a worker that is there") {
  constexpr std::size_t kItems = 1000, kWorkers = 3;
  std::vector<int> times(kItems);
  base::for_each_item(kItems, kWorkers, [&](std::size_t item, std::size_t worker) {
    ++times[item];
    if (worker >= kWorkers) throw std::logic_error("no such worker");
  });
  CHECK(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));
}

TEST_CASE("of several errors that of the first item is thrown") {
  const auto work = [](std::size_t item, std::size_t) {
    if (item >= 2) throw std::runtime_error("item " + std::to_string(item));
  };
  CHECK_THROWS_WITH(base::for_each_item(3, 1, work), "item 2");
  CHECK_THROWS_WITH(base::for_each_item(500, 4, work), "item 2");
}

TEST_CASE("no more workers than items, and at least one") {
  CHECK(base::worker_count(8, 3) == 3);
  CHECK(base::worker_count(2, 3) == 2);
  CHECK(base::worker_count(2, 0) == 1);
  CHECK(base::worker_count(0, 1) == 1);
}
