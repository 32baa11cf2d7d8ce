// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Publishes ~performance_metrics, the real-time factor as Gazebo's node computes it, while there
/// are subscribers, also while time stands still.
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
