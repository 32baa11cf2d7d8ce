// SPDX-License-Identifier: Apache-2.0
#include "outbox.h"

#include <utility>

namespace kiva_ros {

void Outbox::push(Snapshot snapshot, bool all_is_owed) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    snapshot.all_is_owed = all_is_owed;
    if (all_is_owed) {
      drained_.wait(lock, [this] { return closed_ || waiting_.size() < kMostPeriodic; });
    } else if (waiting_.size() >= kMostPeriodic) {
      snapshot.dropPeriodic();
    }
    if (!snapshot.hasOwed() && !snapshot.hasPeriodic()) return;
    drained_.wait(lock, [this] { return closed_ || waiting_.size() < kMostWaiting; });
    if (closed_) return;
    waiting_.push_back(std::move(snapshot));
  }
  filled_.notify_one();
}

std::deque<Snapshot> Outbox::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  filled_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
  std::deque<Snapshot> out = std::exchange(waiting_, {});
  lock.unlock();
  drained_.notify_one();
  return out;
}

void Outbox::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closed_ = true;
  }
  filled_.notify_all();
  drained_.notify_all();
}

}  // namespace kiva_ros
