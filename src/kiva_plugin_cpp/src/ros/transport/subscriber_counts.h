// SPDX-License-Identifier: Apache-2.0
//
// Counts subscribers as they connect and disconnect. The step thread so never has to ask roscpp,
// which takes a lock and walks a list for every answer.
#pragma once

#include <ros/ros.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace kiva_ros {

class SubscriberCounts {
 public:
  enum class Topic { kFleet, kModelStates, kLinkStates, kTransforms, kStateHash, kEnd };
  enum class RobotTopic { kStatus, kScan, kOdometry, kEnd };

  /// Sets a function to call, in any thread, when a subscriber connects.
  void onSubscribe(std::function<void()> call) { on_subscribe_ = std::move(call); }
  /// Returns whether a subscriber of that topic, of any robot, connected since the last call.
  bool takeNewSubscriber(Topic topic) {
    return new_subscriber_[static_cast<int>(topic)].exchange(false);
  }
  bool takeNewSubscriber(RobotTopic topic) {
    return new_robot_subscriber_[static_cast<int>(topic)].exchange(false);
  }

  bool hasSubscribers(Topic topic) const { return counts_[static_cast<int>(topic)] > 0; }
  /// Returns a number that grows whenever the result of subscribedRobots may have changed.
  std::uint64_t robotsRevision() const { return robots_revision_; }
  /// Returns the ids of the robots with a subscriber of that topic, ascending.
  std::vector<int> subscribedRobots(RobotTopic topic) const;

  void count(Topic topic, int change);
  void count(RobotTopic topic, int kiva_id, int change);
  /// Forgets a robot that was removed.
  void forget(int kiva_id);

 private:
  static constexpr int kTopics = static_cast<int>(Topic::kEnd);
  static constexpr int kRobotTopics = static_cast<int>(RobotTopic::kEnd);

  void noteSubscriber(int change, std::atomic<bool>* flag);

  std::function<void()> on_subscribe_;
  std::atomic<bool> new_subscriber_[kTopics] = {}, new_robot_subscriber_[kRobotTopics] = {};
  std::atomic<int> counts_[kTopics] = {};
  std::atomic<std::uint64_t> robots_revision_{0};
  mutable std::mutex mutex_;
  std::map<int, int> robot_counts_[kRobotTopics];  ///< By robot's id; guarded by mutex_.
};

/// Advertises a topic whose subscribers are counted: `count` is called with +1 or -1. `node` is a
/// copy, since a handle remembers all that was ever advertised by it (roscpp's `pubs_`).
template <typename Message>
ros::Publisher advertiseCounted(ros::NodeHandle node, const std::string& topic, int queue_size,
                                const std::function<void(int)>& count) {
  return node.advertise<Message>(
      topic, queue_size, [count](const ros::SingleSubscriberPublisher&) { count(+1); },
      [count](const ros::SingleSubscriberPublisher&) { count(-1); });
}

}  // namespace kiva_ros
