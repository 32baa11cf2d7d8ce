// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/GetWorldProperties.h>
#include <ros/ros.h>
#include <std_srvs/Empty.h>

#include <functional>
#include <string>
#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves the simulation as a whole: pause_physics, unpause_physics, reset_simulation, reset_world
/// and get_world_properties of Gazebo's node.
class SimulationServices {
 public:
  SimulationServices(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  void advertise(ros::NodeHandle& node, const std::string& name, const std::function<void()>& act);
  bool getWorld(gazebo_msgs::GetWorldProperties::Request& request,
                gazebo_msgs::GetWorldProperties::Response& response);

  SimulationThread& simulation_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
