// A fixed team of threads that runs the same function over the slabs, phase by phase.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace millscope::dem {

class Workers {
 public:
  /// `count` ≥ 1 threads in all; the calling thread is the last worker.
  explicit Workers(int count);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return count_; }
  /// First slab of a worker.
  int first(int worker, int slabs) const { return worker * slabs / count_; }

  /// Runs task(slab, worker) for each slab in [0, slabs): slab k goes to worker k·count/slabs, so that a slab stays in one cache.
  /// Returns when all are done; what a task throws (the first of them: memory that is not there) is thrown here, the rest of that share is
  /// left out, and the state is of no use any more. The share of a worker whose thread has not begun when the calling thread is done
  /// with its own is taken over by it, under that worker's number, from the last to the first: on a busy machine nobody waits for a thread
  /// that is not running.
  void run(int slabs, const std::function<void(int slab, int worker)>& task) { run(slabs, task, Turns::own); }
  /// The same of tasks whose cost nobody knows beforehand: each worker takes the next that is left. When one fails, all others are done.
  void run_any(int tasks, const std::function<void(int task, int worker)>& task) { run(tasks, task, Turns::any); }

  /// Inside a task: waits until `done`, which a share of a higher number brings about. False: a task has failed, so that it may never come.
  template <class Done>
  bool wait_for(const Done& done) const {
    for (int spins = 0; !done(); pause(spins)) {
      if (failed_.load(std::memory_order_relaxed)) return false;
    }
    return true;
  }

 private:
  enum class Turns { own, any };
  void run(int tasks, const std::function<void(int, int)>& task, Turns turns);
  /// Between two looks; `spins` counts them.
  static void pause(int& spins);
  void loop(int worker);
  void share(int worker);
  /// True for one caller per worker and generation.
  bool claim(int worker, unsigned generation);

  int count_;
  int tasks_ = 0;  ///< slabs among them
  Turns turns_ = Turns::own;
  std::atomic<int> next_{0};  ///< task that nobody has taken, where any may
  const std::function<void(int, int)>* task_ = nullptr;
  std::atomic<unsigned> generation_{0};
  std::atomic<int> pending_{0};                 ///< shares of this generation that are not done
  std::vector<std::atomic<unsigned>> claimed_;  ///< [worker]: the last generation whose share somebody has taken
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;  ///< of the first share that failed in this generation
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace millscope::dem
