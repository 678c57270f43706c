// The team of threads by itself.
#include <catch2/catch.hpp>

#include <atomic>
#include <vector>

#include "kernel/base/error.hpp"
#include "kernel/dem/workers.hpp"

using namespace millscope;
using namespace millscope::dem;

TEST_CASE("a share that waits for another is let go when that one fails") {
  Workers workers(2);
  std::atomic<bool> let_go{false};
  CHECK_THROWS_WITH(workers.run(2,
                                [&](int slab, int) {
                                  if (slab == 0) throw base::UserError("no memory");
                                  let_go = !workers.wait_for([] { return false; });
                                }),
                    "no memory");
  CHECK(let_go);
  int done = 0;
  workers.run(1, [&](int, int) { ++done; });
  CHECK(done == 1);
}

TEST_CASE("of tasks that any worker may take, each is done once") {
  for (const int threads : {1, 2, 3}) {
    Workers workers(threads);
    for (const int tasks : {0, 1, 2, 7, 64}) {
      std::vector<std::atomic<int>> done(tasks);
      for (int turn = 0; turn < 20; ++turn) workers.run_any(tasks, [&](int task, int) { ++done[task]; });
      for (const std::atomic<int>& d : done) CHECK(d == 20);
    }
    CHECK_THROWS_WITH(workers.run_any(9,
                                      [](int task, int) {
                                        if (task == 4) throw base::UserError("no memory");
                                      }),
                      "no memory");
  }
}
