// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include "engine.h"

namespace kiva_ros {

/// How fast simulated time passes, as Gazebo's node tells it: ~performance_metrics, while somebody
/// listens, also while time stands still.
class Performance {
 public:
  Performance(ros::NodeHandle& node, Engine& engine);

 private:
  void publish();

  Engine& engine_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
