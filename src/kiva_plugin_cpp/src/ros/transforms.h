// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <map>
#include <vector>

#include "audience.h"
#include "snapshot.h"

namespace kiva_ros {

/// The frames: world → kiva<id>/base_link → left_wheel, right_wheel, tower; laser is static.
class Transforms {
 public:
  Transforms(ros::NodeHandle& node, Audience& audience);

  void update(const Roster& roster);
  void publish(const std::vector<RobotPose>& robots, double time);

 private:
  ros::Publisher moving_, fixed_;
  std::map<int, RosterEntry> roster_;  ///< By id.
};

}  // namespace kiva_ros
