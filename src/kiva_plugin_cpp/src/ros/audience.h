// SPDX-License-Identifier: Apache-2.0
//
// Who listens: counted as subscribers come and go, so that the step thread never has to ask
// roscpp, which takes a lock and walks a list for every answer.
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

class Audience {
 public:
  enum class Topic { kFleet, kModelStates, kLinkStates, kTransforms, kStateHash, kEnd };
  enum class RobotTopic { kStatus, kScan, kOdometry, kEnd };

  /// Called, in any thread, when a listener came.
  void onArrival(std::function<void()> call) { on_arrival_ = std::move(call); }
  /// Whether a listener to that topic, of one robot or another, came since the last call.
  bool takeArrival(Topic topic) { return arrived_[static_cast<int>(topic)].exchange(false); }
  bool takeArrival(RobotTopic topic) {
    return robots_arrived_[static_cast<int>(topic)].exchange(false);
  }

  bool listensTo(Topic topic) const { return counts_[static_cast<int>(topic)] > 0; }
  /// Counts up whenever the ids that listenedRobots returns may have changed.
  std::uint64_t robotsRevision() const { return robots_revision_; }
  /// Ids of the robots with a listener to that topic, ascending.
  std::vector<int> listenedRobots(RobotTopic topic) const;

  void count(Topic topic, int change);
  void count(RobotTopic topic, int kiva_id, int change);
  /// A robot went, and its topics with it.
  void forget(int kiva_id);

 private:
  static constexpr int kTopics = static_cast<int>(Topic::kEnd);
  static constexpr int kRobotTopics = static_cast<int>(RobotTopic::kEnd);

  void noteArrival(int change, std::atomic<bool>* arrived);

  std::function<void()> on_arrival_;
  std::atomic<bool> arrived_[kTopics] = {}, robots_arrived_[kRobotTopics] = {};
  std::atomic<int> counts_[kTopics] = {};
  std::atomic<std::uint64_t> robots_revision_{0};
  mutable std::mutex mutex_;
  std::map<int, int> listeners_[kRobotTopics];  ///< By robot's id; guarded by mutex_.
};

/// Advertises a topic whose listeners are counted: `count` is called with +1 or -1.
template <typename Message>
ros::Publisher advertiseCounted(ros::NodeHandle& node, const std::string& topic, int queue_size,
                                const std::function<void(int)>& count, bool latched = false) {
  return node.advertise<Message>(
      topic, queue_size, [count](const ros::SingleSubscriberPublisher&) { count(+1); },
      [count](const ros::SingleSubscriberPublisher&) { count(-1); }, ros::VoidConstPtr(), latched);
}

}  // namespace kiva_ros
