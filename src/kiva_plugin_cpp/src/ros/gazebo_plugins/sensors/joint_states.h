// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_joint_state_publisher.so: publishes the positions and rates of
/// joints.
class JointStates : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::vector<std::string> joints_;
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
