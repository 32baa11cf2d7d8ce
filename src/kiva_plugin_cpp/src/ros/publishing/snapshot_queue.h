// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>

#include "snapshot.h"

namespace kiva_ros {

/// Snapshots on their way from the step thread to the broadcaster, in order and in bounded memory:
/// where the broadcaster lags, best-effort parts are dropped, and the step thread waits before a
/// reliable one would be.
class SnapshotQueue {
 public:
  /// `reliable`: its best-effort parts are to reach the broadcaster too.
  void push(Snapshot snapshot, bool reliable = false);
  /// All that wait, once there is one; none: it was closed and is empty.
  std::deque<Snapshot> take();
  /// Lets both sides go; what is pushed from now on is dropped.
  void close();

 private:
  static constexpr std::size_t kMostBestEffort = 32;
  static constexpr std::size_t kMostReliable = 4096;

  std::mutex mutex_;
  std::condition_variable filled_, drained_;
  std::deque<Snapshot> waiting_;
  bool closed_ = false;
};

}  // namespace kiva_ros
