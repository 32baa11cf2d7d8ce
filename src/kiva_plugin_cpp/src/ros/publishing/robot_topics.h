// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <map>

#include "ros/transport/bulk_publisher.h"
#include "ros/transport/subscriber_counts.h"
#include "snapshot.h"

namespace kiva_ros {

/// Messages that wait for a slow subscriber, of what is soon told anew.
constexpr int kStreamQueue = 10;

/// The topics of each robot: they come and go with it.
class RobotTopics {
 public:
  RobotTopics(ros::NodeHandle& node, SubscriberCounts& subscribers)
      : node_(node), subscribers_(subscribers) {}

  void update(const RobotInfos& robots);
  /// Latched, and sent at once.
  void publish(const kiva::StatusChange& status);
  /// Neither: sent with the next wake-up of roscpp's thread, as the following are.
  void publishHeartbeat(const kiva::StatusChange& status);
  void publish(const Scan& scan, double time);
  void publishOdometry(const RobotPose& robot, double time);

 private:
  struct Topics {
    kiva::LaserParameters laser;
    BulkPublisher status, scan, odometry;
  };

  Topics advertise(const RobotInfo& robot);
  template <typename Message>
  ros::Publisher advertise(int kiva_id, const char* topic, SubscriberCounts::RobotTopic kind,
                           int queue_size, bool latched = false);

  ros::NodeHandle& node_;
  SubscriberCounts& subscribers_;
  std::map<int, Topics> robots_;  ///< By id.
};

}  // namespace kiva_ros
