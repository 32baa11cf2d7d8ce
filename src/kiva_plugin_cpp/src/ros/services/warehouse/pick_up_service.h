// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/PickUp.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `/warehouse/pick_up`: puts items that fell off their storage units back on them.
class PickUpService {
 public:
  PickUpService(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  bool pickUp(const warehouse_msgs::PickUp::Request& request,
              warehouse_msgs::PickUp::Response& response);

  SimulationThread& simulation_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
