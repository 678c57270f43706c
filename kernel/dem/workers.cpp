#include "kernel/dem/workers.hpp"

#include <utility>

namespace millscope::dem {
namespace {

// A phase lasts tens of microseconds to milliseconds: spin about as long, then give the core away (on a busy machine the other worker
// may be waiting for it), then sleep, so that an idle team costs nothing.
constexpr int kSpins = 1000;
constexpr int kYields = 100;

}  // namespace

void Workers::pause(int& spins) {
  if (spins < kSpins) {
    ++spins;
    __builtin_ia32_pause();
  } else {
    std::this_thread::yield();
  }
}

Workers::Workers(int count) : count_(count), claimed_(count) {
  for (int w = 0; w + 1 < count_; ++w) threads_.emplace_back([this, w] { loop(w); });
}

Workers::~Workers() {
  stop_.store(true);
  generation_.fetch_add(1);
  generation_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void Workers::share(int worker) {
  try {
    if (turns_ == Turns::any) {
      for (int task; (task = next_.fetch_add(1, std::memory_order_relaxed)) < tasks_;) (*task_)(task, worker);
    } else {
      const int last = first(worker + 1, tasks_);
      for (int slab = first(worker, tasks_); slab < last; ++slab) (*task_)(slab, worker);
    }
  } catch (...) {
    if (!failed_.exchange(true)) failure_ = std::current_exception();
  }
  pending_.fetch_sub(1, std::memory_order_acq_rel);
}

bool Workers::claim(int worker, unsigned generation) {
  unsigned before = generation - 1;
  return claimed_[worker].compare_exchange_strong(before, generation, std::memory_order_acq_rel);
}

void Workers::run(int tasks, const std::function<void(int, int)>& task, Turns turns) {
  tasks_ = tasks;
  turns_ = turns;
  next_.store(0, std::memory_order_relaxed);
  task_ = &task;
  pending_.store(count_, std::memory_order_relaxed);
  const unsigned generation = generation_.fetch_add(1, std::memory_order_acq_rel) + 1;
  if (count_ > 1) generation_.notify_all();
  for (int worker = count_ - 1; worker >= 0; --worker) {
    if (claim(worker, generation)) share(worker);
  }
  for (int spins = 0; pending_.load(std::memory_order_acquire) != 0;) pause(spins);
  if (failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Workers::loop(int worker) {
  unsigned seen = 0;
  for (;;) {
    for (int look = 0, spins = 0; generation_.load(std::memory_order_acquire) == seen && look < kSpins + kYields; ++look) pause(spins);
    generation_.wait(seen, std::memory_order_acquire);
    seen = generation_.load(std::memory_order_acquire);
    if (stop_.load()) return;
    if (claim(worker, seen)) share(worker);
  }
}

}  // namespace millscope::dem
