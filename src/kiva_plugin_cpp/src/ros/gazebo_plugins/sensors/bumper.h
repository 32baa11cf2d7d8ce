// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/ContactsState.h>

#include <set>
#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_bumper.so in a <sensor type="contact">: publishes the contacts of
/// its collisions, in world.
class Bumper : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::set<std::string> collisions_;  ///< `model::link::collision`
  std::string frame_;
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
