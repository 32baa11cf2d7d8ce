// SPDX-License-Identifier: Apache-2.0
//
// Loops whose turns are independent of each other, shared among threads: the result is the same for
// any number of threads.
#pragma once

#include <functional>

namespace fleet {

class Threads {
 public:
  /// The caller and `threads` - 1 others; 0: as many as the machine has cores.
  explicit Threads(int threads);

  int count() const { return count_; }

  /// Calls turn(i, thread) for each i of [0, turns), on as many threads as have `worth` turns each;
  /// `thread` is a number below count(), for what a thread needs of its own. The first exception of
  /// a turn is thrown when all threads have ended. Threads live for one loop only: a child that was
  /// forked in between misses none.
  void share(int turns, int worth, const std::function<void(int, int)>& turn) const;

 private:
  int count_;
};

}  // namespace fleet
