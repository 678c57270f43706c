// Work that falls into independent items, done by several threads; the first error by number of the item is thrown again.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace millscope::base {

/// Threads to use for `items` items; `wished` 0: all cores.
inline std::size_t worker_count(int wished, std::size_t items) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return std::max<std::size_t>(1, std::min(items, wished > 0 ? static_cast<std::size_t>(wished) : cores));
}

/// Calls work(item, worker) for items 0 … count − 1, each once, `workers` at a time.
template <class Work>
void for_each_item(std::size_t count, std::size_t workers, Work&& work) {
  std::atomic<std::size_t> next{0};
  std::mutex guard;
  std::exception_ptr error;
  std::size_t error_item = count;
  const auto loop = [&](std::size_t worker) {
    for (std::size_t item = next++; item < count; item = next++) {
      try {
        work(item, worker);
      } catch (...) {
        const std::lock_guard<std::mutex> hold(guard);
        if (item < error_item) {
          error_item = item;
          error = std::current_exception();
        }
        next = count;
      }
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t worker = 1; worker < workers; ++worker) threads.emplace_back(loop, worker);
  loop(0);
  threads.clear();  // joins
  if (error) std::rethrow_exception(error);
}

}  // namespace millscope::base
