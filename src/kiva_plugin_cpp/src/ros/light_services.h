// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "engine.h"

namespace kiva_ros {

/// Lights as Gazebo's node offers them, kept and told: get_light_properties,
/// set_light_properties, delete_light.
class LightServices {
 public:
  LightServices(ros::NodeHandle& node, Engine& engine);

 private:
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
