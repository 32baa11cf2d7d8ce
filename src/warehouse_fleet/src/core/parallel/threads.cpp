// SPDX-License-Identifier: Apache-2.0
#include "core/parallel/threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace fleet {

Threads::Threads(int threads)
    : count_(threads > 0 ? threads : std::max<int>(1, std::thread::hardware_concurrency())) {}

void Threads::share(int turns, int worth, const std::function<void(int, int)>& turn) const {
  const int chunk =
      std::max(1, worth / 4);  // small, so that all threads end at about the same time
  std::atomic<int> next{0};
  std::exception_ptr error;
  std::mutex of_error;
  const auto work = [&](int thread) {
    try {
      for (int begin = next.fetch_add(chunk); begin < turns; begin = next.fetch_add(chunk)) {
        for (int i = begin; i < std::min(turns, begin + chunk); ++i) turn(i, thread);
      }
    } catch (...) {
      const std::lock_guard lock(of_error);
      if (!error) error = std::current_exception();
      next = turns;
    }
  };
  const int threads = std::max(1, std::min(count_, turns / std::max(1, worth)));
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}

}  // namespace fleet
