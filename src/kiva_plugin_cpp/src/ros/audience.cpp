// SPDX-License-Identifier: Apache-2.0
#include "audience.h"

namespace kiva_ros {

std::vector<int> Audience::listenedRobots(RobotTopic topic) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<int> ids;
  for (const auto& [id, listeners] : listeners_[static_cast<int>(topic)]) {
    if (listeners > 0) ids.push_back(id);
  }
  return ids;
}

void Audience::count(Topic topic, int change) {
  counts_[static_cast<int>(topic)] += change;
  noteArrival(change, &arrived_[static_cast<int>(topic)]);
}

void Audience::count(RobotTopic topic, int kiva_id, int change) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    listeners_[static_cast<int>(topic)][kiva_id] += change;
  }
  ++robots_revision_;
  noteArrival(change, &robots_arrived_[static_cast<int>(topic)]);
}

void Audience::forget(int kiva_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto& listeners : listeners_) listeners.erase(kiva_id);
  }
  ++robots_revision_;
}

void Audience::noteArrival(int change, std::atomic<bool>* arrived) {
  if (change < 0) return;
  *arrived = true;
  if (on_arrival_) on_arrival_();
}

}  // namespace kiva_ros
