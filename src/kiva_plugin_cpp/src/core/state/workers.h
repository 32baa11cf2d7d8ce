// SPDX-License-Identifier: Apache-2.0
//
// The threads that share a world's loops over robots. A loop's turns touch nothing that another one
// reads, so that its result does not depend on how many threads there are or who takes which.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace kiva {

/// The caller and `threads` − 1 others, which sleep until there is work: nobody spins.
class Workers {
 public:
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls loop(begin, end) until all of [0, count) is done, in blocks of `block`, on all threads;
  /// where one block is all, on the caller's. The loop throws nothing.
  void share(int count, int block, const std::function<void(int begin, int end)>& loop);

  /// For tests: in blocks of one, so that a small fleet is shared too.
  void shareAll() { shares_all_ = true; }

 private:
  struct Job;
  void serve();
  static void work(Job& job);

  std::mutex mutex_;
  std::condition_variable posted_, left_;
  Job* job_ = nullptr;  // that others may take part in
  int at_job_ = 0;      // who do
  bool ends_ = false, shares_all_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace kiva
