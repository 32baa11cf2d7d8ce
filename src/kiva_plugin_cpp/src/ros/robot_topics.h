// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <map>

#include "audience.h"
#include "bulk_topic.h"
#include "snapshot.h"

namespace kiva_ros {

/// The topics of each robot: they come and go with it.
class RobotTopics {
 public:
  RobotTopics(ros::NodeHandle& node, Audience& audience) : node_(node), audience_(audience) {}

  void update(const Roster& roster);
  /// Latched, and sent at once.
  void publish(const kiva::StatusChange& status);
  /// Neither: sent with the next wake-up of roscpp's thread, as the following are.
  void publishHeartbeat(const kiva::StatusChange& status);
  void publish(const Scan& scan, double time);
  void publishOdometry(const RobotPose& robot, double time);

 private:
  struct Topics {
    kiva::LaserParameters laser;
    BulkTopic status, scan, odometry;
  };

  Topics advertise(const RosterEntry& robot);
  template <typename Message>
  ros::Publisher advertise(int kiva_id, const char* topic, Audience::RobotTopic kind,
                           int queue_size, bool latched = false);

  ros::NodeHandle& node_;
  Audience& audience_;
  std::map<int, Topics> robots_;  ///< By id.
};

}  // namespace kiva_ros
