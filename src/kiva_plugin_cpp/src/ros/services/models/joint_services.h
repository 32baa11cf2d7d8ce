// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves joints as Gazebo's node does: get_joint_properties, set_joint_properties,
/// set_model_configuration, apply_joint_effort, clear_joint_forces.
class JointServices {
 public:
  JointServices(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
