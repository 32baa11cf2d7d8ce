// SPDX-License-Identifier: Apache-2.0
#include "snapshot_queue.h"

#include <utility>

namespace kiva_ros {

void SnapshotQueue::push(Snapshot snapshot, bool reliable) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    snapshot.reliable = reliable;
    if (reliable) {
      drained_.wait(lock, [this] { return closed_ || waiting_.size() < kMostBestEffort; });
    } else if (waiting_.size() >= kMostBestEffort) {
      snapshot.dropBestEffort();
    }
    if (!snapshot.hasReliable() && !snapshot.hasBestEffort()) return;
    drained_.wait(lock, [this] { return closed_ || waiting_.size() < kMostReliable; });
    if (closed_) return;
    waiting_.push_back(std::move(snapshot));
  }
  filled_.notify_one();
}

std::deque<Snapshot> SnapshotQueue::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  filled_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  std::deque<Snapshot> out = std::exchange(waiting_, {});
  lock.unlock();
  drained_.notify_one();
  return out;
}

void SnapshotQueue::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  filled_.notify_all();
  drained_.notify_all();
}

}  // namespace kiva_ros
