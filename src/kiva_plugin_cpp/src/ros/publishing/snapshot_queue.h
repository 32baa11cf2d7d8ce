// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>

#include "snapshot.h"

namespace kiva_ros {

/// Queues snapshots from the step thread to the broadcaster, in order and in bounded memory: where
/// the broadcaster lags, best-effort parts are dropped, and the step thread waits before a reliable
/// one would be.
class SnapshotQueue {
 public:
  /// Appends a snapshot. `reliable`: none of its best-effort parts may be dropped.
  void push(Snapshot snapshot, bool reliable = false);
  /// Waits for snapshots and returns all of them; returns none once the queue is closed and empty.
  std::deque<Snapshot> take();
  /// Releases both sides; snapshots pushed afterwards are dropped.
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
