// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <warehouse_msgs/People.h>
#include <warehouse_msgs/UnitStates.h>
#include <warehouse_msgs/WarehouseObjects.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "robot_topics.h"
#include "robot_transforms.h"
#include "ros/transport/direct_publisher.h"
#include "ros/transport/latched_publisher.h"
#include "ros/transport/poll_thread.h"
#include "ros/transport/subscriber_counts.h"
#include "snapshot_queue.h"

namespace kiva_ros {

/// Publishes the step thread's snapshots on a thread of its own, so that a second core serialises
/// messages and writes to sockets.
class Broadcaster {
 public:
  /// `node` holds the node's private names. For `locates_steered` see RobotTransforms.
  Broadcaster(ros::NodeHandle& root, ros::NodeHandle& node, SubscriberCounts& subscribers,
              SnapshotQueue& snapshots, bool locates_steered);
  ~Broadcaster() { stop(); }
  /// Publishes the snapshots that are queued, and none after them.
  void stop();

 private:
  void run();
  void publish(const Snapshot& snapshot);
  void publishEvent(const kiva::Event& event);
  void publishModels(const ModelStates& models);
  void publishLinks(const ModelStates& links);

  SnapshotQueue& snapshots_;
  RobotTopics robots_;
  RobotTransforms transforms_;
  PollThread poll_thread_;
  LatchedPublisher<rosgraph_msgs::Clock> clock_;
  DirectPublisher events_;
  // With roscpp's own latch a newcomer can miss the message that is published as it connects.
  LatchedPublisher<warehouse_msgs::WarehouseObjects> objects_;
  LatchedPublisher<warehouse_msgs::UnitStates> units_;
  LatchedPublisher<warehouse_msgs::People> people_;
  ros::Publisher collisions_, fleet_, hash_;
  ros::Publisher model_states_, gazebo_model_states_, link_states_;
  // Shared, since names seldom change.
  std::shared_ptr<const std::vector<std::string>> names_,
      link_names_;  ///< The names in the next two.
  gazebo_msgs::ModelStates models_;
  gazebo_msgs::LinkStates links_;
  std::thread thread_;
};

}  // namespace kiva_ros
