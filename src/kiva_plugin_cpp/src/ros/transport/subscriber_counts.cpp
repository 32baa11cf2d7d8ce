// SPDX-License-Identifier: Apache-2.0
#include "subscriber_counts.h"

namespace kiva_ros {

std::vector<int> SubscriberCounts::subscribedRobots(RobotTopic topic) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<int> ids;
  for (const auto& [id, count] : robot_counts_[static_cast<int>(topic)]) {
    if (count > 0) ids.push_back(id);
  }
  return ids;
}

void SubscriberCounts::count(Topic topic, int change) {
  counts_[static_cast<int>(topic)] += change;
  noteSubscriber(change, &new_subscriber_[static_cast<int>(topic)]);
}

void SubscriberCounts::count(RobotTopic topic, int kiva_id, int change) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    robot_counts_[static_cast<int>(topic)][kiva_id] += change;
  }
  ++robots_revision_;
  noteSubscriber(change, &new_robot_subscriber_[static_cast<int>(topic)]);
}

void SubscriberCounts::forget(int kiva_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto& counts : robot_counts_) counts.erase(kiva_id);
  }
  ++robots_revision_;
}

void SubscriberCounts::noteSubscriber(int change, std::atomic<bool>* flag) {
  if (change < 0) return;
  *flag = true;
  if (on_subscribe_) on_subscribe_();
}

}  // namespace kiva_ros
