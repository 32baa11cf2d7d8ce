// SPDX-License-Identifier: Apache-2.0
//
// Loops with independent turns, shared among threads. The result is the same for any number of
// threads.
#pragma once

#include <functional>

namespace fleet {

class Threads {
 public:
  /// Uses the caller and `threads` - 1 others; 0 = one thread a core.
  explicit Threads(int threads);

  int count() const { return count_; }

  /// Calls turn(i, thread) for each i of [0, turns), with at least `worth` turns a thread. `thread`
  /// is below count() and serves as the index of a thread's own memory. The first exception of a
  /// turn is thrown when all threads have ended. Threads live for one loop only, so that a forked
  /// child misses none.
  void share(int turns, int worth, const std::function<void(int, int)>& turn) const;

 private:
  int count_;
};

}  // namespace fleet
