// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <map>
#include <vector>

#include "ros/transport/subscriber_counts.h"
#include "snapshot.h"

namespace kiva_ros {

/// Publishes the frames world → kiva<id>/base_link → left_wheel, right_wheel, tower; laser is
/// static.
class RobotTransforms {
 public:
  RobotTransforms(ros::NodeHandle& node, SubscriberCounts& subscribers);

  void update(const RobotInfos& robots);
  void publish(const std::vector<RobotPose>& robots, double time);

 private:
  ros::Publisher moving_, fixed_;
  std::map<int, RobotInfo> robots_;  ///< By id.
};

}  // namespace kiva_ros
