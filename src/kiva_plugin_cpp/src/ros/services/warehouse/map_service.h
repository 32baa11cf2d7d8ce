// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nav_msgs/GetMap.h>
#include <ros/ros.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `/warehouse/map` (nav_msgs/GetMap): the floor with a cell for each grid point, with the
/// values of kiva::Occupancy.
class MapService {
 public:
  MapService(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  bool get(nav_msgs::GetMap::Request& request, nav_msgs::GetMap::Response& response);

  SimulationThread& simulation_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
