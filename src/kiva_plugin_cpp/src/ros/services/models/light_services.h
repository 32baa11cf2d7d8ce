// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves lights as Gazebo's node does: get_light_properties, set_light_properties, delete_light.
/// Their values are stored and returned, and have no effect.
class LightServices {
 public:
  LightServices(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
