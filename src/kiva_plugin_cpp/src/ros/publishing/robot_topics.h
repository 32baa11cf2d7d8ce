// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/KivaStatus.h>

#include <functional>
#include <map>
#include <string>

#include "ros/transport/direct_publisher.h"
#include "ros/transport/latched_publisher.h"
#include "ros/transport/subscriber_counts.h"
#include "snapshot.h"

namespace kiva_ros {

/// Queue size for a slow subscriber of periodic messages.
constexpr int kStreamQueue = 10;

/// Publishes the topics of each robot, and advertises them as long as the robot exists.
class RobotTopics {
 public:
  RobotTopics(ros::NodeHandle& node, SubscriberCounts& subscribers)
      : node_(node), subscribers_(subscribers) {}

  void update(const RobotInfos& robots);
  void publish(const kiva::StatusChange& status);  ///< Latched.
  void publish(const Scan& scan, double time);
  void publishOdometry(const RobotPose& robot, double time);

 private:
  struct Topics {
    kiva::LaserParameters laser;
    LatchedPublisher<warehouse_msgs::KivaStatus> status;
    DirectPublisher scan, odometry;
  };

  Topics advertise(const RobotInfo& robot);
  std::function<void(int)> counter(SubscriberCounts::RobotTopic topic, int kiva_id);

  ros::NodeHandle& node_;
  SubscriberCounts& subscribers_;
  std::map<int, Topics> robots_;  ///< By id.
};

}  // namespace kiva_ros
