// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Lights as Gazebo's node offers them, kept and told: get_light_properties,
/// set_light_properties, delete_light.
class LightServices {
 public:
  LightServices(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
