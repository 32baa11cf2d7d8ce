// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/KeepRobotMode.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `~keep_robot_mode`: stores a robot's mode in the world's state, for a coordinator.
class ModeService {
 public:
  ModeService(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  using Request = warehouse_msgs::KeepRobotMode::Request;
  using Response = warehouse_msgs::KeepRobotMode::Response;
  bool keep(const Request& request, Response& response);

  SimulationThread& simulation_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
