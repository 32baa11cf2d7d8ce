// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dynamic_reconfigure/server.h>
#include <gazebo_msgs/GetPhysicsProperties.h>
#include <gazebo_msgs/SetPhysicsProperties.h>
#include <kiva_plugin_cpp/PhysicsConfig.h>
#include <ros/ros.h>

#include <mutex>
#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves gravity, step size and pace: get_physics_properties and set_physics_properties of
/// Gazebo's node, and the same parameters by dynamic_reconfigure. Settings of ODE are stored and
/// returned, and have no effect.
class PhysicsServices {
 public:
  PhysicsServices(ros::NodeHandle& node, const kiva::World& world, SimulationThread& simulation);

 private:
  using Config = kiva_plugin_cpp::PhysicsConfig;
  using Properties = gazebo_msgs::SetPhysicsProperties::Request;

  void set(const Properties& properties);
  void reconfigure(Config& config);
  void offer(const Properties& properties);

  SimulationThread& simulation_;
  std::vector<ros::ServiceServer> servers_;
  boost::recursive_mutex mutex_;  ///< Guards the server and last_.
  Config last_;                   ///< The current settings.
  dynamic_reconfigure::Server<Config> server_;
};

}  // namespace kiva_ros
