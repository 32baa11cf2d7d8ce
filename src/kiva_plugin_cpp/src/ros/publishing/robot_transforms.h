// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <string>
#include <vector>

#include "ros/transport/subscriber_counts.h"
#include "snapshot.h"

namespace kiva_ros {

/// Publishes the frames world → kiva<id>/base_link → left_wheel, right_wheel, tower; laser is
/// static. Those of a steered robot are world → map → kiva<id>/odom → kiva<id>/base_link.
class RobotTransforms {
 public:
  /// `locates_steered`: whether to publish where in the map the odometry of steered robots begins.
  RobotTransforms(ros::NodeHandle& node, SubscriberCounts& subscribers, bool locates_steered);

  void update(const RobotInfos& robots);
  void publish(const std::vector<RobotPose>& robots, double time);

 private:
  void addSteered(const RobotPose& robot, const std::string& name, double time,
                  tf2_msgs::TFMessage* out) const;

  const bool locates_steered_;
  ros::Publisher moving_, fixed_;
  std::map<int, RobotInfo> robots_;  ///< By id.
};

}  // namespace kiva_ros
