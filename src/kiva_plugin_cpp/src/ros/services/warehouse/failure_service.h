// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Fail.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `/warehouse/fail`: causes or repairs a failure of a robot.
class FailureService {
 public:
  FailureService(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  bool fail(const warehouse_msgs::Fail::Request& request, warehouse_msgs::Fail::Response& response);

  SimulationThread& simulation_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
