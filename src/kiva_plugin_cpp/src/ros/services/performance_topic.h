// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// How fast simulated time passes, as Gazebo's node tells it: ~performance_metrics, while somebody
/// listens, also while time stands still.
class PerformanceTopic {
 public:
  PerformanceTopic(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  void publish();

  SimulationThread& simulation_;
  ros::Publisher publisher_;
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
